#include "easypbr/geometry/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/geometry/spatial_order.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::geometry {
namespace {

[[noreturn]] void refuse(const char* what, const MeshData& mesh, const char* wanted) {
    throw ArgumentError(fmt::format("{}: expected a mesh with {}, got '{}' with {} vertices and {} faces{}",
                                    what, wanted, mesh.name, mesh.V.rows(), mesh.F.rows(),
                                    mesh.children.empty() ? "" : "; merge() makes its children part of it"));
}

std::vector<int32_t> iota(Eigen::Index count) {
    std::vector<int32_t> all(static_cast<size_t>(count));
    std::iota(all.begin(), all.end(), 0);
    return all;
}

bool is_identity(const std::vector<int32_t>& rows, Eigen::Index count) {
    if (Eigen::Index(rows.size()) != count) return false;
    for (size_t i = 0; i < rows.size(); ++i)
        if (rows[i] != int32_t(i)) return false;
    return true;
}

/// The sources of the chosen rows; empty stays empty when nothing was moved.
Array1i chosen_sources(const Array1i& sources, const std::vector<int32_t>& rows, Eigen::Index count) {
    if (!sources.empty()) return rows_of(sources, rows);
    if (is_identity(rows, count) || rows.empty()) return {};
    return Array1i::Dense(Eigen::Map<const Array1i::Dense>(rows.data(), Eigen::Index(rows.size())));
}

void choose_vertices(MeshData& target, const MeshData& mesh, const std::vector<int32_t>& vertices) {
    target.V = rows_of(mesh.V, vertices);
    target.N = rows_of(mesh.N, vertices);
    target.C = rows_of(mesh.C, vertices);
    target.UV = rows_of(mesh.UV, vertices);
    target.uv_tangents = rows_of(mesh.uv_tangents, vertices);
    target.T = rows_of(mesh.T, vertices);
    target.B = rows_of(mesh.B, vertices);
    target.I = rows_of(mesh.I, vertices);
    target.splats = rows_of(mesh.splats, vertices);
    target.source_vertex = chosen_sources(mesh.source_vertex, vertices, mesh.V.rows());
}

/// Labels or scalars of the chosen vertices or faces. `name` is for the warning.
template <class A>
A chosen_values(const MeshData& mesh, const A& values, const Selection& selection, const std::string& name) {
    if (values.empty()) return {};
    if (element_of(mesh, values.rows()) == PerElement::vertex) return rows_of(values, selection.vertices);
    if (selection.faces.size() != selection.vertices.size() || selection.faces.empty())
        return rows_of(values, selection.faces);
    log_warning(
        fmt::format("mesh '{}': {} belong to its faces; as it has as many vertices now, they could be taken "
                    "for those of the "
                    "vertices: left out",
                    mesh.name, name));
    return {};
}

void choose_values(MeshData& target, const MeshData& mesh, const Selection& selection) {
    target.L = chosen_values(mesh, mesh.L, selection, "labels");
    for (const ScalarArray& scalar : mesh.scalars) {
        const Array1f values = chosen_values(mesh, scalar.values, selection, "scalars '" + scalar.name + "'");
        if (!values.empty()) target.scalars.push_back({scalar.name, values});
    }
}

template <class A>
A chosen_indices(const A& indices, const std::vector<int32_t>& rows, const std::vector<int32_t>& place) {
    if (rows.empty()) return {};
    typename A::Dense result(Eigen::Index(rows.size()), A::ColsAtCompileTime);
    for (size_t i = 0; i < rows.size(); ++i)
        for (Eigen::Index k = 0; k < result.cols(); ++k)
            result(Eigen::Index(i), k) = place[size_t(indices(rows[i], k))];
    return result;
}

std::vector<MeshPart> chosen_parts(std::vector<MeshPart> parts, const std::vector<int32_t>& faces) {
    for (MeshPart& part : parts) {
        const auto first = std::lower_bound(faces.begin(), faces.end(), part.first_face);
        const auto last = std::lower_bound(first, faces.end(), part.first_face + part.face_count);
        part.first_face = int(first - faces.begin());
        part.face_count = int(last - first);
    }
    return parts;
}

}  // namespace

void require_faces(const char* what, const MeshData& mesh) {
    if (mesh.F.empty()) refuse(what, mesh, "faces");
}

void require_vertices(const char* what, const MeshData& mesh) {
    if (mesh.V.empty()) refuse(what, mesh, "vertices");
}

void require_splats(const char* what, const MeshData& mesh) {
    if (mesh.splats.empty()) refuse(what, mesh, "splats");
}

MeshData clone_without_arrays(const MeshData& mesh) {
    MeshData result = without_arrays(mesh);
    for (Mesh& child : result.children) child = child.clone();
    return result;
}

MeshData gather_vertices(const MeshData& mesh, const std::vector<int32_t>& vertices) {
    Selection selection;
    selection.vertices = vertices;
    MeshData result = clone_without_arrays(mesh);
    choose_vertices(result, mesh, vertices);
    choose_values(result, mesh, selection);
    return result;
}

Selection select_all(const MeshData& mesh) {
    return {iota(mesh.V.rows()), iota(mesh.V.rows()), iota(mesh.F.rows()), iota(mesh.E.rows())};
}

void drop_degenerate(Selection& selection, const MeshData& mesh) {
    const auto& place = selection.place;
    std::erase_if(selection.faces, [&](int32_t f) {
        const int32_t a = place[size_t(mesh.F(f, 0))], b = place[size_t(mesh.F(f, 1))],
                      c = place[size_t(mesh.F(f, 2))];
        return a < 0 || b < 0 || c < 0 || a == b || b == c || c == a;
    });
    std::erase_if(selection.edges, [&](int32_t e) {
        const int32_t a = place[size_t(mesh.E(e, 0))], b = place[size_t(mesh.E(e, 1))];
        return a < 0 || b < 0 || a == b;
    });
}

void drop_unreferenced(Selection& selection, const MeshData& mesh) {
    std::vector<char> is_used(selection.vertices.size(), 0);
    for (const int32_t f : selection.faces)
        for (int k = 0; k < 3; ++k) is_used[size_t(selection.place[size_t(mesh.F(f, k))])] = 1;
    for (const int32_t e : selection.edges)
        for (int k = 0; k < 2; ++k) is_used[size_t(selection.place[size_t(mesh.E(e, k))])] = 1;
    std::vector<int32_t> moved(selection.vertices.size(), -1), kept;
    for (size_t i = 0; i < is_used.size(); ++i) {
        if (!is_used[i]) continue;
        moved[i] = int32_t(kept.size());
        kept.push_back(selection.vertices[i]);
    }
    for (int32_t& place : selection.place)
        if (place >= 0) place = moved[size_t(place)];
    selection.vertices = std::move(kept);
}

MeshData chosen(const MeshData& mesh, const Selection& selection) {
    MeshData result = clone_without_arrays(mesh);
    result.voxel_size = mesh.voxel_size;
    choose_vertices(result, mesh, selection.vertices);
    choose_values(result, mesh, selection);
    result.F = chosen_indices(mesh.F, selection.faces, selection.place);
    result.E = chosen_indices(mesh.E, selection.edges, selection.place);
    result.source_face = chosen_sources(mesh.source_face, selection.faces, mesh.F.rows());
    result.parts = chosen_parts(mesh.parts, selection.faces);
    return result;
}

}  // namespace easypbr::geometry
