// Splats as they lie on the screen (Zwicker et al., "EWA Splatting", 2002; Kerbl et al. 2023).
#pragma once

#include <cstdint>

#include "easypbr/native/kernels.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/shadow_view.h"

namespace easypbr::render {

using native::least_splat_alpha;
using native::most_splat_alpha;
using ProjectedSplat = native::ScreenSplat;

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
