// A denoiser that is always there: a wavelet transform that stops at edges, guided by variance.
#pragma once

#include "easypbr/render/denoise/noisy_light.h"
#include "easypbr/render/frame/screen_shader.h"

namespace easypbr::render {

class EdgeAvoidingFilter {
  public:
    /// Levels of the transform; the last sees as far as `reach` pixels, estimates of two pixels included.
    static constexpr int levels = 5;
    static constexpr int reach = (1 << levels) + 2;

    /// Smooths the light; returns the target that holds it, `light` or `scratch`, both of which are
    /// overwritten.
    const Target& smooth(const NoisyLight& noisy, Transfers& transfers);

  private:
    /// Of the first level: pixels whose estimates it compares.
    static constexpr int first_reach = 2;
    void write_guides(const NoisyLight& noisy);

    /// For each pixel: packed normal and reflectance, log2 of the depth, the hue's noise.
    Target guides_;
    Target estimate_, estimated_hue_;  ///< of denoise_estimate.frag, of a band of rows
    ScreenShader estimating_{"denoise_estimate.frag", native::Shader::denoise_estimate};
    ScreenShader smooth_{"denoise_smooth.frag", native::Shader::denoise_smooth};
};

}  // namespace easypbr::render
