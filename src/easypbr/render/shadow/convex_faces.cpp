#include "easypbr/render/shadow/convex_faces.h"

#include <algorithm>
#include <optional>

#include "easypbr/gpu/facing.h"

namespace easypbr::render {
namespace {

/// More planes than that take longer than they are worth.
constexpr Eigen::Index most_convex_faces = 64;
/// How thick slabs are at most, in diagonals of the mesh: what is thicker may be a room.
constexpr double thickest = 0.1;
/// Places are in a plane that are nearer to it than that, in diagonals of the mesh.
constexpr double flat = 1e-6;

Vec3d vertex(const Array3f& V, Eigen::Index i) {
    return V.row(i).transpose().cast<double>();
}

/// None of a face without area.
std::optional<FacePlane> face_plane(const Array3f& V, const Array3i& F, Eigen::Index face) {
    const Vec3d a = vertex(V, F(face, 0)), b = vertex(V, F(face, 1)), c = vertex(V, F(face, 2));
    const Vec3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (!(length > 0)) return std::nullopt;
    return FacePlane{normal / length, normal.dot(a) / length};
}

/// Where vertices are beside a plane: on both sides, or on none, at places that are numbers.
struct Sides {
    bool above = false, below = false;
};

/// Of all vertices, until they are on both sides, or on any if that is enough.
Sides sides_of(const FacePlane& plane, const Array3f& V, double rounding, bool any) {
    Sides sides;
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        const double height = plane.normal.dot(vertex(V, i)) - plane.offset;
        sides.above |= !(height <= rounding);
        sides.below |= !(height >= -rounding);
        if (any ? sides.above || sides.below : sides.above && sides.below) break;
    }
    return sides;
}

}  // namespace

std::vector<FacePlane> convex_faces(const Array3f& V, const Array3i& F) {
    const Box3d box = gpu::box_of(V);
    if (F.empty() || box.isEmpty()) return {};
    const double rounding = flat * box.diagonal().norm();
    const bool has_few = F.rows() <= most_convex_faces;
    std::vector<FacePlane> planes;
    for (Eigen::Index face = 0; face < F.rows(); ++face) {
        std::optional<FacePlane> plane = face_plane(V, F, face);
        if (!plane) continue;
        const Sides sides = sides_of(*plane, V, rounding, !has_few);
        const FacePlane turned{-plane->normal, -plane->offset};
        if (!sides.above && !sides.below) return {*plane, turned};
        if (!has_few || (sides.above && sides.below)) return {};
        if (sides.above) plane = turned;
        const auto is_same = [&](const FacePlane& other) {
            return other.normal.dot(plane->normal) > 1 - flat;
        };
        if (std::ranges::none_of(planes, is_same)) planes.push_back(*plane);
    }
    const auto thickness = [&](const FacePlane& plane) {
        double lowest = plane.offset;
        for (Eigen::Index i = 0; i < V.rows(); ++i) lowest = std::min(lowest, plane.normal.dot(vertex(V, i)));
        return plane.offset - lowest;
    };
    const auto is_thin = [&](const FacePlane& plane) {
        return thickness(plane) <= thickest * box.diagonal().norm();
    };
    if (std::ranges::none_of(planes, is_thin)) return {};
    const gpu::Winding winding = gpu::winding_of(V, F);
    const bool is_closed = winding == gpu::Winding::outward || winding == gpu::Winding::inward;
    return is_closed ? planes : std::vector<FacePlane>{};
}

}  // namespace easypbr::render
