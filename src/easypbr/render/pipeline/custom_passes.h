// A program's own passes in the frame.
#pragma once

#include <utility>
#include <vector>

#include "easypbr/render/frame/pass_timer.h"
#include "easypbr/render/output/output_pass.h"
#include "easypbr/render/pipeline/custom_pass.h"

namespace easypbr::render {

class CustomPasses {
  public:
    /// Each stage's in this order.
    void set(std::vector<CustomPass> passes) { passes_ = std::move(passes); }
    bool has(Stage stage) const;
    bool empty() const { return passes_.empty(); }

    /// Draws those of a stage into an image, each by a framebuffer of its own: it may leave that in any
    /// state.
    void draw(Stage stage, const Frame& frame, const GBuffer& targets, const gl::Texture& image,
              PassTimer& timer);
    /// Draws those of the stages light and overlay. What they draw may be anywhere in the picture.
    void draw_in_frame(const Frame& frame, const GBuffer& targets, PassTimer& timer, LitPicture& lit);

  private:
    std::vector<CustomPass> passes_;
    gl::Texture copies_[3];  ///< by stage, see PassInput::before()
};

inline bool has_custom(const CustomPasses* passes, Stage stage) {
    return passes && passes->has(stage);
}

}  // namespace easypbr::render
