// Points and surfels as casters of shadows.
#pragma once

#include <map>

#include "easypbr/gl/draw.h"
#include "easypbr/gpu/point_buffers.h"
#include "easypbr/gpu/surfel_buffers.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/raster/visibility.h"
#include "easypbr/render/shadow/shadow_view.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

/// A point is a disc that faces the light, as wide as the picture draws it by default (a size in pixels has
/// no meaning for a light). A point with a normal, which is lit and must not shadow its neighbours, is pushed
/// away from the light until the disc's upper edge lies on its surface. A surfel is its ellipse.
class SplatShadows {
  public:
    /// The caches are shared with other passes, must outlive this one, and are emptied by their owner.
    SplatShadows(SpacingCache& spacings, gpu::PointCache& points, gpu::SurfelCache& surfels)
        : spacings_(spacings), points_(points), surfels_(surfels) {}

    /// Radius of the disc of a point, in world units.
    double point_radius(const DrawItem& item);
    /// Radius of surfels without tangents, in the mesh's units; 0 where all have their own.
    double surfel_radius(const DrawItem& item);
    /// How far an item's splats reach beyond its vertices, in world units.
    double reach(const DrawItem& item, bool surfels);

    /// Into the bound layer of a map of `resolution` texels.
    void draw_points(const ShadowView& view, const DrawItem& item, int resolution,
                     const gl::DrawState& state);
    void draw_surfels(const ShadowView& view, const DrawItem& item, const gl::DrawState& state);

    static bool suits_native(const DrawItem& item) {
        return item.alpha == AlphaMode::opaque && !item.casts_tint();
    }
    void draw_points_natively(const ShadowView& view, const DrawItem& item, VisibilityBuffer& visibility);

    void evict_unused();

  private:
    struct Reach {
        double radius = 0;
        bool used = false;
    };

    SpacingCache& spacings_;
    gpu::PointCache& points_;
    gpu::SurfelCache& surfels_;
    std::map<std::pair<uint64_t, uint64_t>, Reach> reaches_;  ///< of surfels, by the revisions of T and B
    ProgramVariants point_programs_{"shadow_points.vert", "shadow_points.frag"};
    ProgramVariants surfel_programs_{"shadow_surfels.vert", "shadow_surfels.frag"};
};

}  // namespace easypbr::render
