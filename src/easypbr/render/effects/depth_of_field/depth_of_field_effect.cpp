#include "easypbr/render/effects/depth_of_field/depth_of_field_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/render/frame/half_light.h"
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

/// Where focus_gather.frag looks: x, y, their distance, and the area that each place stands for.
void set_taps(ShaderInputs& values, double reach) {
    constexpr int taps = 72;
    const double golden_angle = pi * (3 - std::sqrt(5.0)), widest = reach + 0.5;
    for (int k = 0; k < taps; ++k) {
        const double u = (k + 0.5) / taps, distance = widest * std::pow(u, 0.75), angle = k * golden_angle;
        const double area = 1.5 * pi * widest * widest * std::sqrt(u) / taps;
        const Eigen::Vector4d tap(distance * std::cos(angle), distance * std::sin(angle), distance, area);
        values.set(fmt::format("u_taps[{}]", k), Vec4(tap.cast<float>()));
    }
}

}  // namespace

void DepthOfFieldEffect::make_targets(Vec2i size) {
    if (radiance_.size() == size) return;
    const Vec2i half((size.x() + 1) / 2, (size.y() + 1) / 2);
    radiance_ = Target(gl::Format::rgba32f, size);
    light_ = Target(gl::Format::rgba16f, half);
    behind_ = Target(gl::Format::rgba16f, half);
    before_ = Target(gl::Format::rgba16f, half);
    confusion_ = Target(gl::Format::r32f, half);
    hidden_ = Target(gl::Format::r16f, half);
    weight_ = Target(gl::Format::r16f, half);
    halved_ = gl::Framebuffer();
}

void DepthOfFieldEffect::make_framebuffers() {
    for (const Target* target : {&light_, &confusion_, &weight_, &behind_, &before_, &hidden_, &radiance_})
        target->drawn();
    if (halved_) return;
    for (const Target* target : {&behind_, &before_, &hidden_, &weight_})
        target->attachment().sampling(gl::Filtering::linear);
    halved_ = gl::Framebuffer({&light_.attachment(), &confusion_.attachment(), &weight_.attachment()});
    gathered_ = gl::Framebuffer({&behind_.attachment(), &before_.attachment(), &hidden_.attachment()});
    composed_ = gl::Framebuffer({&radiance_.attachment()});
}

bool DepthOfFieldEffect::is_on(const Shot& shot) const {
    return shot.resolved->lens_radius > 0 && !shot.through_lens;
}

int DepthOfFieldEffect::reach(const Frame& whole, const Box3d& bounds) const {
    if (!(whole.resolved->lens_radius > 0)) return 0;
    // A little more for the filters of half resolution.
    return int(std::ceil(largest_confusion(whole, bounds))) + 4;
}

ShaderInputs DepthOfFieldEffect::halve_inputs(const EffectInputs& inputs, bool overlay) const {
    ShaderInputs values;
    if (overlay) {
        values.define("OVERLAY");
        values.set("u_material", inputs.targets.material);
    }
    values.set("u_size", Vec2(inputs.frame.size.cast<float>()));
    values.set("u_light_scale", half_light_scale(inputs.frame.resolved->exposure));
    values.set("u_focus", Vec2(confusion_of(inputs.frame).cast<float>()));
    values.set("u_radiance", inputs.targets.radiance);
    values.set("u_depth_target", inputs.targets.depth);
    return values;
}

ShaderInputs DepthOfFieldEffect::gather_inputs(const EffectInputs& inputs, bool overlay) const {
    const double reach = largest_confusion(inputs.frame, inputs.bounds) / 2;
    ShaderInputs values;
    if (overlay) values.define("OVERLAY");
    values.set("u_half_size", Vec2(light_.size().cast<float>()));
    values.set("u_reach", float(reach));
    set_taps(values, reach);
    values.set("u_half_light", light_);
    values.set("u_confusion", confusion_);
    values.set("u_weight", weight_);
    return values;
}

ShaderInputs DepthOfFieldEffect::compose_inputs(const EffectInputs& inputs, bool overlay) const {
    ShaderInputs values = halve_inputs(inputs, overlay);
    values.set("u_covered_size", Vec2(2 * light_.size().cast<float>()));
    values.set("u_behind", behind_);
    values.set("u_before", before_);
    values.set("u_hidden", hidden_);
    values.set("u_weight", weight_);
    return values;
}

void DepthOfFieldEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const bool overlay = lit.overlay != nullptr;
    make_targets(inputs.frame.size);
    make_framebuffers();
    halved_.bind();
    halve_.draw(halve_inputs(inputs, overlay), {});
    gathered_.bind();
    gather_.draw(gather_inputs(inputs, overlay), {});
    composed_.bind();
    compose_.draw(compose_inputs(inputs, overlay), {});
    finish(lit);
}

void DepthOfFieldEffect::shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) {
    const bool overlay = lit.overlay != nullptr;
    make_targets(inputs.frame.size);
    for (const Target* target : {&light_, &confusion_, &weight_, &behind_, &before_, &hidden_, &radiance_})
        target->write(target->whole());
    const PixelRect half = light_.whole();
    halve_.shade(halve_inputs(inputs, overlay),
                 {.target = &light_, .area = half, .further = {&confusion_, &weight_}}, transfers);
    gather_.shade(gather_inputs(inputs, overlay),
                  {.target = &behind_, .area = half, .further = {&before_, &hidden_}}, transfers);
    compose_.shade(compose_inputs(inputs, overlay), {.target = &radiance_, .area = radiance_.whole()},
                   transfers);
    finish(lit);
}

void DepthOfFieldEffect::finish(LitPicture& lit) const {
    lit.radiance = &radiance_;
    lit.partly_covered = lit.spreads = true;
}

}  // namespace easypbr::render
