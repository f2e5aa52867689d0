// Passes of a program's own between those of the renderer, as the renderer calls them; app/custom_pass.h is
// what programs see of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/picture.h"
#include "easypbr/gl/program.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"

namespace easypbr::render {

using easypbr::Blend;
using easypbr::Stage;

/// What a pass draws with. Row 0 of every texture is the top of the picture.
class PassInput {
  public:
    PassInput(const Frame& frame_, const GBuffer& gbuffer_, const gl::Texture& image_,
              const gl::Framebuffer& target_, gl::Texture& copy)
        : frame(frame_), gbuffer(gbuffer_), image(image_), target(target_), copy_(copy) {}

    const Frame& frame;      ///< camera, size, settings
    const GBuffer& gbuffer;  ///< of the opaque surfaces. In stage `picture` that of the last frame, which was
                             ///< drawn within half a pixel of the pixels' centres
    const gl::Texture& image;       ///< what is drawn into; reading it meanwhile is undefined
    const gl::Framebuffer& target;  ///< with `image` alone

    /// The image as it is before this pass draws: a copy.
    const gl::Texture& before() const;
    /// Macros that shaders with common_camera.glsl need.
    std::vector<std::string> defines() const { return camera_defines(frame); }
    /// Draws a program of screen_triangle.vert and a fragment shader over the whole image. Of the uniforms
    /// that it has, these are set: those of common_camera.glsl (u_size among them), u_albedo, u_normal,
    /// u_material, u_depth_target (see GBuffer), u_image (before()), u_exposure, u_origin and u_picture_size
    /// (see Frame).
    void draw(const gl::Program& program, Blend blend = Blend::over) const;

  private:
    gl::Texture& copy_;
};

/// A pass of a program's own. It is called with the context current and may use any OpenGL; whatever state it
/// leaves behind, the renderer sets back what it needs, but for conditional rendering and transform feedback.
class Pass {
  public:
    virtual ~Pass() = default;
    /// What it throws ends the picture; windows show it and keep the last picture that there was.
    virtual void draw(const PassInput& input) = 0;
    /// Changes whenever the pass would draw something else: windows draw again then.
    virtual uint64_t revision() const { return 0; }
};

struct CustomPass {
    std::string name;
    Stage stage = Stage::overlay;
    std::shared_ptr<Pass> pass;
};

/// Draws one; what it throws gets its name. Sets back the state that the renderer's passes expect.
void draw_custom(const CustomPass& custom, const PassInput& input);

}  // namespace easypbr::render
