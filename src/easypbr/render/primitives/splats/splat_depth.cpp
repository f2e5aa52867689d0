#include "easypbr/render/primitives/splats/splat_depth.h"

#include <algorithm>
#include <cmath>

namespace easypbr::render {
namespace {

/// Semi-axes of flat splats, in their longest: a rounding.
constexpr double least_semi_axis = 1e-6;
/// A splat of full opacity is seen to 3.33 standard deviations. Its projection is replaced by its derivative,
/// which draws it up to about twice as large at the border of a wide view.
constexpr double most_deviations = 6.66;

Vec3d semi_axes(const MeshData& mesh, Eigen::Index splat) {
    const Vec3d given = mesh.splats.scales.row(splat).transpose().cast<double>();
    const double longest = given.maxCoeff();
    if (!(longest > 0)) return Vec3d::Zero();
    return given.cwiseMax(least_semi_axis * longest);
}

}  // namespace

double splat_depth(const MeshData& mesh, Eigen::Index splat, const Eigen::Affine3d& T_camera_mesh,
                   const DepthRay& ray) {
    const auto q = mesh.splats.rotations.row(splat).cast<double>();
    const Mat3d axes =
        T_camera_mesh.linear() * Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
    const Vec3d mean = T_camera_mesh * Vec3d(mesh.V.row(splat).transpose().cast<double>()),
                scales = semi_axes(mesh, splat);
    // In a frame in which the Gaussian is the standard one.
    const Mat3d to_unit = scales.cwiseInverse().asDiagonal() * axes.inverse();
    const Vec3d direction = to_unit * ray.direction, from_origin = to_unit * (mean - ray.origin);
    const double depth = direction.dot(from_origin) / direction.squaredNorm(),
                 middle = mean.z() * ray.direction.z();
    // Points, and what a pose flattens.
    if (!std::isfinite(depth)) return middle;
    const double reach = most_deviations * (axes * scales.asDiagonal()).row(2).norm();
    return std::clamp(depth, middle - reach, middle + reach);
}

}  // namespace easypbr::render
