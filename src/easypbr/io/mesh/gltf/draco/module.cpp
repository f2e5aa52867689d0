#include "easypbr/io/mesh/gltf/draco/module.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "easypbr/core/memory_budget.h"
#include "easypbr/io/mesh/gltf/component_type.h"

namespace easypbr::io {
namespace {

/// What Draco allocates while it decodes. Measured on a surface with positions, normals and texture
/// coordinates, and seams everywhere: 234 bytes for each face by Edgebreaker, 116 sequentially.
constexpr uint64_t bytes_per_face = 240, bytes_per_vertex = 60;

/// Damaged data.
struct Damage : std::runtime_error {
    using std::runtime_error::runtime_error;
};

void expect(bool holds, const char* what) {
    if (!holds) throw Damage(what);
}

draco::DecoderBuffer buffer_of(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return buffer;
}

uint32_t next_varint(draco::DecoderBuffer& buffer) {
    uint32_t value = 0;
    expect(draco::DecodeVarint(&value, &buffer), "truncated header");
    return value;
}

/// Draco allocates by the counts of its header before it looks at the data behind: they are charged first.
void charge_counts(std::span<const std::byte> bytes) {
    draco::DecoderBuffer buffer = buffer_of(bytes);
    draco::DracoHeader header;
    expect(draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok(), "its header is not Draco's");
    expect(header.encoder_type == draco::TRIANGULAR_MESH, "it holds no triangles");
    expect(header.version_major == 2 && header.version_minor == 2, "expected version 2.2 of the format");
    buffer.set_bitstream_version(draco::kDracoMeshBitstreamVersion);
    if (header.flags & METADATA_FLAG_MASK) {
        draco::GeometryMetadata metadata;
        expect(draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata), "damaged metadata");
    }
    uint32_t faces = 0, vertices = 0;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        uint8_t traversal = 0;
        expect(buffer.Decode(&traversal), "truncated header");
        vertices = next_varint(buffer);
        faces = next_varint(buffer);
    } else {
        faces = next_varint(buffer);
        vertices = next_varint(buffer);
    }
    charge_memory(faces * bytes_per_face + vertices * bytes_per_vertex, "compressed triangles");
}

/// Calls use(T{}) with the C++ type of values in an attribute.
template <class Use>
void with_type_of(const draco::PointAttribute& attribute, Use&& use) {
    switch (attribute.data_type()) {
        case draco::DT_INT8:
            return use(int8_t{});
        case draco::DT_UINT8:
        case draco::DT_BOOL:
            return use(uint8_t{});
        case draco::DT_INT16:
            return use(int16_t{});
        case draco::DT_UINT16:
            return use(uint16_t{});
        case draco::DT_INT32:
            return use(int32_t{});
        case draco::DT_UINT32:
            return use(uint32_t{});
        case draco::DT_FLOAT32:
            return use(float{});
        default:
            throw Damage("an attribute has values of 64 bits");
    }
}

template <class From, class To>
void copy_rows(const draco::PointAttribute& from, uint32_t points, DracoAttribute& to) {
    const int components = to.components;
    std::vector<To> row(static_cast<size_t>(components));
    for (uint32_t point = 0; point < points; ++point) {
        const uint8_t* source = from.GetAddressOfMappedIndex(draco::PointIndex(point));
        expect(from.IsAddressValid(source + size_t(components) * sizeof(From) - 1),
               "an attribute is too short");
        for (size_t c = 0; c < row.size(); ++c) {
            From value;
            std::memcpy(&value, source + c * sizeof(From), sizeof value);
            const auto number = double(value);  // It holds all types of up to 32 bits.
            if constexpr (!std::is_floating_point_v<To>)
                expect(number >= double(std::numeric_limits<To>::min()) &&
                           number <= double(std::numeric_limits<To>::max()),
                       "a value is out of its type's range");
            row[c] = To(number);
        }
        std::memcpy(to.rows.data() + point * row.size() * sizeof(To), row.data(), row.size() * sizeof(To));
    }
}

void read_draco_attribute(const draco::Mesh& mesh, DracoAttribute& to) {
    const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(to.id);
    expect(from, "it lacks an attribute");
    expect(from->num_components() >= to.components, "an attribute has too few components");
    with_component(to.component_type, [&]<class To>(To) {
        const size_t bytes = size_t(mesh.num_points()) * size_t(to.components) * sizeof(To);
        charge_memory(bytes, "compressed attributes");
        to.rows.resize(bytes);
        with_type_of(*from, [&]<class From>(From) { copy_rows<From, To>(*from, mesh.num_points(), to); });
    });
}

void decode_draco(std::span<const std::byte> bytes, DracoMesh& out) {
    charge_counts(bytes);
    draco::DecoderBuffer buffer = buffer_of(bytes);
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw Damage(decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    charge_memory(uint64_t(mesh.num_faces()) * 3 * sizeof(uint32_t), "compressed indices");
    out.indices.reserve(size_t(mesh.num_faces()) * 3);
    for (uint32_t face = 0; face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(face))) {
            expect(point.value() < mesh.num_points(), "a triangle has a vertex that is not there");
            out.indices.push_back(point.value());
        }
    for (DracoAttribute& attribute : out.attributes) read_draco_attribute(mesh, attribute);
}

}  // namespace
}  // namespace easypbr::io

void easypbr_draco_decode(std::span<const std::byte> bytes, easypbr::io::DracoMesh& mesh,
                          std::string& error) {
    try {
        easypbr::io::decode_draco(bytes, mesh);
    } catch (const easypbr::io::Damage& damage) {
        error = damage.what();
    } catch (const std::bad_alloc&) {
        error = "there is not enough memory";
    } catch (const std::length_error& length) {
        error = length.what();
    }
}
