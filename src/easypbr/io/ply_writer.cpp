#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh_readers.h"
#include "easypbr/io/texture_loader.h"

namespace easypbr::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the writer copies values as they are in memory");

constexpr size_t grain = 1 << 14;

/// A property of the vertex element: how a vertex's value is written.
struct Part {
    const char* header;
    size_t size;
    std::function<void(Eigen::Index row, char* out)> write;
};

template <class A>
Part raw_part(const char* header, const A& array) {
    const size_t size = size_t(array.cols()) * sizeof(*array.data());
    return {header, size, [&array, size](Eigen::Index row, char* out) {
                std::memcpy(out, array.data() + row * array.cols(), size);
            }};
}

Part color_part(const ArrayXf& C) {
    const char* rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const char* rgba =
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
    return {C.cols() == 3 ? rgb : rgba, size_t(C.cols()), [&C](Eigen::Index row, char* out) {
                for (Eigen::Index k = 0; k < C.cols(); ++k)
                    out[k] = char(uint8_t(std::lround(std::clamp(C(row, k), 0.0f, 1.0f) * 255)));
            }};
}

bool has_labels(const MeshData& mesh, PerElement element) {
    return !mesh.L.empty() && element_of(mesh, mesh.L.rows()) == element;
}

std::vector<Part> vertex_parts(const MeshData& mesh) {
    std::vector<Part> parts{raw_part("property float x\nproperty float y\nproperty float z\n", mesh.V)};
    if (!mesh.N.empty())
        parts.push_back(raw_part("property float nx\nproperty float ny\nproperty float nz\n", mesh.N));
    if (!mesh.C.empty()) parts.push_back(color_part(mesh.C));
    if (!mesh.UV.empty()) parts.push_back(raw_part("property float s\nproperty float t\n", mesh.UV));
    if (has_labels(mesh, PerElement::vertex)) parts.push_back(raw_part("property int label\n", mesh.L));
    if (!mesh.I.empty()) parts.push_back(raw_part("property float intensity\n", mesh.I));
    return parts;
}

std::vector<Part> face_parts(const MeshData& mesh) {
    constexpr char corners = 3;
    std::vector<Part> parts{
        {"property list uchar int vertex_indices\n", 13, [&F = mesh.F](Eigen::Index row, char* out) {
             *out = corners;
             std::memcpy(out + 1, F.data() + row * corners, 12);
         }}};
    if (has_labels(mesh, PerElement::face)) parts.push_back(raw_part("property int label\n", mesh.L));
    return parts;
}

void append_rows(const std::vector<Part>& parts, size_t count, std::string& out) {
    size_t stride = 0;
    for (const Part& part : parts) stride += part.size;
    const size_t begin = out.size();
    out.resize(begin + count * stride);
    parallel_for(count, grain, [&](size_t row) {
        char* target = out.data() + begin + row * stride;
        for (const Part& part : parts) {
            part.write(Eigen::Index(row), target);
            target += part.size;
        }
    });
}

}  // namespace

std::string encode_ply(const MeshData& mesh, const fs::path& folder) {
    const std::vector<Part> vertices = vertex_parts(mesh), faces = face_parts(mesh);
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    if (mesh.materials.size() == 1 && !mesh.materials[0].base_color_texture.path.empty())
        out += fmt::format("comment TextureFile {}\n",
                           path_from_folder(mesh.materials[0].base_color_texture.path, folder));
    out += fmt::format("element vertex {}\n", mesh.V.rows());
    for (const Part& part : vertices) out += part.header;
    out += fmt::format("element face {}\n", mesh.F.rows());
    for (const Part& part : faces) out += part.header;
    if (!mesh.E.empty())
        out += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", mesh.E.rows());
    out += "end_header\n";
    append_rows(vertices, size_t(mesh.V.rows()), out);
    append_rows(faces, size_t(mesh.F.rows()), out);
    out.append(reinterpret_cast<const char*>(mesh.E.data()), size_t(mesh.E.size()) * sizeof(int32_t));
    return out;
}

}  // namespace easypbr::io
