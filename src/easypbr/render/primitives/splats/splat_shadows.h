// 3D Gaussian splats as casters of shadows: they weaken light by their opacity.
#pragma once

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/frame/target.h"
#include "easypbr/render/primitives/shadow_layer.h"
#include "easypbr/render/primitives/splats/splat_set.h"

namespace easypbr::render {

/// Each is projected as in pictures (SplatProjector), so that a texel's light is the product of what each
/// leaves of it. Those that are smaller than a texel are as much less opaque as they are widened.
class SplatShadows {
  public:
    /// See Primitive.
    double reach(const DrawItem& item);
    void rasterise(const ShadowView& view, const Casters& casters, TintLayer& layer);
    /// The same into the layer that is bound: rasterised in host memory and uploaded.
    void draw(const ShadowLayer& layer, const Casters& casters);

    void evict_unused() { reaches_.evict_unused(); }

  private:
    SplatSet set_;
    RevisionCache<uint64_t, double> reaches_;  ///< by the revision of the scales
    Target absorption_, moment_;               ///< RGBA32F: what is uploaded
    ProgramVariants programs_{"screen_triangle.vert", "shadow_splats.frag"};
};

}  // namespace easypbr::render
