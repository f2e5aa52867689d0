#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/directions.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/principal_axes.h"
#include "easypbr/scene/splat_transform.h"

namespace easypbr {
namespace {

constexpr size_t transform_grain = 1 << 14;

Vec3d row(const Array3f& array, size_t i) {
    return array.row(Eigen::Index(i)).transpose().cast<double>();
}

/// result.row(i) = of(i), in parallel.
template <class Of>
Array3f::Dense rows(Eigen::Index count, Of&& of) {
    Array3f::Dense result(count, 3);
    parallel_for(size_t(count), transform_grain,
                 [&](size_t i) { result.row(Eigen::Index(i)) = of(i).template cast<float>().transpose(); });
    return result;
}

/// det(M) times the inverse transpose: it turns normals, and exists for every M.
Array3f turned_normals(const Array3f& N, const Mat3d& M) {
    const Mat3d turn = (M.determinant() < 0 ? -1.0 : 1.0) * detail::cofactors(M);
    // A zero vector says that there is no normal, and goes on saying so.
    return rows(N.rows(), [&](size_t i) -> Vec3d {
        const Vec3d normal = row(N, i);
        return normal.isZero(0) ? normal : detail::direction_or_z(turn * normal);
    });
}

/// Directions turn with the surface; where it is mirrored, turned_normals() stay on their side and the
/// bitangents change theirs.
Array4f turned_tangents(const Array4f& tangents, const Mat3d& M) {
    const float sign = M.determinant() < 0 ? -1.0f : 1.0f;
    Array4f::Dense result(tangents.rows(), 4);
    parallel_for(size_t(tangents.rows()), transform_grain, [&](size_t i) {
        const auto r = Eigen::Index(i);
        const Vec3d t = M * tangents.row(r).head<3>().transpose().cast<double>();
        result.row(r) << t.stableNormalized().cast<float>().transpose(), sign * tangents(r, 3);
    });
    return result;
}

/// The two semi-axes of the ellipse t cos(x) + b sin(x). When t and b are perpendicular they are those
/// already.
std::pair<Vec3d, Vec3d> semi_axes(const Vec3d& t, const Vec3d& b) {
    const double mixed = t.dot(b);
    if (std::abs(mixed) <= 1e-6 * t.norm() * b.norm()) return {t, b};
    Eigen::Matrix2d gram;
    gram << t.squaredNorm(), mixed, mixed, b.squaredNorm();
    const Eigen::Matrix2d v = detail::principal_axes(gram).directions;
    return {v(0, 1) * t + v(1, 1) * b, v(0, 0) * t + v(1, 0) * b};
}

void transform_ellipses(MeshData& mesh, const MeshData& before, const Mat3d& M) {
    Array1f::Dense B(before.B.rows());
    const bool complete = !before.N.empty() && !before.B.empty();
    mesh.T = rows(before.T.rows(), [&](size_t i) -> Vec3d {
        const Vec3d tangent = row(before.T, i);
        if (!complete) return M * tangent;
        const double length = double(before.B[Eigen::Index(i)]);
        const Vec3d bitangent = row(before.N, i).cross(tangent).stableNormalized() * length;
        const auto [first, second] = semi_axes(M * tangent, M * bitangent);
        B[Eigen::Index(i)] = float(second.norm());
        return first;
    });
    if (complete) mesh.B = std::move(B);
}

}  // namespace

MeshData transformed(const MeshData& mesh, const Eigen::Affine3d& T) {
    if (T.matrix().isIdentity(0)) return mesh;
    const Mat3d M = T.linear();
    const double determinant = M.determinant();
    MeshData result = mesh;
    if (!mesh.V.empty())
        result.V = rows(mesh.V.rows(), [&](size_t i) -> Vec3d { return T * row(mesh.V, i); });
    if (!mesh.N.empty()) result.N = turned_normals(mesh.N, M);
    if (!mesh.uv_tangents.empty()) result.uv_tangents = turned_tangents(mesh.uv_tangents, M);
    if (!mesh.T.empty()) transform_ellipses(result, mesh, M);
    if (!mesh.splats.empty()) result.splats = transformed_splats(mesh.splats, M);
    if (determinant < 0 && !mesh.F.empty()) result.F = Array3i::Dense(mesh.F.rowwise().reverse());
    if (!mesh.up.isZero()) result.up = M * mesh.up;
    if (!mesh.front.isZero()) result.front = M * mesh.front;
    result.voxel_size = float(mesh.voxel_size * std::cbrt(std::abs(determinant)));
    return result;
}

}  // namespace easypbr
