// From radiance to the picture: accumulation of samples, tone curve, background, encoding, anti-aliasing of
// single frames.
#pragma once

#include "easypbr/gl/texture.h"
#include "easypbr/render/effects/bloom/glow.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// What the picture's values are.
enum class Encoding {
    srgb8,        ///< RGBA8, tone mapped, sRGB-encoded, straight alpha
    srgb16,       ///< RGBA16, the same
    scene_linear  ///< RGBA32F, radiance before exposure and tone curve, premultiplied alpha
};

/// What a frame shows once its passes have run.
struct LitPicture {
    const gl::Texture* radiance = nullptr;  ///< as GBuffer::radiance
    const gl::Texture* overlay = nullptr;   ///< as GBuffer::overlay, where there is one
    const Glow* glow = nullptr;             ///< where bloom spreads light
    PixelRect covered;                      ///< all surfaces, lines and layers are inside
    bool partly_covered = false;            ///< the radiance may hold coverages between 0 and 1
    bool spreads = false;                   ///< light may fall beyond `covered`
};

class OutputPass {
  public:
    /// Forgets the sum and makes targets for this size and encoding.
    void begin(Vec2i size, Encoding encoding);
    /// Adds a frame's radiance to the sum. Not needed for a picture of one sample.
    void accumulate(const Frame& frame, const LitPicture& lit);
    /// Writes the picture from the sum of the frames so far, or from the radiance of the only one.
    /// `exact`: the G-buffer whose exact colours anti-aliasing leaves alone, where there are some.
    void finish(const Frame& frame, const LitPicture& lit, const gl::Texture* background_image,
                const GBuffer* exact);
    /// Puts the exact colours that the G-buffer holds into the finished picture, lines in the overlay over
    /// them. With `layers` radiance and overlay are those of a whole frame with something before the colours.
    void write_exact(const Frame& frame, const LitPicture& lit, const GBuffer& targets, bool layers);

    /// Row 0 of the framebuffer is the top of the picture.
    const gl::Framebuffer& picture() const { return picture_framebuffer_; }
    const gl::Texture& texture() const { return picture_; }
    gl::Format format() const { return picture_.format(); }

  private:
    void blur_edges(const Frame& frame, const PixelRect& area, const GBuffer* exact);

    PixelRect drawn_;  ///< what the frames of the sum cover together
    Encoding encoding_ = Encoding::srgb8;
    gl::Texture sum_, picture_, aliased_;
    gl::Framebuffer sum_framebuffer_, picture_framebuffer_, aliased_framebuffer_;
    ProgramVariants accumulate_{"screen_triangle.vert", "accumulate_sample.frag"};
    ProgramVariants display_{"screen_triangle.vert", "display_output.frag"};
    ProgramVariants exact_{"screen_triangle.vert", "exact_surface.frag"};
    ProgramVariants fxaa_{"screen_triangle.vert", "antialias_fxaa.frag"};
};

}  // namespace easypbr::render
