// Points as casters of shadows.
#pragma once

#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/points/point_buffers.h"
#include "easypbr/render/primitives/shadow_layer.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// A point is a disc that faces the light, as wide as the picture draws it by default (a size in pixels has
/// no meaning for a light). A point with a normal, which is lit and must not shadow its neighbours, is pushed
/// away from the light until the disc's upper edge lies on its surface.
class PointShadows {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    PointShadows(SpacingCache& spacings, PointCache& points) : spacings_(spacings), points_(points) {}

    /// Radius of the disc of a point, in world units.
    double radius(const DrawItem& item);

    // See Primitive.
    void rasterise(const ShadowView& view, Casters& casters, ShadowDepths& depths);
    void rasterise_tints(const ShadowView& view, const Casters& casters, TintLayer& layer);
    void draw(const ShadowLayer& layer, const Casters& casters);

  private:
    PointSplats splats_of(const ShadowLayer& layer, const DrawItem& item);
    /// The centres of an item's discs, in its frame.
    Array3f centres_of(const ShadowView& view, const DrawItem& item);
    void draw(const ShadowLayer& layer, const DrawItem& item);

    SpacingCache& spacings_;
    PointCache& points_;
    VisibilityBuffer visibility_;
    ProgramVariants programs_{"shadow_points.vert", "shadow_points.frag"};
};

}  // namespace easypbr::render
