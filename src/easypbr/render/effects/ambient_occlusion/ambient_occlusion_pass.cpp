#include "easypbr/render/effects/ambient_occlusion/ambient_occlusion_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// From this many frames on each takes one of the four pixels, and their mean is as smooth as a blurred
/// frame.
constexpr int frames_that_take_turns = 4;
/// From this many on their mean is smooth at full resolution, too.
constexpr int frames_at_full_resolution = 48;

bool at_half_resolution(const Frame& frame) {
    const OcclusionResolution resolution = frame.resolved->settings.ssao.resolution;
    return resolution == OcclusionResolution::half ||
           (resolution == OcclusionResolution::adaptive && frame.sample_count < frames_at_full_resolution);
}

/// The rectangle in texels of `scale` pixels a side.
PixelRect in_texels(const PixelRect& r, int scale) {
    const int x1 = (r.x + r.width + scale - 1) / scale, y1 = (r.y + r.height + scale - 1) / scale;
    return {r.x / scale, r.y / scale, x1 - r.x / scale, y1 - r.y / scale};
}

/// Depth of the nearest content, but no nearer than a hundredth of its size.
double nearest_depth(const Box3d& bounds, const Camera& camera) {
    double nearest = 1e300;
    for (int i = 0; i < 8; ++i) {
        const Vec3d corner = bounds.corner(Box3d::CornerType(i)) - camera.position();
        nearest = std::min(nearest, -camera.T_world_cam.linear().col(2).dot(corner));
    }
    return std::max(nearest, bounds.diagonal().norm() / 100);
}

}  // namespace

/// One full-screen draw: what with, where to, and its inputs beside those that all have.
struct AmbientOcclusionPass::Step {
    ScreenShader& shader;
    std::vector<std::string> defines;
    const gl::Framebuffer& to;
    PixelRect area;  ///< of `to`
    const Target* visibility = nullptr;
    Vec2 axis{0, 0};       ///< of a blur
    bool selects = false;  ///< writes the depth that the steps after it are tested by
};

void AmbientOcclusionPass::make_targets(Vec2i size, bool half) {
    if (sampled_ && size_ == size && half_ == half) return;
    size_ = size;
    half_ = half;
    const Vec2i own = half ? Vec2i((size.x() + 1) / 2, (size.y() + 1) / 2) : size;
    sampled_ = Target(gl::Format::r16, own);
    blurred_ = Target(gl::Format::r16, own);
    surface_ = half ? Target(gl::Format::rgba32f, own) : Target();
    depth_ = gl::Texture();
}

void AmbientOcclusionPass::make_framebuffers() {
    for (const Target* target : {&sampled_, &blurred_, &surface_}) target->drawn();
    if (depth_) return;
    depth_ = gl::Texture(gl::Format::depth32f, sampled_.width(), sampled_.height());
    select_ = half_ ? gl::Framebuffer({&surface_.attachment()}, &depth_) : gl::Framebuffer();
    sample_ = gl::Framebuffer({&sampled_.attachment()}, &depth_);
    blur_ = gl::Framebuffer({&blurred_.attachment()}, &depth_);
}

std::vector<std::string> AmbientOcclusionPass::defines_of(const Frame& frame, const Surfaces& surfaces) {
    std::vector<std::string> defines = camera_defines(frame);
    if (surfaces.mapped_normals) defines.emplace_back("MAPPED_NORMALS");
    if (!surfaces.occluders.isEmpty()) defines.emplace_back("BOUNDED");
    return defines;
}

AmbientOcclusionPass::Plan AmbientOcclusionPass::plan_of(const Frame& frame, const Surfaces& surfaces) {
    const OcclusionMethod method = frame.resolved->settings.ssao.method;
    Plan plan;
    plan.half = at_half_resolution(frame);
    plan.takes_turns = plan.half && frame.sample_count >= frames_that_take_turns;
    plan.blurred = !plan.takes_turns && (plan.half || frame.sample_count < frames_at_full_resolution);
    plan.sampling = method == OcclusionMethod::horizon ? &horizon_ : &hemisphere_;
    plan.defines = defines_of(frame, surfaces);
    if (plan.half) plan.defines.emplace_back("HALF");
    if (plan.takes_turns) plan.defines.emplace_back("TAKES_TURNS");
    if (plan.blurred) plan.defines.emplace_back("BLURRED");
    return plan;
}

void AmbientOcclusionPass::draw(const Frame& frame, GBuffer& targets, const Surfaces& surfaces) {
    const Plan plan = plan_of(frame, surfaces);
    targets.add_ambient_occlusion();
    const float open[4] = {1, 1, 1, 1};
    targets.occluded().clear_color(0, open);
    occluders_ = surfaces.occluders;
    estimated_ = false;
    if (surfaces.needs_normals()) estimate_normals(frame, targets, surfaces);
    estimated_ = surfaces.needs_normals();
    const PixelRect area = in_texels(frame.covered, plan.half ? 2 : 1);
    if (!plan.half && !plan.blurred)
        return run(frame, targets, {*plan.sampling, plan.defines, targets.occluded(), area});
    make_targets(frame.size, plan.half);
    make_framebuffers();
    if (plan.half) {
        select_.clear_depth(0);
        run(frame, targets,
            {.shader = selecting_, .defines = plan.defines, .to = select_, .area = area, .selects = true});
    } else {
        gl::copy(targets.depth_test(), depth_);
    }
    run(frame, targets, {*plan.sampling, plan.defines, sample_, area});
    if (plan.blurred) {
        const gl::Framebuffer& to = plan.half ? sample_ : targets.occluded();
        run(frame, targets, {blurring_, plan.defines, blur_, area, &sampled_, {1, 0}});
        run(frame, targets, {blurring_, plan.defines, to, area, &blurred_, {0, 1}});
    }
    if (plan.half)
        run(frame, targets, {magnifying_, plan.defines, targets.occluded(), frame.covered, &sampled_});
}

