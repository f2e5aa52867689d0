// Gaussian splats by a GPU: projected and sorted by compute shaders, blended as rectangles.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/gl/draw.h"
#include "easypbr/gpu/radix_sort.h"
#include "easypbr/gpu/splat_buffers.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/splats/splat_light.h"

namespace easypbr::render {

/// What SplatCompositor does on the CPU for splats that are not lit, but for splats of the same depth to the
/// last bit, which keep the order in which they are given, and for harmonics, of 16 bits here.
class SplatDriver {
  public:
    /// Projects and sorts the splats of the items. False: the driver cannot, or has not the memory.
    bool begin(const Frame& frame, const std::vector<const DrawItem*>& items, SplatLight& light);
    /// Blends them over the overlay. `opaque` (reversed depth) hides what is behind it; null: nothing does.
    void blend(const Frame& frame, const GBuffer& targets, const Target* opaque);
    /// Drops what was not asked for since the last call; all after some pictures that asked for nothing, as
    /// those of layers do.
    void evict_unused();

  private:
    void drop();
    bool has_room(const std::vector<const DrawItem*>& items);
    void project(const Frame& frame, const DrawItem& item, uint32_t first, SplatLight& light);
    /// Null: all arrives.
    const gl::Buffer* sides_of(const DrawItem& item, SplatLight& light);

    std::optional<gl::StorageLimits> limits_;
    bool has_memory_ = true;
    static constexpr int most_pictures_without = 16;
    int pictures_without_ = most_pictures_without;  ///< since the last that began here
    gpu::SplatBufferCache buffers_;
    /// Of the light that reaches splats: what is known of both sides of all of them.
    RevisionCache<std::shared_ptr<SplatLight::Parts>, gl::Buffer> sides_;
    gpu::RadixSort sort_;
    std::map<std::vector<std::string>, gl::Program> projections_;
    gl::Buffer splats_, depths_, order_, quads_;
    uint32_t room_ = 0;
    gl::Texture blended_;  ///< RGBA32F: sRGB-encoded, premultiplied
    gl::Framebuffer blending_;
    ProgramVariants rectangles_{"overlay_gaussians.vert", "overlay_gaussians.frag"},
        over_{"screen_triangle.vert", "overlay_splats.frag"};
};

}  // namespace easypbr::render
