// Lines into the overlay: unlit, wide in pixels, smooth, hidden by surfaces and by nearer lines.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/primitives/lines/line_buffers.h"

namespace easypbr::render {

/// Lines lie between the surfaces that light passes, each where it is:
///
///     begin(frame, items, targets, opaque);
///     for each layer, from the farthest on: draw_behind(frame, items, targets, layer);
///     draw_rest(frame, items, targets);
///     draw_over(frame, items, targets);
///
/// A line on a surface, as wide as it is, counts as before it.
class LinePass {
  public:
    /// Finds the nearest line of each pixel. Hidden is what lies behind `opaque` (R32F, reversed depth),
    /// whose normals are those of `targets`; both must stay as they are until the last of the others.
    void begin(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets,
               const gl::Texture& opaque);
    /// Adds to the overlay what lies behind a layer and has not been drawn.
    void draw_behind(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets,
                     const GBuffer& layer);
    /// Adds what lies before all layers so far.
    void draw_rest(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets);
    /// Adds what is drawn over everything else.
    void draw_over(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets);

    void evict_unused() { cache_.evict_unused(); }

  private:
    enum class Kind { nearest, ordered, over };
    void draw_items(const Frame& frame, const std::vector<LineItem>& items, Kind kind,
                    const GBuffer* next = nullptr);
    void add(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets, Kind kind,
             const GBuffer* next);
    void bind_surfaces(const gl::Program& program, const GBuffer* next) const;

    LineCache cache_;
    ProgramVariants programs_{"overlay_lines.vert", "overlay_lines.frag"};
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
    uint32_t overlay_id_ = 0;
    const gl::Texture *opaque_ = nullptr, *normal_ = nullptr;  ///< since begin()
    bool has_last_ = false;
    gl::Texture last_depth_, last_normal_;  ///< of the layer that was drawn last
};

}  // namespace easypbr::render
