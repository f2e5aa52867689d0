#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>

#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/vertex_rows.h"

namespace easypbr::io {
namespace {

std::string_view ply_type(ScalarType type) {
    switch (type) {
        case ScalarType::uint8:
            return "uchar";
        case ScalarType::int32:
            return "int";
        case ScalarType::float64:
            return "double";
        default:
            return "float";
    }
}

/// The three corners of a triangle as a list, whose length stands before it.
RowPart corner_part(const Array3i& F) {
    constexpr size_t size = 13;
    return {{"vertex_indices"},
            ScalarType::int32,
            [F](Eigen::Index row, char* out) {
                *out = 3;
                std::memcpy(out + 1, F.data() + row * 3, size - 1);
            },
            size};
}

void append_header(const std::vector<RowPart>& parts, std::string& out) {
    for (const RowPart& part : parts)
        for (const std::string& name : part.names)
            out += fmt::format("property {} {}\n", ply_type(part.type), name);
}

}  // namespace

std::string encode_ply(const MeshData& mesh, const fs::path& folder) {
    std::vector<RowPart> vertices = vertex_row_parts(mesh);
    std::ranges::move(splat_row_parts(mesh.splats), std::back_inserter(vertices));
    const std::vector<RowPart> face_values = face_row_parts(mesh);
    std::vector<RowPart> faces{corner_part(mesh.F)};
    faces.insert(faces.end(), face_values.begin(), face_values.end());
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    if (mesh.materials.size() == 1 && !mesh.materials[0].base_color_texture.path.empty())
        out += fmt::format("comment TextureFile {}\n",
                           path_from_folder(mesh.materials[0].base_color_texture.path, folder));
    if (!mesh.splats.empty())
        out += fmt::format("comment up {} {} {}\n", mesh.up.x(), mesh.up.y(), mesh.up.z());
    out += fmt::format("element vertex {}\n", mesh.V.rows());
    append_header(vertices, out);
    // Readers of splats know nothing else.
    const bool with_faces = mesh.splats.empty() || !mesh.F.empty();
    if (with_faces) {
        out += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.F.rows());
        append_header(face_values, out);
    }
    if (!mesh.E.empty())
        out += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", mesh.E.rows());
    out += "end_header\n";
    append_rows(vertices, size_t(mesh.V.rows()), out);
    append_rows(faces, size_t(mesh.F.rows()), out);
    out.append(reinterpret_cast<const char*>(mesh.E.data()), size_t(mesh.E.size()) * sizeof(int32_t));
    return out;
}

}  // namespace easypbr::io
