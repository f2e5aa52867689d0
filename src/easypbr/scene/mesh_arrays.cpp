#include "easypbr/scene/mesh_arrays.h"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

namespace easypbr {

SplatArrays rows_of(const SplatArrays& splats, std::span<const int32_t> rows) {
    return {rows_of(splats.scales, rows), rows_of(splats.rotations, rows), rows_of(splats.opacities, rows),
            rows_of(splats.sh, rows)};
}

void choose_vertex_rows(MeshData& mesh, std::span<const int32_t> rows) {
    mesh.V = rows_of(mesh.V, rows);
    mesh.N = rows_of(mesh.N, rows);
    mesh.C = rows_of(mesh.C, rows);
    mesh.UV = rows_of(mesh.UV, rows);
    mesh.uv_tangents = rows_of(mesh.uv_tangents, rows);
    mesh.T = rows_of(mesh.T, rows);
    mesh.B = rows_of(mesh.B, rows);
    mesh.L = rows_of(mesh.L, rows);
    mesh.I = rows_of(mesh.I, rows);
    mesh.splats = rows_of(mesh.splats, rows);
    for (ScalarArray& scalar : mesh.scalars) scalar.values = rows_of(scalar.values, rows);
}

void repeat_vertices(std::span<const int32_t> rows, MeshData& mesh) {
    choose_vertex_rows(mesh, rows);
    if (mesh.source_vertex.empty())
        mesh.source_vertex =
            Array1i::Dense(Eigen::Map<const Eigen::VectorXi>(rows.data(), Eigen::Index(rows.size())));
    else
        mesh.source_vertex = rows_of(mesh.source_vertex, rows);
}

Array1i numbers_below(int64_t limit, const Array1i& numbers) {
    if (numbers.empty() || numbers.maxCoeff() < limit) return numbers;
    std::vector<int32_t> different(numbers.begin(), numbers.end());
    std::sort(different.begin(), different.end());
    different.erase(std::unique(different.begin(), different.end()), different.end());
    Array1i::Dense ranks(numbers.rows());
    parallel_for(size_t(ranks.size()), 1 << 15, [&](size_t i) {
        const auto found = std::lower_bound(different.begin(), different.end(), numbers[Eigen::Index(i)]);
        ranks[Eigen::Index(i)] = int32_t(found - different.begin());
    });
    return Array1i(std::move(ranks));
}

void tell_faces_from_vertices(MeshData& mesh) {
    const auto count = size_t(mesh.V.rows());
    if (count == 0 || size_t(mesh.F.rows()) != count) return;
    std::vector<int32_t> rows(count + 1, int32_t(count) - 1);
    std::iota(rows.begin(), rows.end() - 1, 0);
    repeat_vertices(rows, mesh);
}

FaceValues::FaceValues(MeshData& mesh) {
    const auto take = [&](auto& values) {
        std::remove_cvref_t<decltype(values)> taken;
        if (!values.empty() && element_of(mesh, values.rows()) == PerElement::face) std::swap(taken, values);
        return taken;
    };
    L = take(mesh.L);
    for (ScalarArray& scalar : mesh.scalars) scalars.push_back(take(scalar.values));
}

void FaceValues::put_back(MeshData& mesh) const {
    const auto is_given = [](const Array1f& values) { return !values.empty(); };
    if (L.empty() && std::ranges::none_of(scalars, is_given)) return;
    tell_faces_from_vertices(mesh);
    if (!L.empty()) mesh.L = L;
    for (size_t i = 0; i < scalars.size(); ++i)
        if (is_given(scalars[i])) mesh.scalars[i].values = scalars[i];
}

void replace_arrays(MeshData& mesh, const MeshData& arrays) {
    mesh.V = arrays.V;
    mesh.N = arrays.N;
    mesh.C = arrays.C;
    mesh.UV = arrays.UV;
    mesh.uv_tangents = arrays.uv_tangents;
    mesh.T = arrays.T;
    mesh.B = arrays.B;
    mesh.F = arrays.F;
    mesh.E = arrays.E;
    mesh.L = arrays.L;
    mesh.I = arrays.I;
    mesh.splats = arrays.splats;
    mesh.scalars = arrays.scalars;
    mesh.parts = arrays.parts;
    mesh.voxel_size = arrays.voxel_size;
    mesh.source_vertex = arrays.source_vertex;
    mesh.source_face = arrays.source_face;
}

std::vector<uint64_t> array_revisions(const MeshData& mesh) {
    const SplatArrays& splats = mesh.splats;
    std::vector<uint64_t> all{
        mesh.V.revision(),           mesh.N.revision(),
        mesh.C.revision(),           mesh.UV.revision(),
        mesh.uv_tangents.revision(), mesh.T.revision(),
        mesh.B.revision(),           mesh.F.revision(),
        mesh.E.revision(),           mesh.L.revision(),
        mesh.I.revision(),           splats.scales.revision(),
        splats.rotations.revision(), splats.opacities.revision(),
        splats.sh.revision(),        mesh.source_vertex.revision(),
        mesh.source_face.revision(),
    };
    for (const ScalarArray& scalar : mesh.scalars) all.push_back(scalar.values.revision());
    return all;
}

MeshData without_arrays(const MeshData& mesh) {
    MeshData out = mesh;
    replace_arrays(out, {});
    return out;
}

void drop_stale_tangents(MeshData& edited, const MeshData& before) {
    const auto same = [](const auto& a, const auto& b) { return a.revision() == b.revision(); };
    if (!same(edited.uv_tangents, before.uv_tangents)) return;
    if (!same(edited.V, before.V) || !same(edited.N, before.N) || !same(edited.UV, before.UV) ||
        !same(edited.F, before.F))
        edited.uv_tangents = {};
}

}  // namespace easypbr
