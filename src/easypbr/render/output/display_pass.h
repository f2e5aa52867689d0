// Colours that are shown as they are, past light and tone curve: points without normals, tables of labels.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

class DisplayPass {
  public:
    /// Clears the overlay and draws into it what the G-buffer holds of such kinds.
    void draw(const Frame& frame, const GBuffer& targets);
    /// The same natively: the overlay holds `area` in host memory then.
    void shade_overlay(const Frame& frame, const GBuffer& targets, const PixelRect& area,
                       Transfers& transfers);

    /// The eye-dome lighting of points that light passes, R16: a factor by where the nearest of them are and
    /// where the opaque surfaces (both R32F, reversed depth). Until the next call.
    const gl::Texture& shade(const Frame& frame, const gl::Texture& nearest, const gl::Texture& opaque);

    /// The same natively; `nearest` holds what is covered by points.
    const Target& shade(const Frame& frame, const Target& nearest, const Target& opaque,
                        Transfers& transfers);

    /// How far eye-dome lighting sees, in pixels of a frame of the whole picture.
    static int reach(const Frame& whole);

  private:
    ScreenShader surfaces_{"display_surface.frag", native::Shader::display_surface};
    ScreenShader layers_{"eye_dome_layers.frag", native::Shader::eye_dome_layers};
    gl::Texture shade_;
    Target host_shade_;
    gl::Framebuffer shaded_;
};

}  // namespace easypbr::render
