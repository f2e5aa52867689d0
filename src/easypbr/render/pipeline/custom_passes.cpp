#include "easypbr/render/pipeline/custom_passes.h"

#include <algorithm>

namespace easypbr::render {

bool CustomPasses::has(Stage stage) const {
    return std::ranges::any_of(passes_, [&](const CustomPass& pass) { return pass.stage == stage; });
}

void CustomPasses::draw(Stage stage, const Frame& frame, const GBuffer& targets, const gl::Texture& image,
                        PassTimer& timer) {
    for (const CustomPass& pass : passes_) {
        if (pass.stage != stage) continue;
        const gl::Framebuffer target({&image});
        const PassInput input(frame, targets, image, target, copies_[size_t(stage)]);
        timer.run(pass.name, [&] { draw_custom(pass, input); });
    }
}

void CustomPasses::draw_in_frame(const Frame& frame, const GBuffer& targets, PassTimer& timer,
                                 LitPicture& lit) {
    if (!has(Stage::light) && !has(Stage::overlay)) return;
    lit.covered = frame.whole();
    lit.partly_covered = lit.spreads = true;
    const Frame whole = frame.covering(lit.covered);
    draw(Stage::light, whole, targets, targets.radiance.drawn(), timer);
    draw(Stage::overlay, whole, targets, targets.overlay.drawn(), timer);
}

}  // namespace easypbr::render
