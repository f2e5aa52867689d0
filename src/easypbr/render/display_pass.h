// Colours that are shown as they are, past light and tone curve: points without normals, tables of labels.
#pragma once

#include "easypbr/render/draw_list.h"
#include "easypbr/render/frame.h"
#include "easypbr/render/gbuffer.h"
#include "easypbr/render/programs.h"

namespace easypbr::render {

class DisplayPass {
  public:
    /// Clears the overlay and draws into it what the G-buffer holds of such kinds.
    void draw(const Frame& frame, const GBuffer& targets);

  private:
    ProgramVariants programs_{"screen_triangle.vert", "display_surface.frag"};
};

}  // namespace easypbr::render
