// Ambient occlusion: how much of its hemisphere each visible point sees.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

/// Ground-truth ambient occlusion (Jimenez et al. 2016) or the normal-oriented hemisphere (Bavoil and Sainz
/// 2008). A single frame is computed at half resolution, blurred within surfaces and magnified; the frames of
/// a longer accumulated image each take other directions at full resolution, and their mean needs no blur.
class AmbientOcclusionPass {
  public:
    /// Surfaces whose normals in the G-buffer are not those that visibility is about.
    struct Normals {
        bool of_points = false;  ///< some may have none: they get that of the surface that they sample
        bool mapped = false;     ///< some lean from their surface, which must not hide what they face
        bool any() const { return of_points || mapped; }
    };
    /// Adds and fills the G-buffer's visibility from its depth and normals.
    void draw(const Frame& frame, GBuffer& targets, Normals normals);

    /// How far occluders are looked for, in pixels of a frame of the whole picture; 0 where it is off.
    static double reach(const Frame& whole, const Box3d& bounds);

    /// The same natively: from and to host memory.
    void shade(const Frame& frame, GBuffer& targets, Normals normals, Transfers& transfers);

  private:
    struct Step;
    struct Plan {
        bool half = false, smooth = false;
        ScreenShader* sampling = nullptr;
        std::vector<std::string> defines;
    };
    Plan plan_of(const Frame& frame);
    void make_targets(Vec2i size, bool half);
    void make_framebuffers();
    void make_normals(Vec2i size);
    void estimate_normals(const Frame& frame, const GBuffer& targets, Normals normals);
    static std::vector<std::string> normal_defines(const Frame& frame, Normals normals);
    ShaderInputs surface_inputs(const Frame& frame, const GBuffer& targets,
                                const std::vector<std::string>& defines) const;
    ShaderInputs inputs_of(const Frame& frame, const GBuffer& targets,
                           const std::vector<std::string>& defines, const Target* visibility,
                           Vec2 axis) const;
    void run(const Frame& frame, const GBuffer& targets, const Step& step);

    Vec2i size_{0, 0};
    bool half_ = false;
    Target surface_;  ///< of half resolution, see shaders/occlusion_select.frag
    Target sampled_, blurred_;
    gl::Texture depth_;
    gl::Framebuffer select_, sample_, blur_;
    Target normal_;  ///< the G-buffer's and estimated ones
    gl::Framebuffer estimate_;
    bool estimated_ = false;
    ScreenShader estimating_{"occlusion_normals.frag", native::Shader::occlusion_normals};
    ScreenShader selecting_{"occlusion_select.frag", native::Shader::occlusion_select};
    ScreenShader horizon_{"occlusion_horizon.frag", native::Shader::occlusion_horizon};
    ScreenShader hemisphere_{"occlusion_hemisphere.frag", native::Shader::occlusion_hemisphere};
    ScreenShader blurring_{"occlusion_blur.frag", native::Shader::occlusion_blur};
    ScreenShader magnifying_{"occlusion_magnify.frag", native::Shader::occlusion_magnify};
};

}  // namespace easypbr::render
