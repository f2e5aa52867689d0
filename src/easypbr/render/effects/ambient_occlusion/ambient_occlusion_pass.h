// Ambient occlusion: how much of its hemisphere each visible point sees.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// Ground-truth ambient occlusion (Jimenez et al. 2016) or the normal-oriented hemisphere (Bavoil and Sainz
/// 2008). A single frame is computed at half resolution, blurred within surfaces and magnified; the frames of
/// a longer accumulated image each take other directions at full resolution, and their mean needs no blur.
class AmbientOcclusionPass {
  public:
    /// Adds and fills the G-buffer's visibility from its depth and normals. Points without normals
    /// (`with_points`: there may be some) have those of the surface that they sample, estimated from the
    /// depth.
    void draw(const Frame& frame, GBuffer& targets, bool with_points);

    /// How far occluders are looked for, in pixels of a frame of the whole picture; 0 where it is off.
    static double reach(const Frame& whole, const Box3d& bounds);

  private:
    struct Step;
    void make_targets(Vec2i size, bool half);
    void estimate_normals(const Frame& frame, const GBuffer& targets);
    void run(const Frame& frame, const GBuffer& targets, const Step& step);

    Vec2i size_{0, 0};
    bool half_ = false;
    gl::Texture surface_;  ///< of half resolution, see shaders/occlusion_select.frag
    gl::Texture depth_, sampled_, blurred_;
    gl::Framebuffer select_, sample_, blur_;
    gl::Texture normal_;  ///< the G-buffer's and estimated ones
    gl::Framebuffer estimate_;
    bool estimated_ = false;
    ProgramVariants estimating_{"screen_triangle.vert", "occlusion_normals.frag"};
    ProgramVariants selecting_{"screen_triangle.vert", "occlusion_select.frag"};
    ProgramVariants horizon_{"screen_triangle.vert", "occlusion_horizon.frag"};
    ProgramVariants hemisphere_{"screen_triangle.vert", "occlusion_hemisphere.frag"};
    ProgramVariants blurring_{"screen_triangle.vert", "occlusion_blur.frag"};
    ProgramVariants magnifying_{"screen_triangle.vert", "occlusion_magnify.frag"};
};

}  // namespace easypbr::render
