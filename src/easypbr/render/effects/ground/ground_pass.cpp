#include "easypbr/render/effects/ground/ground_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/render/raster/surface_writer.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// An orthographic view along the ground would see it without end.
constexpr double widest_radii = 30;
/// Orthographic views along the ground are from above, whatever roundings make of them.
constexpr double along = 1e-9;

struct Plane {
    Vec3d up;
    double offset;  ///< distance from the camera along `up`
};

Plane plane_of(const Camera& camera, const ResolvedSettings& resolved) {
    const Vec3d up = parse_up(resolved.settings.camera.up);
    return {up, resolved.settings.ground.height - up.dot(camera.position())};
}

Vec4 as_uniform(const Plane& plane) {
    const Vec3 up = plane.up.cast<float>();
    return {up.x(), up.y(), up.z(), float(plane.offset)};
}

/// Under the content, relative to the camera; w: where a plane has faded.
Vec4 middle_of(const Frame& frame, const Plane& plane, const Box3d& bounds) {
    Vec3d middle = bounds.center() - frame.camera.position();
    middle += plane.up * (plane.offset - plane.up.dot(middle));
    const Vec3 m = middle.cast<float>();
    return {m.x(), m.y(), m.z(), frame.resolved->settings.ground.radius};
}

}  // namespace

std::optional<MirroredGround> GroundPass::mirrored(const Frame& frame, const Box3d& bounds) {
    if (!is_seen(frame)) return std::nullopt;
    const ResolvedSettings& resolved = *frame.resolved;
    const auto& ground = resolved.settings.ground;
    const bool catches = is_shadow_catcher(resolved);
    const std::optional<Vec3> background = background_radiance(resolved);
    if (catches && !background) return std::nullopt;
    const Plane plane = plane_of(frame.camera, resolved);
    // Within the content a floor of its own hides the catcher.
    if (catches && bounds.contains(frame.camera.position())) return std::nullopt;
    const auto sky = [&](const Vec3d& normal) -> Vec3 {
        const Vec3 in_environment = resolved.R_env_world * normal.cast<float>();
        return resolved.settings.environment.intensity *
               resolved.environment.irradiance_over_pi(in_environment);
    };
    return MirroredGround{.plane = as_uniform(plane),
                          .color = catches ? *background : linear_from_srgb(ground.plane_color),
                          .sky = sky(plane.up),
                          .hidden = sky(-plane.up),
                          .lit = !catches,
                          .strength = ground.shadow_strength,
                          .roughness = ground.plane_roughness,
                          .middle = middle_of(frame, plane, bounds)};
}

bool GroundPass::is_on(const ResolvedSettings& resolved) {
    const auto& ground = resolved.settings.ground;
    // Without content there is no height.
    return ground.mode != GroundMode::none && std::isfinite(ground.height) && std::isfinite(ground.radius);
}

bool GroundPass::is_shadow_catcher(const ResolvedSettings& resolved) {
    return is_on(resolved) && resolved.settings.ground.mode == GroundMode::shadow;
}

bool GroundPass::is_seen(const Frame& frame) {
    const Plane plane = plane_of(frame.camera, *frame.resolved);
    if (!frame.orthographic()) return plane.offset < 0;
    const Vec3d forward = -frame.camera.T_world_cam.linear().col(2);
    return plane.up.dot(forward) < along;
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
    program.set("u_plane", as_uniform(plane));
    program.set("u_color", linear_from_srgb(ground.plane_color));
    program.set("u_roughness", ground.plane_roughness);
    program.set("u_kind", code_of(shadow_catcher ? SurfaceKind::ground_catcher : SurfaceKind::ground_plane));
    gl::draw_screen({.depth_test = gl::DepthTest::greater, .write_depth = true});
}

const Target& GroundPass::light_of(const Frame& frame, gl::Format format) {
    if (light_.size() != frame.size || light_.format() != format) light_ = Target(format, frame.size);
    return light_;
}

