// The light of what is seen, by path tracing on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/sampled_tiles.h"
#include "easypbr/render/raytrace/firefly_filter.h"
#include "easypbr/render/raytrace/path_tracer.h"

namespace easypbr::render {

/// In place of occlusion, shadow maps and lighting: one path from each pixel of the G-buffer and frame.
class PathPass {
  public:
    /// Writes the radiance of all that the G-buffer holds, in host memory: emission and what paths bring.
    /// `caught`, unless it is null: of a ground that catches shadows, see GroundPass::caught_part().
    /// `tiles`, unless it is null: no path starts in those that have ended, whose radiance is 0.
    void draw(const Frame& frame, const GBuffer& targets, const RayScene& scene, const Target* caught,
              const SampledTiles* tiles, Transfers& transfers);
    /// In place of draw(), where nothing but layers is lit: the radiance is 0, and all light is caught.
    void begin_layers(const Frame& frame, const GBuffer& targets, const RayScene& scene,
                      const Target* caught);
    /// The same of surfaces in front of those of the last draw(), which light passes.
    void draw_layer(const Frame& frame, const GBuffer& layer, const RayScene& scene,
                    const SampledTiles* tiles, Transfers& transfers);

    /// Releases what draw() keeps from frame to frame: the next one begins a picture.
    void end() {
        caught_.release();
        fireflies_.end();
    }

  private:
    struct Pixels;
    /// Of which pixels paths begin, and at what.
    struct Starts {
        const SampledTiles* tiles = nullptr;
        Transmissive seen = Transmissive::opaque;  ///< how rays find what a pixel shows
        const Target* caught = nullptr;            ///< a shadow catcher's light is wanted
    };
    void trace(const Frame& frame, const GBuffer& targets, const RayScene& scene, const Starts& starts,
               Transfers& transfers);
    struct Block;
    void trace_block(const Pixels& pixels, const PixelRect& block);
    /// Adds what fireflies_ spreads.
    void spread_fireflies(const Pixels& pixels);
    /// What rays find of pixels whose surfaces the G-buffer does not hold all of: notes them, and adds those
    /// of which they find nothing to `others`.
    std::vector<PathTracer::Hit> hits_of(const Pixels& pixels, Block& extended, std::vector<bool>& is_hit,
                                         Block& others) const;
    /// What surfaces that catch shadows get, by the pixels' index among `count`.
    std::vector<CaughtLight> light_of(const Pixels& pixels, Block& caught, size_t count);

    PathTracer tracer_;
    FireflyFilter fireflies_;
    /// The part of a shadow catcher's light that arrives at a pixel: the ratio of sums over all frames so
    /// far.
    struct Caught {
        /// Whether it gets a sample.
        bool is_due(int turn) const { return period == 0 || unsigned(turn) % period == 0; }
        double ratio() const { return sum.all > 0 ? double(sum.arrives) / double(sum.all) : 1; }
        /// Returns by how much it changes the sum of frames, each of this ratio.
        float add(const CaughtLight& light);

        CaughtLight sum;
        uint32_t frames : 28 = 0;
        uint32_t period : 4 = 0;  ///< gets a sample every so many frames; 0: not known yet
    };
    static_assert(sizeof(Caught) == 12, "there is one for each pixel of a ground");
    class CaughtTile;
    /// Calls visit(x, y, index, kind, caught) for the pixels of a block of whole tiles that paths start from,
    /// tile by tile: index in the block, the surface's code, CaughtTile&. What read(left, y) names of a
    /// tile's row is fetched ahead.
    template <class Read, class Visit>
    void each_traced(const Pixels& pixels, const PixelRect& block, Read&& read, Visit&& visit);

    TilePixels<Caught> caught_;
};

}  // namespace easypbr::render
