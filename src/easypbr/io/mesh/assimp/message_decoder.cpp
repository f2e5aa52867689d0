#include "easypbr/io/mesh/assimp/message_decoder.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/assimp/message.h"
#include "easypbr/io/mesh/assimp/message_cursor.h"
#include "easypbr/io/mesh/assimp/message_materials.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::io {
namespace {

/// Bytes of a node without content: name, matrix, six counts and the arrays it has.
constexpr size_t smallest_node = 7 * sizeof(uint64_t) + 12 * sizeof(float) + 1;
/// Of a part: name, three numbers.
constexpr size_t smallest_part = sizeof(uint64_t) + 3 * sizeof(int32_t);

template <class Scalar, int Cols>
Array<Scalar, Cols> take_array(MessageCursor& message, size_t rows, int columns = Cols) {
    const auto bytes = message.take_bytes(uint64_t(rows) * unsigned(columns) * sizeof(Scalar));
    typename Array<Scalar, Cols>::Dense out(Eigen::Index(rows), columns);
    if (rows) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

template <int Cols>
Array<int32_t, Cols> take_indices(MessageCursor& message) {
    const size_t row = Cols * sizeof(int32_t);
    return take_array<int32_t, Cols>(message, message.take_count(row, row));
}

class MessageSceneReader {
  public:
    MessageSceneReader(MessageCursor& message, const std::filesystem::path& file)
        : message_(message), materials_(take_materials(message, file)) {}

    Mesh take_node(int depth = 1) {
        require_mesh_depth(depth);
        MeshData data;
        data.name = message_.take_text();
        take_pose(data);
        take_vertices(data);
        data.F = take_indices<3>(message_);
        data.E = take_indices<2>(message_);
        take_node_materials(data);
        take_parts(data);
        const size_t children = message_.take_count(smallest_node, sizeof(MeshData) + sizeof(Mesh));
        for (size_t i = 0; i < children; ++i) data.children.push_back(take_node(depth + 1));
        // Throws when arrays, indices or parts do not fit together.
        return Mesh(std::move(data));
    }

  private:
    void take_pose(MeshData& data) {
        const auto m = message_.take<std::array<float, 12>>();
        data.T_parent_mesh.matrix() << m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10],
            m[11], 0, 0, 0, 1;
    }

    void take_vertices(MeshData& data) {
        const size_t row = 3 * sizeof(float);
        const size_t count = message_.take_count(row, row);
        const auto arrays = message_.take<uint8_t>();
        if (count > size_t(std::numeric_limits<int32_t>::max())) message_.fail("more than 2^31 vertices");
        data.V = take_array<float, 3>(message_, count);
        if (count == 0) return;
        if (arrays & message_normals) data.N = take_array<float, 3>(message_, count);
        if (arrays & message_uvs) data.UV = take_array<float, 2>(message_, count);
        if (arrays & message_colors)
            data.C = take_array<float, Eigen::Dynamic>(message_, count, 4).cwiseMax(0.0f).cwiseMin(1.0f);
    }

    void take_node_materials(MeshData& data) {
        const size_t count = message_.take_count(sizeof(uint32_t), sizeof(Material));
        for (size_t i = 0; i < count; ++i) {
            const auto index = message_.take<uint32_t>();
            data.materials.push_back(index < materials_.size() ? materials_[index] : Material());
        }
    }

    void take_parts(MeshData& data) {
        const size_t count = message_.take_count(smallest_part, sizeof(MeshPart));
        for (size_t i = 0; i < count; ++i) {
            std::string name = message_.take_text();
            const auto [first, faces, material] = message_.take<std::array<int32_t, 3>>();
            data.parts.push_back({std::move(name), first, faces, material});
        }
    }

    MessageCursor& message_;
    std::vector<Material> materials_;
};

/// Throws FormatError unless the message is complete, of this version and of that kind.
void take_header(MessageCursor& message, size_t size, MessageKind wanted) {
    // Without one the reader ended before it had finished.
    if (size < sizeof(MessageHeader)) throw FormatError("the assimp reader ended without an answer");
    const auto header = message.take<MessageHeader>();
    if (header.magic != message_magic || header.size != size)
        throw FormatError("the assimp reader ended without an answer");
    if (header.version != message_version) throw FormatError("the assimp reader is of another version");
    if (header.kind == MessageKind::error) throw FormatError(message.take_text());
    if (header.kind != wanted) message.fail("it is of another kind");
}

/// assimp turns what these formats call up to +y.
Vec3d up_of_format(const std::string& extension) {
    const bool is_known = extension == "dae" || extension == "x3d" || extension == "wrl";
    return is_known ? Vec3d(Vec3d::UnitY()) : Vec3d(Vec3d::Zero());
}

/// Calls `take` on a message and makes what it throws an error about a file.
template <class Take>
auto decode_message(std::span<const std::byte> bytes, const std::string& name, uint64_t memory,
                    MessageKind kind, const Take& take) {
    try {
        MessageCursor message(bytes, memory);
        take_header(message, bytes.size(), kind);
        auto out = take(message);
        if (!message.at_end()) message.fail("it goes on after its end");
        return out;
    } catch (const Error& error) {
        throw FormatError(fmt::format("cannot read {}: {}", name, error.what()));
    }
}

}  // namespace

LoadedScene decode_scene(std::span<const std::byte> message, const std::filesystem::path& file,
                         uint64_t memory) {
    return decode_message(message, file.string(), memory, MessageKind::scene, [&](MessageCursor& cursor) {
        MeshData root;
        root.name = file.stem().string();
        root.source = file;
        root.up = up_of_format(extension_of(file));
        root.children.push_back(MessageSceneReader(cursor, file).take_node());
        return LoadedScene{Mesh(std::move(root)), {}, {}};
    });
}

std::vector<std::string> decode_extensions(std::span<const std::byte> message, const std::string& name) {
    return decode_message(message, name, message.size(), MessageKind::extensions, [](MessageCursor& cursor) {
        const size_t count = cursor.take_count(sizeof(uint64_t), 1);
        std::vector<std::string> out;
        for (size_t i = 0; i < count; ++i) out.push_back(cursor.take_text());
        return out;
    });
}

}  // namespace easypbr::io
