#include "easypbr/scene/polygon_values.h"

#include <algorithm>

#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
namespace {

/// Takes an array with a row per polygon out of a mesh, and returns its rows for the triangles; else empty.
template <class A>
A taken_for_triangles(A& values, const MeshData& mesh, Eigen::Index polygons) {
    const Eigen::Index rows = values.rows();
    if (rows != polygons || rows == mesh.V.rows() || rows == mesh.F.rows()) return {};
    const A spread = rows_of(values, {mesh.source_face.data(), size_t(mesh.source_face.rows())});
    values = {};
    return spread;
}

bool fits_elements(const MeshData& mesh, Eigen::Index rows) {
    return rows == 0 || rows == mesh.V.rows() || rows == mesh.F.rows();
}

}  // namespace

Eigen::Index polygon_count(const MeshData& mesh) {
    return mesh.source_face.empty() ? 0 : Eigen::Index(mesh.source_face.maxCoeff()) + 1;
}

void spread_polygon_values(MeshData& mesh) {
    const bool all_fit =
        fits_elements(mesh, mesh.L.rows()) && std::ranges::all_of(mesh.scalars, [&](const auto& scalar) {
            return fits_elements(mesh, scalar.values.rows());
        });
    if (all_fit || mesh.source_face.rows() != mesh.F.rows()) return;
    require_sources("source_face", mesh.source_face, "polygons");
    const Eigen::Index polygons = polygon_count(mesh);
    FaceValues values;
    values.L = taken_for_triangles(mesh.L, mesh, polygons);
    for (ScalarArray& scalar : mesh.scalars)
        values.scalars.push_back(taken_for_triangles(scalar.values, mesh, polygons));
    require_shapes(mesh);
    values.put_back(mesh);
}

}  // namespace easypbr
