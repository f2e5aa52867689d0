// Splats as they lie on the screen (Zwicker et al., "EWA Splatting", 2002; Kerbl et al. 2023).
#pragma once

#include <cstdint>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/shadow_view.h"

namespace easypbr::render {

/// Nothing that is less opaque is drawn (Kerbl et al. 2023).
inline constexpr float least_splat_alpha = 1.0f / 255;
/// No splat hides what is behind it altogether.
inline constexpr float most_splat_alpha = 0.99f;

/// Its opacity at a pixel's centre p is opacity * exp(-(xx dx^2 + 2 xy dx dy + yy dy^2) / 2), d = p - centre,
/// and what is seen of it there is where it is densest along the pixel's ray, at depth + depth_x dx + depth_y
/// dy (Zwicker et al. 2002), to first order. A cache line.
struct alignas(64) ProjectedSplat {
    float x, y;                     ///< centre, in pixels of the frame
    float xx, xy, yy;               ///< inverse of the covariance, per square pixel
    float opacity;                  ///< at the centre
    float red, green, blue;         ///< sRGB-encoded, 0 or more
    float depth;                    ///< of its mean, as GBuffer::depth has it
    float depth_x, depth_y;         ///< change of the depth, per pixel
    float half_width, half_height;  ///< of the box, in pixels, outside of which it is not seen
    /// Inverse of the standard deviation of its density along a pixel's ray, per unit of depth.
    float sharpness;
    uint32_t index;  ///< of the vertex
};

/// What splats are projected by.
struct SplatView {
    Mat4d view_from_world, clip_from_view;
    Vec2i size;                  ///< pixels
    Vec2i picture_size, origin;  ///< see Shot
    bool orthographic = false;
    double near = 0;           ///< of a perspective view
    bool keeps_light = false;  ///< opacities fall as splats are widened, whatever their style says
};

SplatView view_of(const Frame& frame);
/// A map of so many texels a side.
SplatView view_of(const ShadowView& view, int resolution);

/// Projects the splats of an item. The covariance is that of the projection's derivative at the mean, widened
/// by a low-pass of 0.3 square pixels as in training. Where the style asks for it the opacity falls by as
/// much as the area grows (the 2D filter of Yu et al., "Mip-Splatting", 2024).
class SplatProjector {
  public:
    /// The item must outlive this.
    SplatProjector(const SplatView& view, const DrawItem& item);

    /// All but its colour. False for one that is not seen: behind the near plane, outside of the picture or
    /// of no opacity.
    bool project(Eigen::Index i, ProjectedSplat& splat) const;
    /// Adds the colour that is seen.
    void color(Eigen::Index i, ProjectedSplat& splat) const;

  private:
    /// Where a splat's mean is seen, and the derivative of column, row and depth by the place in view space;
    /// false where it is not.
    bool place(const Vec3d& mean, ProjectedSplat& splat, Mat3& derivative) const;
    /// From the semi-axes as columns, row and depth have them.
    bool widen(const Mat3& axes, ProjectedSplat& splat) const;
    Vec3 color_of(Eigen::Index i) const;

    SplatView view_;
    const DrawItem& item_;
    const MeshData& mesh_;
    int degree_;
    Eigen::Matrix<double, 3, 4> view_from_mesh_;
    Mat3 turn_;          ///< of view_from_mesh_
    Vec3d eye_;          ///< in the frame of the splats; orthographic: where the camera looks
    float least_width_;  ///< of clip space at the near plane
};

}  // namespace easypbr::render
