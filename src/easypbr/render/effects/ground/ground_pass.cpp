#include "easypbr/render/effects/ground/ground_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// An orthographic view along the ground would see it without end.
constexpr double widest_radii = 30;

struct Plane {
    Vec3d up;
    double offset;  ///< distance from the camera along `up`
};

Plane plane_of(const Camera& camera, const ResolvedSettings& resolved) {
    const Vec3d up = parse_up(resolved.settings.camera.up);
    return {up, resolved.settings.ground.height - up.dot(camera.position())};
}

}  // namespace

bool GroundPass::is_on(const ResolvedSettings& resolved) {
    const auto& ground = resolved.settings.ground;
    // Without content there is no height.
    return ground.mode != GroundMode::none && std::isfinite(ground.height) && std::isfinite(ground.radius);
}

bool GroundPass::is_shadow_catcher(const ResolvedSettings& resolved) {
    return is_on(resolved) && resolved.settings.ground.mode == GroundMode::shadow;
}

void GroundPass::widen_depth(Camera& camera, const ResolvedSettings& resolved, const Box3d& bounds) {
    if (camera.projection != Projection::orthographic || bounds.isEmpty()) return;
    const Plane plane = plane_of(camera, resolved);
    const Vec3d forward = -camera.T_world_cam.linear().col(2);
    const double falls = -plane.up.dot(forward),
                 rise = std::abs(plane.up.dot(camera.T_world_cam.linear().col(1)));
    const double reach = widest_radii * bounds.diagonal().norm() / 2;
    const double middle = forward.dot(bounds.center() - camera.position());
    if (falls <= 0) return;
    // Up and down the picture the ground's distance changes by rise / falls of the way.
    const double centre = -plane.offset / falls, spread = camera.ortho_height * rise / falls;
    camera.near = std::min(camera.near, std::max(centre - spread, middle - reach));
    camera.far = std::max(camera.far, std::min(centre + spread, middle + reach));
}

void GroundPass::draw(const Frame& frame, const GBuffer& targets) {
    const auto& ground = frame.resolved->settings.ground;
    const bool shadow_catcher = ground.mode == GroundMode::shadow;
    const Plane plane = plane_of(frame.camera, *frame.resolved);
    const gl::Program& program = surface_.get(camera_defines(frame));
    targets.surface_emission().bind();
    program.use();
    set_camera_uniforms(program, frame);
    const Vec3 up = plane.up.cast<float>();
    program.set("u_plane", Vec4(up.x(), up.y(), up.z(), float(plane.offset)));
    program.set("u_color", linear_from_srgb(ground.plane_color));
    program.set("u_roughness", ground.plane_roughness);
    program.set("u_kind", code_of(shadow_catcher ? SurfaceKind::ground_catcher : SurfaceKind::ground_plane));
    gl::draw_screen({.depth_test = gl::DepthTest::greater, .write_depth = true});
}

void GroundPass::begin_light(const Frame& frame, const GBuffer& targets) {
    if (!light_ || Vec2i(light_.width(), light_.height()) != frame.size) {
        light_ = gl::Texture(gl::Format::rgba32f, frame.size.x(), frame.size.y());
        depth_id_ = 0;
    }
    if (depth_id_ != targets.depth_test().id()) {
        light_framebuffer_ = gl::Framebuffer({&light_}, &targets.depth_test());
        depth_id_ = targets.depth_test().id();
    }
    const float zero[4] = {0, 0, 0, 0};
    light_framebuffer_.clear_color(0, zero);
}

void GroundPass::finish(const Frame& frame, const GBuffer& targets, const Box3d& bounds) {
    const auto& ground = frame.resolved->settings.ground;
    const bool shadow_catcher = ground.mode == GroundMode::shadow;
    std::vector<std::string> defines = camera_defines(frame);
    if (shadow_catcher) defines.emplace_back("CATCHER");
    const gl::Program& program = finish_.get(defines);
    targets.lit().bind();
    program.use();
    set_camera_uniforms(program, frame);
    program.set("u_material", 0);
    targets.material.bind(0);
    if (shadow_catcher) {
        program.set("u_light", 1);
        light_.bind(1);
        program.set("u_strength", ground.shadow_strength);
    } else {
        program.set("u_depth_target", 1);
        targets.depth.bind(1);
        const Plane plane = plane_of(frame.camera, *frame.resolved);
        Vec3d middle = bounds.center() - frame.camera.position();
        middle += plane.up * (plane.offset - plane.up.dot(middle));
        const Vec3 m = middle.cast<float>();
        program.set("u_middle", Vec4(m.x(), m.y(), m.z(), ground.radius));
    }
    const gl::Blending multiply{.source = gl::Factor::zero, .target = gl::Factor::source_color};
    gl::draw_screen(targets.covered_state(shadow_catcher ? gl::replace : multiply));
}

}  // namespace easypbr::render
