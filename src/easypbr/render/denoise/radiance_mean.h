// The mean of frames of noisy light, in linear radiance, and how it is denoised.
#pragma once

#include <vector>

#include "easypbr/core/memory_pool.h"
#include "easypbr/render/denoise/edge_avoiding_filter.h"
#include "easypbr/render/denoise/open_image_denoise.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/sampled_tiles.h"
#include "easypbr/scene/effects/ray_tracing.h"

namespace easypbr::render {

/// Light that no surface of a frame sends is kept apart from denoising: backgrounds stay exact. So do pixels
/// of a surface that shows its own colour.
class RadianceMean {
  public:
    /// Forgets all frames. `with_surfaces`: they are taken note of, for mean() with a denoiser and noise().
    void begin(Vec2i size, bool with_surfaces);

    /// Takes a frame's radiance, RGBA32F: written before add(), in either memory.
    const Target& sample() const { return sample_; }
    /// Adds what sample() holds in a rectangle of a frame with these surfaces, but for tiles that have ended.
    /// Downloads what is not in host memory. `see_through`: what surfaces cover may be noisy as well as their
    /// light, since a shadow catcher is seen through them.
    void add(const Frame& frame, const PixelRect& area, const GBuffer& surfaces, bool see_through,
             Transfers& transfers);
    /// Adds a frame's overlay, RGBA16F, before its radiance: each frame counts by what its overlay leaves of
    /// it.
    void add_overlay(const Frame& frame, const Target& overlay, Transfers& transfers);

    /// Of the frames so far: the standard error of what is displayed with an exposure, of white, that 95 of
    /// 100 squares of 16 x 16 pixels are below; 0 where no surface is. Surfaces must be taken note of.
    float noise(float exposure) const;

    /// Ends tiles whose pixels' standard error is below `noise` by its quadratic mean, which few bright
    /// pixels raise more than the mean that noise() is of. Asks for surfaces, too. Does so after few frames
    /// only: each look at the noise is a chance to end by luck.
    void end_tiles(float noise, float exposure);
    const SampledTiles& tiles() const { return tiles_; }

    /// No frame follows: the next mean() is the last of these frames, and releases what it has used.
    void end() { is_last_ = true; }

    /// The means so far, in host memory; of radiance 0 where overlays leave none of it. They live until the
    /// next call of a member. Throws Error when a denoiser that is asked for by name fails.
    const Target& mean(Denoising denoising, Transfers& transfers);
    /// Null where there was none.
    const Target* overlay_mean();

  private:
    size_t index_of(int x, int y) const { return size_t(y) * size_t(sum_.width()) + size_t(x); }
    float open_part(size_t pixel) const { return open_.empty() ? 1.0f : open_[pixel]; }
    /// On the mean over the frames that seen_ is of.
    float open_part_of_seen(size_t pixel) const {
        const float count = color_.pixels<Vec4>()[pixel].w();
        return count > 0 ? weights_[pixel].y() / count : 0.0f;
    }
    void begin_weights();
    void add_surfaces(const Frame& frame, const PixelRect& area, const GBuffer& surfaces);
    /// Standard errors of what is displayed, over the pixels of a tile that show a surface.
    struct TileError {
        float mean = 0, quadratic = 0;
        int pixels = 0;
        bool has_silhouette = false;  ///< some frames show a surface at a pixel, and others none
    };
    TileError error_of(size_t tile, float exposure) const;
    void write_noisy_light();
    void write_noisy_coverage();
    const Target& denoised(Denoising denoising, const Target& color, bool is_last, Transfers& transfers);
    /// What denoising adds to the sum of the coverages of pixels whose light is denoised; empty where none
    /// has noise.
    std::vector<float> denoised_coverage(Denoising denoising, Transfers& transfers);

    int frames_ = 0;
    SampledTiles tiles_;
    bool notes_surfaces_ = false;
    bool is_last_ = false;  ///< see end()
    Target sum_;            ///< of all frames
    /// Of frames that show a surface: its radiance, of a shadow catcher over nothing its coverage; a: the sum
    /// of squares of the luminance; and what NoisyLight has.
    Target seen_, surface_, color_;
    Target sample_;  ///< later a scratch target of denoisers, and the mean
    Target light_;
    /// What of each pixel is taken note of: that of its first frame with noise.
    enum class Noisy : uint8_t { nothing, radiance, coverage };
    PooledVector<Noisy> noisy_;
    /// Of pixels that note radiance: sums of the coverage and of its square. Empty where it has no noise.
    PooledVector<Vec2> coverage_;
    PooledVector<Vec4> overlay_sum_;
    /// Of the frame: what its overlay leaves of the light. Empty: all.
    PooledVector<float> open_;
    /// Sums of that over all frames, and over those that seen_ is of; empty where all of it is left.
    PooledVector<Vec2> weights_;
    Target overlay_mean_;
    EdgeAvoidingFilter filter_;
    OpenImageDenoise oidn_;
};

}  // namespace easypbr::render