void GroundPass::begin_light(const Frame& frame, const GBuffer& targets) {
    light_framebuffer_.attach({&caught_light(frame).drawn()}, &targets.depth_test());
    const float zero[4] = {0, 0, 0, 0};
    light_framebuffer_.clear_color(0, zero);
}

const Target* GroundPass::caught(const ResolvedSettings& resolved) const {
    const bool is_seen_through = resolved.settings.background.mode == BackgroundMode::transparent;
    return is_seen_through && is_shadow_catcher(resolved) ? &light_ : nullptr;
}

void GroundPass::set_caught(ShaderInputs& values, const ResolvedSettings& resolved, const Target& caught) {
    const bool is_part = caught.format() == gl::Format::r32f;
    if (is_part) values.define("PART");
    values.set(is_part ? "u_part" : "u_light", caught);
    values.set("u_strength", resolved.settings.ground.shadow_strength);
}

ShaderInputs GroundPass::finish_inputs(const Frame& frame, const GBuffer& targets,
                                       const Box3d& bounds) const {
    const auto& ground = frame.resolved->settings.ground;
    ShaderInputs values;
    values.define(camera_defines(frame));
    set_camera_uniforms(values, frame);
    values.set("u_material", targets.material);
    if (ground.mode == GroundMode::shadow) {
        values.define("CATCHER");
        set_caught(values, *frame.resolved, light_);
        return values;
    }
    values.set("u_depth_target", targets.depth);
    values.set("u_middle", middle_of(frame, plane_of(frame.camera, *frame.resolved), bounds));
    return values;
}

void GroundPass::finish(const Frame& frame, const GBuffer& targets, const Box3d& bounds) {
    const gl::Blending multiply{.source = gl::Factor::zero, .target = gl::Factor::source_color};
    targets.lit().bind();
    finish_.draw(finish_inputs(frame, targets, bounds),
                 targets.covered_state(is_shadow_catcher(*frame.resolved) ? gl::replace : multiply));
}

void GroundPass::shade(const Frame& frame, const GBuffer& targets) {
    if (!is_seen(frame)) return;
    const auto& ground = frame.resolved->settings.ground;
    const Plane plane = plane_of(frame.camera, *frame.resolved);
    // Where the plane is in clip coordinates, the depth of its points follows from x and y.
    const Mat4d clip_from_world = frame.clip_from_view * frame.camera.view();
    const Eigen::Vector4d own(plane.up.x(), plane.up.y(), plane.up.z(), -ground.height);
    const Eigen::Vector4d p = clip_from_world.inverse().transpose() * own;
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const SurfaceKind kind =
        ground.mode == GroundMode::shadow ? SurfaceKind::ground_catcher : SurfaceKind::ground_plane;
    SurfaceFill fill(targets, {.albedo = linear_from_srgb(ground.plane_color),
                               .normal = plane.up.cast<float>(),
                               .roughness = ground.plane_roughness,
                               .kind = kind});
    parallel_chunks(size_t(frame.size.y()), 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            const double ndc_y = 1 - (double(y) + 0.5) * step_y;
            for (int x = 0; x < frame.size.x(); ++x) {
                const double ndc_x = (x + 0.5) * step_x - 1;
                const auto depth = float(-(p[0] * ndc_x + p[1] * ndc_y + p[3]) / p[2]);
                if (depth > 0 && depth <= 1) fill.put(x, int(y), depth);
            }
        }
    });
}

void GroundPass::shade_finish(const Frame& frame, const GBuffer& targets, const Box3d& bounds,
                              Transfers& transfers) {
    const bool catches = is_shadow_catcher(*frame.resolved);
    finish_.shade(finish_inputs(frame, targets, bounds),
                  {.target = &targets.radiance,
                   .area = frame.whole(),
                   .store = catches ? native::Store::replace : native::Store::multiply},
                  transfers);
    if (!caught(*frame.resolved)) light_.release();
}

}  // namespace easypbr::render