void AmbientOcclusionPass::shade(const Frame& frame, GBuffer& targets, const Surfaces& surfaces,
                                 Transfers& transfers) {
    const Plan plan = plan_of(frame, surfaces);
    targets.add_ambient_occlusion();
    occluders_ = surfaces.occluders;
    estimated_ = false;
    const PixelRect held = targets.depth.area(), area = in_texels(held, plan.half ? 2 : 1);
    if (plan.half || plan.blurred) make_targets(frame.size, plan.half);
    const auto shade_to = [&](ScreenShader& shader, const Target& to, const PixelRect& pixels,
                              const Target* visibility = nullptr, Vec2 axis = {0, 0}) {
        to.write(pixels);
        const bool of_half = plan.half && &to != &targets.ambient_occlusion && &to != &surface_;
        const ShaderInputs inputs = inputs_of(frame, targets, plan.defines, visibility, axis);
        shader.shade(inputs,
                     {.target = &to,
                      .area = pixels,
                      .where = &to == &surface_ ? native::Where::everywhere : native::Where::covered,
                      .depth = of_half ? &surface_ : &targets.depth},
                     transfers);
    };
    if (surfaces.needs_normals()) {
        make_normals(frame.size);
        normal_.write(held);
        estimating_.shade(
            surface_inputs(frame, targets, defines_of(frame, surfaces)),
            {.target = &normal_, .area = held, .where = native::Where::covered, .depth = &targets.depth},
            transfers);
        estimated_ = true;
    }
    if (!plan.half && !plan.blurred) return shade_to(*plan.sampling, targets.ambient_occlusion, held);
    if (plan.half) shade_to(selecting_, surface_, area);
    shade_to(*plan.sampling, sampled_, area);
    if (plan.blurred) {
        shade_to(blurring_, blurred_, area, &sampled_, {1, 0});
        shade_to(blurring_, plan.half ? sampled_ : targets.ambient_occlusion, area, &blurred_, {0, 1});
    }
    if (plan.half) shade_to(magnifying_, targets.ambient_occlusion, held, &sampled_);
}

void AmbientOcclusionPass::make_normals(Vec2i size) {
    if (normal_.size() == size) return;
    normal_ = Target(gl::Format::rg16, size);
    estimate_ = gl::Framebuffer();
}

void AmbientOcclusionPass::estimate_normals(const Frame& frame, const GBuffer& targets,
                                            const Surfaces& surfaces) {
    make_normals(frame.size);
    estimate_ = gl::Framebuffer({&normal_.drawn()}, &targets.depth_test());
    run(frame, targets, {estimating_, defines_of(frame, surfaces), estimate_, frame.covered});
}

double AmbientOcclusionPass::reach(const Frame& whole, const Box3d& bounds) {
    const auto& ssao = whole.resolved->settings.ssao;
    if (!ssao.enabled || bounds.isEmpty()) return 0;
    const double depth = whole.orthographic() ? 1 : nearest_depth(bounds, whole.camera);
    return std::ceil(ssao.radius * whole.clip_from_view(1, 1) * whole.picture_size.y() / 2 / depth);
}

ShaderInputs AmbientOcclusionPass::surface_inputs(const Frame& frame, const GBuffer& targets,
                                                  const std::vector<std::string>& defines) const {
    ShaderInputs values;
    values.define(defines);
    set_camera_uniforms(values, frame);
    values.set("u_radius", frame.resolved->settings.ssao.radius);
    values.set("u_depth_target", targets.depth);
    values.set("u_normal", estimated_ ? normal_ : targets.normal);
    values.set("u_material", targets.material);
    if (!occluders_.isEmpty()) {
        const Vec3d center = occluders_.center() - frame.camera.position(), half = occluders_.sizes() / 2;
        values.set("u_occluders_center", Vec3(center.cast<float>()));
        values.set("u_occluders_half", Vec3(half.cast<float>()));
    }
    return values;
}

ShaderInputs AmbientOcclusionPass::inputs_of(const Frame& frame, const GBuffer& targets,
                                             const std::vector<std::string>& defines,
                                             const Target* visibility, Vec2 axis) const {
    const auto& ssao = frame.resolved->settings.ssao;
    ShaderInputs values = surface_inputs(frame, targets, defines);
    values.set("u_inverse_falloff", 1 / ssao.falloff);
    values.set("u_power", ssao.power);
    values.set("u_directions", ssao.directions);
    values.set("u_steps", ssao.steps);
    values.set("u_frame", frame.sample_index);
    values.set("u_axis", axis);
    if (half_ && surface_) {
        values.set("u_surface", surface_);
        values.set("u_surface_size", Vec2(surface_.size().cast<float>()));
    }
    if (visibility) values.set("u_visibility", *visibility);
    return values;
}

void AmbientOcclusionPass::run(const Frame& frame, const GBuffer& targets, const Step& step) {
    const ShaderInputs inputs = inputs_of(frame, targets, step.defines, step.visibility, step.axis);
    step.to.bind();
    gl::DrawState state = screen_state(step.area);
    state.depth_test = step.selects ? gl::DepthTest::always : gl::DepthTest::less;
    state.write_depth = step.selects;
    step.shader.draw(inputs, state);
}

}  // namespace easypbr::render
