#include "easypbr/render/primitives/surfels/surfel_splats.h"

#include <cmath>

#include "easypbr/render/primitives/surfels/surfel_projection.h"

namespace easypbr::render {
namespace {

void set_depth_uniform(const gl::Program& program, const Frame& frame) {
    program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
    program.set("u_size", Vec2(frame.size.cast<float>()));
}

std::vector<std::string> peel_defines(const Frame& frame, const SurfaceOutputs& outputs) {
    std::vector<std::string> defines = camera_defines(frame);
    if (outputs.peel) defines.emplace_back("PEEL");
    if (outputs.peel && outputs.peel->farthest) defines.emplace_back("FARTHEST");
    return defines;
}

}  // namespace

void SurfelSplats::sum(const Frame& frame, std::span<const DrawItem> items, const gl::Texture& limit,
                       const SurfaceOutputs& outputs) {
    make_targets(frame, outputs.ids);
    const bool farthest = outputs.peel && outputs.peel->farthest;
    limit.bind(0);
    const gl::Framebuffer& visibility = outputs.ids ? visibility_ids_ : visibility_;
    visibility.bind();
    visibility.clear_depth(farthest ? 1 : 0);
    for (const DrawItem& item : items) draw_item(frame, item, outputs, false);

    const float zero[4] = {0, 0, 0, 0};
    for (unsigned i = 0; i < 3; ++i) sums_.clear_color(i, zero);
    if (outputs.nearest_alone) {
        id_.bind(1);
        element_.bind(2);
    }
    sums_.bind();
    for (const DrawItem& item : items) draw_item(frame, item, outputs, true);
}

void SurfelSplats::make_targets(const Frame& frame, bool ids) {
    const int w = frame.size.x(), h = frame.size.y();
    if (!depth_ || depth_.width() != w || depth_.height() != h) {
        albedo_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        normal_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        material_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        depth_ = gl::Texture(gl::Format::depth32f, w, h);
        visibility_ = gl::Framebuffer({}, &depth_);
        sums_ = gl::Framebuffer({&albedo_sum_, &normal_sum_, &material_sum_}, &depth_);
        id_ = gl::Texture();
    }
    if (!ids || id_) return;
    id_ = gl::Texture(gl::Format::r32ui, w, h);
    element_ = gl::Texture(gl::Format::r32ui, w, h);
    visibility_ids_ = gl::Framebuffer({&id_, &element_}, &depth_);
}

void SurfelSplats::draw_item(const Frame& frame, const DrawItem& item, const SurfaceOutputs& outputs,
                             bool accumulate) {
    const SurfelBuffers& buffers = cache_.get(item.mesh());
    std::vector<std::string> defines = peel_defines(frame, outputs);
    if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
    if (item.alpha == AlphaMode::mask) defines.emplace_back("ALPHA_MASK");
    if (accumulate) defines.emplace_back("ACCUMULATE");
    if ((!accumulate || outputs.nearest_alone) && outputs.ids) defines.emplace_back("OBJECT_ID");
    if (outputs.nearest_alone) defines.emplace_back("ONE_SURFEL");
    const gl::Program& program = splats_.get(defines);
    program.use();
    set_depth_uniform(program, frame);
    const Eigen::Affine3d& T = item.object->T_world_mesh;
    const Mat3d inverse = T.linear().inverse();
    const Mat4d view_from_mesh = frame.camera.view() * T.matrix();
    const Vec3d eye = frame.orthographic() ? Vec3d(inverse * frame.camera.T_world_cam.linear().col(2))
                                           : Vec3d(inverse * (frame.camera.position() - T.translation()));
    const Material& m = item.material;
    program.set("u_clip_from_mesh", Mat4((frame.clip_from_view * view_from_mesh).cast<float>()));
    program.set("u_view_from_mesh", Mat4(view_from_mesh.cast<float>()));
    program.set("u_normal_from_mesh", Mat3(inverse.transpose().cast<float>()));
    program.set("u_base_color", Vec4(m.base_color.x(), m.base_color.y(), m.base_color.z(), m.opacity));
    program.set("u_alpha_cutoff", m.alpha_cutoff);
    program.set("u_eye", Vec3(eye.cast<float>()));
    const float band = outputs.nearest_alone ? 0 : float(T.linear().col(0).norm());
    program.set("u_surfel",
                Vec4(item.style.surfel_scale, float(spacing_of(item)), float(frame.camera.near), band));
    program.set("u_least_radius", native::least_ellipse_radius);
    program.set("u_pixel", float(2 / (frame.clip_from_view(1, 1) * frame.size.y())));
    program.set("u_material", Vec3(m.metallic, m.roughness, code_of(item.kind)));
    program.set("u_object_id", int(item.object - frame.scene->objects.data()) + 1);
    program.set("u_depth_target", 0);
    if (outputs.nearest_alone && accumulate) {
        program.set("u_id", 1);
        program.set("u_element", 2);
    }
    const bool farthest = outputs.peel && outputs.peel->farthest;
    gl::DrawState state{.depth_test = gl::DepthTest::greater, .write_depth = !accumulate};
    if (accumulate)
        state.depth_test = outputs.nearest_alone ? gl::DepthTest::off : gl::DepthTest::greater_equal;
    // Before the near plane all bands end alike.
    if (farthest) state.depth_test = gl::DepthTest::less_equal;
    if (accumulate) state.blending = gl::add;
    gl::draw_quads(state, buffers.array, int(item.mesh().V.rows()));
}

void SurfelSplats::write(const Frame& frame, const SurfaceOutputs& outputs, int owner) {
    std::vector<std::string> defines = camera_defines(frame);
    if (outputs.ids) defines.emplace_back("OBJECT_ID");
    if (outputs.peel) defines.emplace_back("PEEL");
    const gl::Program& program = quotients_.get(defines);
    program.use();
    set_depth_uniform(program, frame);
    program.set("u_owner", float(owner));
    const auto bind = [&](const gl::Texture& texture, const char* sampler, unsigned unit) {
        texture.bind(unit);
        program.set(sampler, int(unit));
    };
    bind(albedo_sum_, "u_albedo_sum", 0);
    bind(normal_sum_, "u_normal_sum", 1);
    bind(material_sum_, "u_material_sum", 2);
    if (outputs.peel) bind(depth_, "u_band", 3);
    if (outputs.ids) {
        bind(id_, "u_id", 3);
        bind(element_, "u_element", 4);
    }
    gl::draw_screen(geometry_state(outputs));
}

}  // namespace easypbr::render
