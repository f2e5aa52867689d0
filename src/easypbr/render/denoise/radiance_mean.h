// The mean of frames of noisy light, in linear radiance, and how it is denoised.
#pragma once

#include <atomic>
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
    /// Forgets all frames. `with_surfaces`: they are taken note of, for mean() with a denoiser and is_good().
    void begin(Vec2i size, bool with_surfaces);

    /// Adds a frame's overlay, RGBA16F, before begin_frame(): each frame counts by what its overlay leaves of
    /// it.
    void add_overlay(const Frame& frame, const Target& overlay, Transfers& transfers);
    /// `see_through`: what surfaces cover may be noisy as well as their light, where a shadow catcher or the
    /// background is seen through them by chance: it differs from the alpha of their base colours.
    void begin_frame(const Frame& frame, bool see_through);
    /// Takes a frame's radiance, RGBA32F: written before add(), in either memory.
    const Target& sample() const { return sample_; }
    /// Adds what sample() holds in a rectangle of a frame with these surfaces, but for tiles that have ended.
    /// Downloads what is not in host memory. No two rectangles of a frame may overlap.
    void add(const Frame& frame, const PixelRect& area, const GBuffer& surfaces, Transfers& transfers);
    void end_frame();

    /// Whether the frames so far are enough: in 95 of 100 squares of 16 x 16 pixels the standard error of
    /// what is displayed with an exposure is below `noise`, a part of white, and what changes from frame to
    /// frame besides, as silhouettes do, has as many frames as make it smooth. True where nothing is to be
    /// seen. Surfaces must be taken note of.
    bool is_good(float noise, float exposure) const;

    /// Ends tiles whose pixels' standard error is below `noise` by its quadratic mean, which few bright
    /// pixels raise more than the mean that noise() is of. Asks for surfaces, too. Does so after few frames
    /// only: each look at the noise is a chance to end by luck.
    void end_tiles(float noise, float exposure);
    const SampledTiles& tiles() const { return tiles_; }

    /// The means so far, in host memory; of radiance 0 where overlays leave none of it. They live until the
    /// next call of a member. Denoisers take light for dark or bright as it is exposed. Throws Error when a
    /// denoiser that is asked for by name fails.
    const Target& mean(Denoising denoising, float exposure, Transfers& transfers);
    /// Null where there was none.
    const Target* overlay_mean();

  private:
    size_t index_of(int x, int y) const { return size_t(y) * size_t(sample_.width()) + size_t(x); }
    float open_part(size_t pixel) const { return open_.empty() ? 1.0f : open_[pixel]; }
    /// Calls visit(index, x, y) for all pixels of a rectangle, row by row.
    template <class Visit>
    void each(const PixelRect& area, Visit&& visit) const {
        for (int y = area.y; y < area.y + area.height; ++y)
            for (int x = area.x; x < area.x + area.width; ++x) visit(index_of(x, y), x, y);
    }
    void begin_weights();
    /// A frame's surfaces in host memory.
    class FrameSurfaces;
    class RowOfFrame;
    void add_to_tile(size_t tile, const PixelRect& area, const FrameSurfaces* surfaces);
    /// The same where nothing is noisy.
    void add_beside(size_t tile, const PixelRect& area);
    void add_row(size_t tile, const PixelRect& row, const FrameSurfaces& surfaces,
                 const native::BesideNoisy& of_row, bool has_beside);
    /// Standard errors of what is displayed, over the pixels of a tile that show a surface.
    struct TileError {
        float mean = 0, quadratic = 0;
        int pixels = 0;
        bool has_silhouette = false;  ///< some frames show a surface at a pixel, and others none
    };
    /// Some pixels of a tile are at a silhouette.
    static bool is_edge(const TileError& error);
    TileError error_of(size_t tile, float exposure) const;
    /// The mean errors of tiles; those of few pixels are taken together until they are enough.
    static std::vector<float> mean_errors(const std::vector<TileError>& tiles);
    void write_noisy_light();
    bool has_noisy_coverage() const;
    void write_noisy_coverage();
    /// What light_ holds; see NoisyLight.
    const Target& denoised(Denoising denoising, bool is_white, float white, Transfers& transfers);
    /// What denoising adds to the sum of the coverages of pixels whose light is denoised; empty where none
    /// has noise.
    std::vector<float> denoised_coverage(Denoising denoising, Transfers& transfers);
    /// Writes the mean of all frames. `light`, unless it is null: what is seen in place of the noisy light;
    /// it may be the same target.
    void write_mean(const Target& to, const Target* light, const std::vector<float>& coverage);

    int frames_ = 0;
    SampledTiles tiles_;
    bool notes_surfaces_ = false;
    /// Frames differ by what is not known to be noise: unlit surfaces, lines, motion, a lens.
    std::atomic<bool> varies_ = false;
    /// Sums of all frames: of pixels with noise, and beside them of what is not noisy.
    TileValues<native::NoisyTile> noisy_;
    struct Sum {
        Vec4 radiance = Vec4::Zero();
    };
    TilePixels<Sum> beside_;
    Target sample_;  ///< later a scratch target of denoisers, and the mean
    Target light_;
    /// Of pixels that note radiance: sums of what the coverage differs by from that which is certain, and of
    /// its square. Empty where it has no noise.
    PooledVector<Vec2> coverage_;
    PooledVector<Vec4> overlay_sum_;
    /// Of the frame: what its overlay leaves of the light. Empty: all.
    PooledVector<float> open_;
    /// Sums of that over all frames, and over those that show a surface; empty where all of it is left.
    PooledVector<Vec2> weights_;
    Target overlay_mean_;
    EdgeAvoidingFilter filter_;
    OpenImageDenoise oidn_;
};

}  // namespace easypbr::render
