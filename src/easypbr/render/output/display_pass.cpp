#include "easypbr/render/output/display_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Of the factors that eye-dome lighting is made of.
constexpr gl::Format shade_format = gl::Format::r16;

/// Depth of an orthographic picture in doublings of the distance, as if it were seen from where a perspective
/// camera of 30 degrees sees the same height.
double doublings_per_depth(const Camera& camera) {
    const double distance = camera.ortho_height / (2 * std::tan(radians(15.0)));
    return (camera.far - camera.near) / (distance * std::log(2.0));
}

/// Of eye-dome lighting, in pixels.
float radius_of(const Frame& frame) {
    return std::max(1.0f, frame.resolved->settings.edl.radius * float(frame.picture_size.y()) / 1080);
}

void set_eye_dome_uniforms(ShaderInputs& to, const Frame& frame) {
    const EdlSettings& eye_dome = frame.resolved->settings.edl;
    to.set("u_size", Vec2(frame.size.cast<float>()));
    to.set("u_eye_dome", Vec2(eye_dome.strength, radius_of(frame)));
    to.set("u_depth_scale", Vec2(float(doublings_per_depth(frame.camera)), 0));
}

ShaderInputs overlay_inputs(const Frame& frame, const GBuffer& targets) {
    ShaderInputs values;
    values.define(camera_defines(frame));
    set_eye_dome_uniforms(values, frame);
    values.set("u_albedo", targets.albedo);
    values.set("u_material", targets.material);
    values.set("u_depth_target", targets.depth);
    if (!targets.ambient_occlusion) return values;
    values.define("AMBIENT_OCCLUSION");
    values.set("u_ambient_occlusion", targets.ambient_occlusion);
    return values;
}

ShaderInputs layer_inputs(const Frame& frame) {
    ShaderInputs values;
    values.define(camera_defines(frame));
    set_eye_dome_uniforms(values, frame);
    return values;
}

}  // namespace

int DisplayPass::reach(const Frame& whole) {
    // At the coarsest of its scales it looks four radii far.
    return int(std::ceil(4 * radius_of(whole)));
}

void DisplayPass::draw(const Frame& frame, const GBuffer& targets) {
    const float zero[4] = {0, 0, 0, 0};
    targets.display().clear_color(0, zero);
    targets.display().bind();
    gl::DrawState state = screen_state(frame.covered);
    state.depth_test = gl::DepthTest::less;
    surfaces_.draw(overlay_inputs(frame, targets), state);
}

void DisplayPass::shade_overlay(const Frame& frame, const GBuffer& targets, const PixelRect& area,
                                Transfers& transfers) {
    targets.overlay.write(area);
    // With zeros where nothing is shown.
    surfaces_.shade(
        overlay_inputs(frame, targets),
        {.target = &targets.overlay, .area = area, .where = native::Where::covered, .depth = &targets.depth},
        transfers);
}

const gl::Texture& DisplayPass::shade(const Frame& frame, const gl::Texture& nearest,
                                      const gl::Texture& opaque) {
    if (!shade_ || Vec2i(shade_.width(), shade_.height()) != frame.size) {
        shade_ = gl::Texture(shade_format, frame.size.x(), frame.size.y());
        shaded_ = gl::Framebuffer({&shade_});
    }
    shaded_.bind();
    ShaderInputs values = layer_inputs(frame);
    values.set("u_nearest", nearest);
    values.set("u_opaque", opaque);
    layers_.draw(values, {});
    return shade_;
}

const Target& DisplayPass::shade(const Frame& frame, const Target& nearest, const Target& opaque,
                                 Transfers& transfers) {
    if (host_shade_.size() != frame.size) host_shade_ = Target(shade_format, frame.size);
    host_shade_.write(nearest.area());
    ShaderInputs values = layer_inputs(frame);
    values.set("u_nearest", nearest);
    values.set("u_opaque", opaque);
    layers_.shade(
        values,
        {.target = &host_shade_, .area = nearest.area(), .where = native::Where::covered, .depth = &nearest},
        transfers);
    return host_shade_;
}

}  // namespace easypbr::render
