// Ambient occlusion: how much of its hemisphere each visible point sees.
#pragma once

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

/// Ground-truth ambient occlusion (Jimenez et al. 2016) or the normal-oriented hemisphere (Bavoil and Sainz
/// 2008), at half resolution and magnified. A single frame is blurred within surfaces. Accumulated frames
/// take another pixel of each four and other directions each, and their mean needs no blur; that of many is
/// computed at full resolution.
class AmbientOcclusionPass {
  public:
    /// What is known of the surfaces in the G-buffer.
    struct Surfaces {
        bool points = false;          ///< some may have no normal: they get that of the surface they sample
        bool mapped_normals = false;  ///< some lean from their surface, which must not hide what they face
        Box3d occluders{};            ///< holds all but the ground; empty where it is not known
        bool needs_normals() const { return points || mapped_normals; }
    };
    /// Adds and fills the G-buffer's visibility from its depth and normals.
    void draw(const Frame& frame, GBuffer& targets, const Surfaces& surfaces);

    /// How far occluders are looked for, in pixels of a frame of the whole picture; 0 where it is off.
    static double reach(const Frame& whole, const Box3d& bounds);

    /// The same natively: from and to host memory.
    void shade(const Frame& frame, GBuffer& targets, const Surfaces& surfaces, Transfers& transfers);

  private:
    struct Step;
    struct Plan {
        bool half = false, blurred = false;
        bool takes_turns = false;  ///< of the four pixels that one of half the resolution stands for
        ScreenShader* sampling = nullptr;
        std::vector<std::string> defines;
    };
    static std::vector<std::string> defines_of(const Frame& frame, const Surfaces& surfaces);
    Plan plan_of(const Frame& frame, const Surfaces& surfaces);
    void make_targets(Vec2i size, bool half);
    void make_framebuffers();
    void make_normals(Vec2i size);
    void estimate_normals(const Frame& frame, const GBuffer& targets, const Surfaces& surfaces);
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
    Box3d occluders_;
    ScreenShader estimating_{"occlusion_normals.frag", native::Shader::occlusion_normals};
    ScreenShader selecting_{"occlusion_select.frag", native::Shader::occlusion_select};
    ScreenShader horizon_{"occlusion_horizon.frag", native::Shader::occlusion_horizon};
    ScreenShader hemisphere_{"occlusion_hemisphere.frag", native::Shader::occlusion_hemisphere};
    ScreenShader blurring_{"occlusion_blur.frag", native::Shader::occlusion_blur};
    ScreenShader magnifying_{"occlusion_magnify.frag", native::Shader::occlusion_magnify};
};

}  // namespace easypbr::render
