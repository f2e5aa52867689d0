// Poses of meshes: steps of motion, and where a mesh is in the world.
#include <fmt/format.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
namespace {

void require_finite(const char* what, const Vec3d& v) {
    if (!v.allFinite())
        throw ArgumentError(
            fmt::format("mesh {}: expected finite numbers, got ({}, {}, {})", what, v.x(), v.y(), v.z()));
}

Mat3d rotation(const char* what, const Vec3d& axis, double angle_deg) {
    require_finite(what, axis);
    if (!(axis.norm() > 0))
        throw ArgumentError(fmt::format("mesh {}: expected an axis with a length, got (0, 0, 0)", what));
    if (!std::isfinite(angle_deg))
        throw ArgumentError(fmt::format("mesh {}: expected a finite angle, got {}", what, angle_deg));
    // Whole turns first: an angle that a clock has counted up for days keeps its digits.
    return Eigen::AngleAxisd(radians(std::remainder(angle_deg, 360.0)), axis.stableNormalized())
        .toRotationMatrix();
}

/// R L. Where L is a rotation the product is made one again: rounding would add up over many steps.
Mat3d turned(const Mat3d& R, const Mat3d& L) {
    constexpr double rotation_tolerance = 1e-9;
    const Mat3d product = R * L;
    const bool is_rotation =
        (product.transpose() * product - Mat3d::Identity()).cwiseAbs().maxCoeff() < rotation_tolerance &&
        product.determinant() > 0;
    return is_rotation ? Eigen::Quaterniond(product).normalized().toRotationMatrix() : product;
}

}  // namespace

Eigen::Affine3d Mesh::T_world_mesh() const {
    Eigen::Affine3d T = T_parent_mesh();
    int depth = 0;
    for (std::optional<Mesh> above = parent(); above; above = above->parent()) {
        require_mesh_depth(++depth);
        T = above->T_parent_mesh() * T;
    }
    return T;
}

void Mesh::set_T_world_mesh(const Eigen::Affine3d& T) {
    require_pose("T_world_mesh", T);
    const std::optional<Mesh> above = parent();
    const Eigen::Affine3d T_world_parent = above ? above->T_world_mesh() : Eigen::Affine3d::Identity();
    const Eigen::Affine3d T_parent_mesh = above ? T_world_parent.inverse() * T : T;
    if (!T_parent_mesh.matrix().allFinite())
        throw ArgumentError(fmt::format(
            "mesh '{}': its pose in the world cannot be chosen, for the pose of its parent '{}' cannot be "
            "inverted",
            name(), above->name()));
    set_T_parent_mesh(T_parent_mesh);
}

void Mesh::translate(const Vec3d& step) {
    require_finite("translate", step);
    edit([&](MeshData& d) { d.T_parent_mesh.pretranslate(step); });
}

void Mesh::rotate_axis_angle(const Vec3d& axis, double angle_deg) {
    const Mat3d R = rotation("rotate_axis_angle", axis, angle_deg);
    edit([&](MeshData& d) { d.T_parent_mesh.linear() = turned(R, d.T_parent_mesh.linear()); });
}

void Mesh::orbit(const Vec3d& axis, const Vec3d& center, double angle_deg) {
    require_finite("orbit: center", center);
    const Mat3d R = rotation("orbit", axis, angle_deg);
    edit([&](MeshData& d) {
        const Vec3d arm = d.T_parent_mesh.translation() - center;
        Vec3d next = R * arm;
        if (const double length = next.norm(); length > 0) next *= arm.norm() / length;
        d.T_parent_mesh.translation() = center + next;
        d.T_parent_mesh.linear() = turned(R, d.T_parent_mesh.linear());
    });
}

void Mesh::scale(const Vec3d& factors) {
    require_finite("scale", factors);
    if ((factors.array() == 0).any())
        throw ArgumentError(fmt::format("mesh scale: expected factors other than 0, got ({}, {}, {})",
                                        factors.x(), factors.y(), factors.z()));
    edit([&](MeshData& d) { d.T_parent_mesh.scale(factors); });
}

}  // namespace easypbr
