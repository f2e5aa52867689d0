// Of Session: pictures of cameras whose lenses warp them.
#include <memory>
#include <utility>

#include "easypbr/app/prepared.h"
#include "easypbr/app/session.h"

namespace easypbr::app {

void Session::apply_lens(Drawn& drawn, Prepared& prepared, bool picture) {
    drawn.finish_.lens = lenses_.get(drawn.camera_, prepared.options.size);
    if (auto& motion = prepared.options.motion;
        motion && (drawn.camera_.is_warped() || motion->camera.is_warped())) {
        auto as_drawn = std::make_shared<Motion>(*motion);
        as_drawn->camera = drawn_before(motion->camera, drawn.camera_, drawn.lens());
        motion = std::move(as_drawn);
    }
    if (drawn.camera_.is_warped()) {
        prepared.options.exact_pixels = picture;
        if (picture && !prepared.options.layers) put_image_behind(drawn, prepared);
        prepared.options.size = drawn.lens().drawn_size;
        prepared.resolved.camera.distortion.reset();
        prepared.resolved.camera.intrinsics = drawn.lens().drawn.intrinsics;
    }
}

void Session::put_image_behind(Drawn& drawn, Prepared& prepared) {
    const BackgroundSettings& background = prepared.resolved.settings.background;
    if (background.mode != BackgroundMode::image || !prepared.images.background) return;
    render::DrawOptions& options = prepared.options;
    drawn.finish_.backdrop =
        backdrops_.get(background, prepared.images.background, options.size, options.encoding);
    options.without_image = true;
    // Alpha of 8 bits is too coarse for what is mixed in linear light: near black a step is 13 codes.
    if (options.encoding == Encoding::srgb8) options.encoding = Encoding::srgb16;
}

void Session::keep_exact(Drawn& drawn, const Image& exact) {
    if (!exact.empty()) drawn.finish_.exact = std::make_shared<const Image>(exact);
}

}  // namespace easypbr::app
