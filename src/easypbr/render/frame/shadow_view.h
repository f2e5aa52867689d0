// Where a shadow map looks from: how a light sees what casts shadows.
#pragma once

#include <array>
#include <optional>

#include "easypbr/core/math.h"
#include "easypbr/scene/resolved_light.h"

namespace easypbr::render {

/// One map. A point of the world is at (x, y, z) = R_light_world (p - position), z along the light. On the
/// map it is at u, v = scale * (x, y) / w + offset, 0 .. 1, v = 0 at row 0, with w = z for a perspective view
/// and 1 for a parallel one. Its depth grows towards the light: near / z, or (far - z) / (far - near). Both
/// are linear on the map for any plane.
struct ShadowView {
    Mat3d R_light_world = Mat3d::Identity();
    Vec3d position{0, 0, 0};
    bool perspective = true;
    Vec2d scale{1, 1}, offset{0, 0};
    double near = 1, far = 2;

    /// For drawing: row 0 of the map is the top of the clip space.
    Mat4d clip_from_world() const;
};

/// The maps of one light: one, or the six faces of a cube in the order +x -x +y -y +z -z. A face's x and y
/// are the world's axes that follow its own in the order x y z x y, and its slopes reach `cube_slope`.
struct ShadowProjection {
    std::array<ShadowView, 6> views;
    int count = 1;
    double nearest_depth = 1;  ///< no caster's depth is larger

    bool is_cube() const { return count == 6; }
};

/// Slopes a cube's face reaches beyond its edges, so that filters near them find what they need.
inline constexpr double cube_slope = 1.1;

/// Fits maps of `resolution` texels to the casters' bounds, beyond which they may be pushed away from the
/// light by `behind`, world units: a parallel view for directional lights, one perspective view for spots and
/// for lights that see all casters within 60 degrees of one direction, a cube for others. Nothing when the
/// bounds are empty or have no extent.
std::optional<ShadowProjection> project_shadows(const ResolvedLight& light, const Box3d& casters,
                                                int resolution, double behind = 0);

/// The maps that a light at `position` needs for surfaces within a box, as bits: faces of a cube that see any
/// of it, or the only map.
unsigned needed_maps(const ShadowProjection& projection, const Box3d& receivers);

/// The light at one of its own points, for sample `index` of `count`: of the ball of its radius, distributed
/// so that it looks like an evenly glowing disc from everywhere; of a directional light's disc of directions.
/// One sample is the light's centre.
ResolvedLight sampled_light(const ResolvedLight& light, int index, int count);

}  // namespace easypbr::render
