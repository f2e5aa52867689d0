#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "easypbr/io/tables/face_polygons.h"
#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/vertex_rows.h"

namespace easypbr::io {
namespace {

constexpr size_t polygon_row_grain = 1 << 14;

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

/// The type of a polygon's number of corners.
ScalarType count_type(const FacePolygons& polygons) {
    return polygons.most_corners() > 255 ? ScalarType::int32 : ScalarType::uint8;
}

/// For each polygon its number of corners, the corners, and what its triangles have beside them.
void append_polygons(const FacePolygons& polygons, const std::vector<RowPart>& values, std::string& out) {
    const size_t count_size = size_of(count_type(polygons));
    size_t stride = count_size;
    for (const RowPart& part : values) stride += part.size;
    const size_t begin = out.size(), corner_size = sizeof(int32_t);
    out.resize(begin + polygons.size() * stride + polygons.first_corner(polygons.size()) * corner_size);
    parallel_for(polygons.size(), polygon_row_grain, [&](size_t i) {
        char* to = out.data() + begin + i * stride + polygons.first_corner(i) * corner_size;
        const std::span<const int32_t> corners = polygons.corners(i);
        const auto count = int32_t(corners.size());
        std::memcpy(to, &count, count_size);
        std::memcpy(to + count_size, corners.data(), corners.size_bytes());
        to += count_size + corners.size_bytes();
        for (const RowPart& part : values) {
            part.write(polygons.face(i), to);
            to += part.size;
        }
    });
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
    const FacePolygons polygons(mesh);
    std::string out = "ply\nformat binary_little_endian 1.0\n";
    if (const Texture* texture = ply_texture(mesh))
        out += fmt::format("comment TextureFile {}\n", path_from_folder(texture->path, folder));
    if (!mesh.splats.empty())
        out += fmt::format("comment up {} {} {}\n", mesh.up.x(), mesh.up.y(), mesh.up.z());
    out += fmt::format("element vertex {}\n", mesh.V.rows());
    append_header(vertices, out);
    // Readers of splats know nothing else.
    const bool with_faces = mesh.splats.empty() || !mesh.F.empty();
    if (with_faces) {
        out += fmt::format("element face {}\nproperty list {} int vertex_indices\n", polygons.size(),
                           ply_type(count_type(polygons)));
        append_header(face_values, out);
    }
    if (!mesh.E.empty())
        out += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", mesh.E.rows());
    out += "end_header\n";
    append_rows(vertices, size_t(mesh.V.rows()), out);
    append_polygons(polygons, face_values, out);
    out.append(reinterpret_cast<const char*>(mesh.E.data()), size_t(mesh.E.size()) * sizeof(int32_t));
    return out;
}

}  // namespace easypbr::io
