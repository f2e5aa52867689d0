#include "easypbr/render/effects/depth_of_field/depth_of_field_effect.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Of the circles' radii, as a part of the picture's height.
constexpr double largest_part = 1.0 / 16;

/// Radius in pixels of the circle of what is infinitely far, and what reversed depth takes from it: a point
/// at depth z moves by lens / focus - lens / z where the eye moves across the lens.
Vec2d confusion_of(const Frame& frame) {
    const double scale = frame.resolved->lens_radius * frame.clip_from_view(1, 1) * frame.size.y() / 2;
    return {scale / frame.resolved->settings.depth_of_field.focus_distance, scale / frame.camera.near};
}

/// Largest radius of a circle of confusion that a single frame draws, in pixels.
double largest_confusion(const Frame& frame, const Box3d& bounds) {
    const Vec2d focus = confusion_of(frame);
    double largest = std::abs(focus.x());  // Of the background, too.
    for (int i = 0; i < 8 && !bounds.isEmpty(); ++i) {
        const Vec3d corner = bounds.corner(Box3d::CornerType(i)) - frame.camera.position();
        const double z = std::max(-frame.camera.T_world_cam.linear().col(2).dot(corner), frame.camera.near);
        largest = std::max(largest, std::abs(focus.x() - focus.y() * frame.camera.near / z));
    }
    return std::min(largest, largest_part * frame.picture_size.y());
}

template <class Picture>
void bind(const gl::Program& program, const char* sampler, unsigned unit, const Picture& texture) {
    program.set(sampler, int(unit));
    texture.bind(unit);
}

}  // namespace

void DepthOfFieldEffect::make_targets(Vec2i size) {
    if (radiance_.size() == size) return;
    const int w = (size.x() + 1) / 2, h = (size.y() + 1) / 2;
    radiance_ = Target(gl::Format::rgba32f, size);
    light_ = gl::Texture(gl::Format::rgba16f, w, h);
    confusion_ = gl::Texture(gl::Format::r32f, w, h);
    behind_ = gl::Texture(gl::Format::rgba16f, w, h);
    before_ = gl::Texture(gl::Format::rgba16f, w, h);
    hidden_ = gl::Texture(gl::Format::r16f, w, h);
    for (gl::Texture* texture : {&behind_, &before_, &hidden_}) texture->sampling(gl::Filtering::linear);
    halved_ = gl::Framebuffer({&light_, &confusion_});
    gathered_ = gl::Framebuffer({&behind_, &before_, &hidden_});
    composed_ = gl::Framebuffer({&radiance_.drawn()});
}

bool DepthOfFieldEffect::is_on(const Shot& shot) const {
    return shot.resolved->lens_radius > 0 && !shot.through_lens;
}

int DepthOfFieldEffect::reach(const Frame& whole, const Box3d& bounds) const {
    if (!(whole.resolved->lens_radius > 0)) return 0;
    // A little more for the filters of half resolution.
    return int(std::ceil(largest_confusion(whole, bounds))) + 4;
}

void DepthOfFieldEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const Frame& frame = inputs.frame;
    const GBuffer& targets = inputs.targets;
    make_targets(frame.size);
    const Vec2 size = frame.size.cast<float>(), focus = confusion_of(frame).cast<float>();
    const Vec2 half(float(light_.width()), float(light_.height()));

    const gl::Program& halve = halve_.get({});
    halved_.bind();
    halve.use();
    halve.set("u_size", size);
    halve.set("u_focus", focus);
    bind(halve, "u_radiance", 0, targets.radiance);
    bind(halve, "u_depth_target", 1, targets.depth);
    gl::draw_screen({});

    const gl::Program& gather = gather_.get({});
    gathered_.bind();
    gather.use();
    gather.set("u_half_size", half);
    gather.set("u_reach", float(largest_confusion(frame, inputs.bounds) / 2));
    bind(gather, "u_light", 0, light_);
    bind(gather, "u_confusion", 1, confusion_);
    gl::draw_screen({});

    const gl::Program& compose = compose_.get({});
    composed_.bind();
    compose.use();
    compose.set("u_size", size);
    compose.set("u_covered_size", Vec2(2 * half));
    compose.set("u_focus", focus);
    bind(compose, "u_radiance", 0, targets.radiance);
    bind(compose, "u_depth_target", 1, targets.depth);
    bind(compose, "u_behind", 2, behind_);
    bind(compose, "u_before", 3, before_);
    bind(compose, "u_hidden", 4, hidden_);
    gl::draw_screen({});
    lit.radiance = &radiance_;
    lit.partly_covered = lit.spreads = true;
}

}  // namespace easypbr::render
