#include "easypbr/render/effects/ambient_occlusion/ambient_occlusion_pass.h"

#include <algorithm>
#include <cmath>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// From this many frames on their mean shows what half the resolution would lose, and from as many more on it
/// is smooth without a blur.
constexpr int frames_at_full_resolution = 8, frames_without_blur = 48;

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
    ProgramVariants& programs;
    std::vector<std::string> defines;
    const gl::Framebuffer& to;
    PixelRect area;  ///< of `to`
    const gl::Texture* visibility = nullptr;
    Vec2 axis{0, 0};       ///< of a blur
    bool selects = false;  ///< writes the depth that the steps after it are tested by
};

void AmbientOcclusionPass::make_targets(Vec2i size, bool half) {
    if (depth_ && size_ == size && half_ == half) return;
    size_ = size;
    half_ = half;
    const int w = half ? (size.x() + 1) / 2 : size.x(), h = half ? (size.y() + 1) / 2 : size.y();
    depth_ = gl::Texture(gl::Format::depth32f, w, h);
    sampled_ = gl::Texture(gl::Format::r16, w, h);
    blurred_ = gl::Texture(gl::Format::r16, w, h);
    surface_ = half ? gl::Texture(gl::Format::rgba32f, w, h) : gl::Texture();
    select_ = half ? gl::Framebuffer({&surface_}, &depth_) : gl::Framebuffer();
    sample_ = gl::Framebuffer({&sampled_}, &depth_);
    blur_ = gl::Framebuffer({&blurred_}, &depth_);
}

void AmbientOcclusionPass::draw(const Frame& frame, GBuffer& targets, bool with_points) {
    const bool half = at_half_resolution(frame), smooth = half || frame.sample_count < frames_without_blur;
    ProgramVariants& sampling =
        frame.resolved->settings.ssao.method == OcclusionMethod::horizon ? horizon_ : hemisphere_;
    std::vector<std::string> defines = camera_defines(frame);
    if (half) defines.emplace_back("HALF");
    if (smooth) defines.emplace_back("BLURRED");

    targets.add_ambient_occlusion();
    const float open[4] = {1, 1, 1, 1};
    targets.occluded().clear_color(0, open);
    estimated_ = with_points;
    if (estimated_) estimate_normals(frame, targets);
    const PixelRect area = in_texels(frame.covered, half ? 2 : 1);
    if (!smooth) return run(frame, targets, {sampling, defines, targets.occluded(), area});
    make_targets(frame.size, half);
    if (half) {
        select_.clear_depth(0);
        run(frame, targets,
            {.programs = selecting_, .defines = defines, .to = select_, .area = area, .selects = true});
    } else {
        gl::copy(targets.depth_test(), depth_);
    }
    run(frame, targets, {sampling, defines, sample_, area});
    run(frame, targets, {blurring_, defines, blur_, area, &sampled_, {1, 0}});
    run(frame, targets, {blurring_, defines, half ? sample_ : targets.occluded(), area, &blurred_, {0, 1}});
    if (half) run(frame, targets, {magnifying_, defines, targets.occluded(), frame.covered, &sampled_});
}

void AmbientOcclusionPass::estimate_normals(const Frame& frame, const GBuffer& targets) {
    if (!normal_ || normal_.width() != frame.size.x() || normal_.height() != frame.size.y())
        normal_ = gl::Texture(gl::Format::rg16, frame.size.x(), frame.size.y());
    gl::copy(targets.normal.texture(), normal_);
    estimate_ = gl::Framebuffer({&normal_}, &targets.depth_test());
    run(frame, targets, {estimating_, camera_defines(frame), estimate_, frame.covered});
}

double AmbientOcclusionPass::reach(const Frame& whole, const Box3d& bounds) {
    const auto& ssao = whole.resolved->settings.ssao;
    if (!ssao.enabled || bounds.isEmpty()) return 0;
    const double depth = whole.orthographic() ? 1 : nearest_depth(bounds, whole.camera);
    return std::ceil(ssao.radius * whole.clip_from_view(1, 1) * whole.picture_size.y() / 2 / depth);
}

void AmbientOcclusionPass::run(const Frame& frame, const GBuffer& targets, const Step& step) {
    const auto& ssao = frame.resolved->settings.ssao;
    const gl::Program& program = step.programs.get(step.defines);
    step.to.bind();
    program.use();
    set_camera_uniforms(program, frame);
    program.set("u_radius", ssao.radius);
    program.set("u_inverse_falloff", 1 / ssao.falloff);
    program.set("u_power", ssao.power);
    program.set("u_directions", ssao.directions);
    program.set("u_steps", ssao.steps);
    program.set("u_frame", frame.sample_index);
    program.set("u_axis", step.axis);
    program.set("u_depth_target", 0);
    targets.depth.bind(0);
    program.set("u_normal", 1);
    (estimated_ ? normal_ : targets.normal.texture()).bind(1);
    program.set("u_material", 4);
    targets.material.bind(4);
    program.set("u_surface", 2);
    if (surface_) {
        surface_.bind(2);
        program.set("u_surface_size", Vec2(float(surface_.width()), float(surface_.height())));
    }
    program.set("u_visibility", 3);
    if (step.visibility) step.visibility->bind(3);
    gl::DrawState state = screen_state(step.area);
    state.depth_test = step.selects ? gl::DepthTest::always : gl::DepthTest::less;
    state.write_depth = step.selects;
    gl::draw_screen(state);
}

}  // namespace easypbr::render
