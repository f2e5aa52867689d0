// Lines into the overlay: unlit, wide in pixels, smooth, hidden by surfaces and by nearer lines.
#pragma once

#include "easypbr/gpu/line_buffers.h"
#include "easypbr/render/draw_list.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/programs.h"

namespace easypbr::render {

class LinePass {
  public:
    /// Adds the lines to the overlay, in two passes: the first finds the nearest line of each pixel.
    void draw(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets);

    void evict_unused() { cache_.evict_unused(); }

  private:
    void draw_items(const Frame& frame, const std::vector<LineItem>& items, bool depth_only);

    gpu::LineCache cache_;
    ProgramVariants programs_{"overlay_lines.vert", "overlay_lines.frag"};
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
    uint32_t overlay_id_ = 0;
};

}  // namespace easypbr::render
