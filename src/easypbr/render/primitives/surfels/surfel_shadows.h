// Surfels as casters of shadows: each is its ellipse.
#pragma once

#include <utility>

#include "easypbr/core/revision_cache.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/shadow_layer.h"
#include "easypbr/render/primitives/surfels/ellipse_raster.h"
#include "easypbr/render/primitives/surfels/surfel_buffers.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

class SurfelShadows {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    SurfelShadows(SpacingCache& spacings, SurfelCache& surfels) : spacings_(spacings), surfels_(surfels) {}

    /// Radius of surfels without tangents, in the mesh's units; 0 where all have their own.
    double radius(const DrawItem& item);
    /// See Primitive.
    double reach(const DrawItem& item);
    void rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths);
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer);
    void draw(const ShadowLayer& layer, const Casters& casters);

    void evict_unused() { reaches_.evict_unused(); }

  private:
    /// A function from a surfel to its ellipse on a layer of a map.
    auto ellipses_of(const ShadowView& view, const DrawItem& item, int resolution);

    SpacingCache& spacings_;
    SurfelCache& surfels_;
    RevisionCache<std::pair<uint64_t, uint64_t>, double> reaches_;  ///< by the revisions of T and B
    ProgramVariants programs_{"shadow_surfels.vert", "shadow_surfels.frag"};
};

}  // namespace easypbr::render
