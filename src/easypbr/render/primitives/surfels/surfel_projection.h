// The ellipse of a surfel on the screen.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// No splat gets smaller than a pixel-sized square, which holds exactly one pixel's centre: the screen-space
/// filter of EWA splatting as Botsch et al. 2005 approximate it, made no larger than it has to be.
constexpr float least_surfel_radius = 0.5f;

/// The same for a surfel whose normal has the cosine `facing` to the direction towards the viewer. Those that
/// turn away lie just behind the rim of closed surfaces, which they would make ragged: seen edge-on they need
/// no pixel of their own.
inline float least_radius(float facing) {
    return facing < 0 ? std::max(1e-3f, -facing * least_surfel_radius) : least_surfel_radius;
}

/// A surfel at p with semi-axes t and b covers the points p + u t + v b with u^2 + v^2 <= 1. Homogeneous
/// pixel coordinates relative to the centre's are linear in (u, v, 1), so that the inverse of a 3 x 3 matrix
/// takes a pixel back to (u, v), right under perspective (Sigg et al. 2006, "GPU-Based Ray-Casting of
/// Quadratic Surfaces").
struct SurfelProjection {
    float centre_x, centre_y;  ///< pixels
    float tx, ty, bx, by, wc;  ///< columns of the matrix; that of the centre is (0, 0, wc)
    float qx, qy, qz;          ///< t x b
    float z_t, z_b, z_c;       ///< axial distance is z_c + u z_t + v z_b
    float x0, x1, y0, y1;      ///< box, pixels, relative to nothing
    float least;               ///< half the side of the smallest square it covers, pixels
    float band;                ///< surfels that deep behind the nearest are blended with it
    Vec3 normal;               ///< in world space, towards the viewer, of any length
    Vec3 color;                ///< its own, sRGB-encoded; undefined where the item shows none

    /// Of a pixel's centre: the squared radius in the ellipse, above 1 outside, and the axial distance.
    struct Hit {
        float r2, z;
    };
    Hit at(float x, float y) const {
        const float dx = x - centre_x, dy = y - centre_y;
        const float far = std::max(std::abs(dx), std::abs(dy)) / least;
        const float screen = far * far;
        const float q = qx * dx + qy * dy + qz;
        const float scale = wc / q;
        const float u = (by * dx - bx * dy) * scale, v = (tx * dy - ty * dx) * scale;
        const float r2 = u * u + v * v;
        // Not a number where the surfel is seen edge-on.
        if (r2 < screen) return {r2, z_c + u * z_t + v * z_b};
        return {screen, z_c};
    }
};

/// Smooth from 1 in the middle to almost nothing at the rim, so that rims leave no trace.
inline float surfel_weight(float r2) {
    const float f = std::max(0.0f, 1 - r2);
    return std::max(f * f, 1e-4f);
}

/// Semi-axes of a surfel in the mesh's frame. `towards`: the direction that it faces where it has no normal;
/// `radius`: its size where the mesh has no tangents; `scale`: a factor.
struct SurfelAxes {
    Vec3 t, b;
};
SurfelAxes surfel_axes(const MeshData& mesh, Eigen::Index i, const Vec3& towards, float radius, float scale);

/// All surfels of an item in a frame.
class SurfelProjector {
  public:
    /// `spacing`: mean distance of the points, for items without tangents.
    SurfelProjector(const DrawItem& item, const Frame& frame, double spacing);

    /// Nothing for a surfel before the near plane or outside of the picture.
    std::optional<SurfelProjection> project(Eigen::Index i) const;

    /// Asks for what the others read of a surfel.
    void prefetch(Eigen::Index i) const;

  private:
    const DrawItem* item_;
    Mat4 clip_from_mesh_, view_from_mesh_;
    Mat3 normal_from_mesh_, world_from_mesh_;
    Vec3 eye_;             ///< in the mesh's frame
    Vec3 towards_viewer_;  ///< orthographic, in the mesh's frame
    bool orthographic_;
    float width_, height_, near_, scale_, radius_;
};

}  // namespace easypbr::render
