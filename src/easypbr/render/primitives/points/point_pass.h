// Point clouds into the G-buffer by the driver.
#pragma once

#include <span>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/points/point_buffers.h"
#include "easypbr/scene/spacing_cache.h"

namespace easypbr::render {

class PointPass {
  public:
    /// The caches are shared with others, must outlive this one, and are emptied by their owner.
    PointPass(SpacingCache& spacings, PointCache& points) : spacings_(spacings), cache_(points) {}

    /// Adds the points to what the G-buffer holds, in two passes: the first finds the nearest depth and
    /// empties its pixel, the second keeps, channel by channel, the largest of what lies at that depth. So
    /// coincident points give the same picture in any order.
    void draw(const Frame& frame, std::span<const DrawItem> items, const GBuffer& targets,
              const SurfaceOutputs& outputs);

  private:
    void draw_items(const Frame& frame, std::span<const DrawItem> items, const SurfaceOutputs& outputs,
                    bool write);

    SpacingCache& spacings_;
    PointCache& cache_;
    ProgramVariants programs_{"geometry_points.vert", "geometry_points.frag"};
};

}  // namespace easypbr::render
