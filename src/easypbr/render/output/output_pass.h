// From radiance to the picture: accumulation of samples, tone curve, background, encoding, anti-aliasing of
// single frames.
#pragma once

#include "easypbr/core/image.h"
#include "easypbr/gl/texture.h"
#include "easypbr/render/denoise/radiance_mean.h"
#include "easypbr/render/effects/bloom/glow.h"
#include "easypbr/render/effects/effect.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

using easypbr::Encoding;

class BackgroundImage;

/// A picture whose radiance is in host memory alone is finished there, natively; any other by the driver.
class OutputPass {
  public:
    /// The transfers must outlive this.
    explicit OutputPass(Transfers& transfers) : transfers_(transfers) {}

    /// Forgets the sum and makes targets for this size and encoding. `without_image`: of a background that is
    /// an image; the picture is transparent.
    void begin(Vec2i size, Encoding encoding, bool without_image);
    /// Whether the picture is in host memory alone: write_exact() leaves it there.
    bool is_finished_natively() const { return picture_.is_ahead(); }
    /// Adds a frame's radiance to the sum. Not needed for a picture of one sample. `surfaces`: the frame's.
    void accumulate(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces);
    /// Adds a path traced frame of layers over exact colours to a mean of its own.
    void accumulate_layers(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces);
    /// That mean, denoised as the picture is. It lives until the next call.
    LitPicture layers_mean(const Frame& frame);
    /// Whether the frames of noisy light are as good as image.noise asks; false where they are not of such
    /// light, or nothing is asked. See RadianceMean::is_good().
    bool is_good(const Frame& frame) const;
    /// Ends tiles of noisy light that are as good as image.noise asks. See RadianceMean::end_tiles().
    void end_tiles(const Frame& frame);
    /// Which still get samples.
    const SampledTiles& tiles() const { return mean_.tiles(); }
    /// Writes the picture from the sum of the frames so far, or from the radiance of the only one.
    /// `surfaces`: those of the last frame.
    /// `exact`: the G-buffer whose exact colours anti-aliasing leaves alone, where there are some. Returns
    /// what it shows, of noisy light the mean, which lives as long as that of RadianceMean.
    LitPicture finish(const Frame& frame, const LitPicture& lit, BackgroundImage* background,
                      const GBuffer& surfaces, const GBuffer* exact);
    /// Puts the exact colours that the G-buffer holds into the finished picture, lines in the overlay over
    /// them. With `layers` radiance and overlay hold all that lies before the colours.
    void write_exact(const Frame& frame, const LitPicture& lit, const GBuffer& targets, bool layers);

    /// Row 0 is the top of the picture.
    const Target& picture() const { return picture_; }
    /// The picture's texture, to read and to draw to.
    const gl::Framebuffer& framebuffer() const;
    const gl::Texture& texture() const;
    /// The texture for others to draw to by framebuffers of their own.
    const gl::Texture& drawn() const;
    gl::Format format() const { return picture_.format(); }

  private:
    void blur_edges(const Frame& frame, const LitPicture& lit, const GBuffer* exact);
    bool is_transparent(const Frame& frame) const;
    /// Linear display light behind everything, premultiplied by alpha.
    Vec4 behind(const Frame& frame) const;
    /// What finish() reads; null: the radiance of the only frame, or the mean.
    const Target* sum_of(const Frame& frame) const;
    void finish_by_driver(const Frame& frame, const LitPicture& lit, BackgroundImage* background,
                          const GBuffer* exact);
    void finish_natively(const Frame& frame, const LitPicture& lit, BackgroundImage* background,
                         const GBuffer* exact);
    void blur_edges_natively(const Frame& frame, const LitPicture& lit, const GBuffer* exact);
    ShaderInputs edge_inputs(const Frame& frame, const LitPicture& lit, const GBuffer* exact) const;
    /// Adds a frame of noisy light to a mean, before the tone curve.
    void add_radiance(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces, RadianceMean& mean);
    /// How such frames' mean is denoised.
    Denoising denoising_of(const Frame& frame) const;
    /// The mean of such frames so far, as if it were the only one.
    LitPicture mean_of(const Frame& frame, const LitPicture& lit, RadianceMean& mean);
    void add_natively(const Frame& frame, const LitPicture& lit, const ShaderInputs& values);
    /// Adds what a frame's surfaces leave of a shadow catcher, where the picture tells it from its shadow.
    void add_shadow_share(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces);
    ShaderInputs display_inputs(const Frame& frame, const LitPicture& lit, const Target* sum) const;

    Transfers& transfers_;
    PixelRect drawn_;  ///< what the frames of the sum cover together
    Encoding encoding_ = Encoding::srgb8;
    bool without_image_ = false;  ///< see begin()
    Target sum_, picture_, aliased_;
    Target shadow_share_;       ///< R32F, the sum of all frames
    RadianceMean mean_;         ///< of frames whose radiance is averaged
    RadianceMean layers_mean_;  ///< of what lies before exact colours
    gl::Framebuffer sum_framebuffer_, sample_framebuffer_, share_framebuffer_;
    mutable gl::Framebuffer picture_framebuffer_;
    ScreenShader accumulate_{"accumulate_sample.frag", native::Shader::accumulate_sample};
    ScreenShader display_{"display_output.frag", native::Shader::display_output};
    ScreenShader share_{"shadow_share.frag", native::Shader::shadow_share};
    ScreenShader exact_{"exact_surface.frag", native::Shader::exact_surface};
    ScreenShader fxaa_{"antialias_fxaa.frag", native::Shader::antialias_fxaa};
};

}  // namespace easypbr::render
