#include "easypbr/render/surfel_pass.h"

#include <epoxy/gl.h>

#include <cmath>
#include <span>

namespace easypbr::render {
namespace {

void set_depth_uniform(const gl::Program& program, const Frame& frame) {
    program.set("u_depth", Vec3(float(frame.camera.near), float(frame.camera.far), 0));
    program.set("u_size", Vec2(frame.size.cast<float>()));
}

}  // namespace

void SurfelPass::draw(const Frame& frame, const std::vector<DrawItem>& items, const GBuffer& targets,
                      bool native) {
    if (items.empty()) return;
    if (native) return draw_natively(frame, items, targets);
    make_targets(frame);
    targets.depth.bind(0);
    const gl::Framebuffer& visibility = frame.with_ids ? visibility_ids_ : visibility_;
    visibility.bind();
    visibility.allow_depth_writes();
    visibility.clear_depth(0);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    draw_items(frame, items, false);

    const float zero[4] = {0, 0, 0, 0};
    for (unsigned i = 0; i < 3; ++i) sums_.clear_color(i, zero);
    sums_.bind();
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GEQUAL);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    draw_items(frame, items, true);
    glDisable(GL_BLEND);
    normalise(frame, targets);
}

void SurfelPass::make_targets(const Frame& frame) {
    const int w = frame.size.x(), h = frame.size.y();
    if (!no_attributes_) no_attributes_ = gl::VertexArray::make();
    if (!depth_ || depth_.width() != w || depth_.height() != h) {
        albedo_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        normal_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        material_sum_ = gl::Texture(gl::Format::rgba32f, w, h);
        depth_ = gl::Texture(gl::Format::depth32f, w, h);
        visibility_ = gl::Framebuffer({}, &depth_);
        sums_ = gl::Framebuffer({&albedo_sum_, &normal_sum_, &material_sum_}, &depth_);
        id_ = gl::Texture();
    }
    if (!frame.with_ids || id_) return;
    id_ = gl::Texture(gl::Format::r32ui, w, h);
    element_ = gl::Texture(gl::Format::r32ui, w, h);
    visibility_ids_ = gl::Framebuffer({&id_, &element_}, &depth_);
}

void SurfelPass::draw_items(const Frame& frame, const std::vector<DrawItem>& items, bool accumulate) {
    for (const DrawItem& item : items) {
        const gpu::SurfelBuffers& buffers = cache_.get(item.mesh());
        std::vector<std::string> defines = camera_defines(frame);
        if (item.with_colors) defines.emplace_back("VERTEX_COLOR");
        if (accumulate) defines.emplace_back("ACCUMULATE");
        if (!accumulate && frame.with_ids) defines.emplace_back("OBJECT_ID");
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
        program.set("u_base_color", m.base_color);
        program.set("u_eye", Vec3(eye.cast<float>()));
        program.set("u_surfel", Vec4(item.style.surfel_scale, float(spacing_of(item)),
                                     float(frame.camera.near), float(T.linear().col(0).norm())));
        program.set("u_least_radius", least_surfel_radius);
        program.set("u_material", Vec3(m.metallic, m.roughness, code_of(item.kind)));
        program.set("u_object_id", int(item.object - frame.scene->objects.data()) + 1);
        program.set("u_depth_target", 0);
        buffers.array.bind();
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, int(item.mesh().V.rows()));
    }
}

void SurfelPass::normalise(const Frame& frame, const GBuffer& targets) {
    (frame.with_ids ? targets.surface_ids : targets.surface_emission).bind();
    std::vector<std::string> defines = camera_defines(frame);
    if (frame.with_ids) defines.emplace_back("OBJECT_ID");
    const gl::Program& program = quotients_.get(defines);
    program.use();
    set_depth_uniform(program, frame);
    const gl::Texture* sources[] = {&albedo_sum_, &normal_sum_, &material_sum_, &id_, &element_};
    const char* samplers[] = {"u_albedo_sum", "u_normal_sum", "u_material_sum", "u_id", "u_element"};
    for (unsigned unit = 0; unit < (frame.with_ids ? 5u : 3u); ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    no_attributes_.bind();
    draw_screen_triangle();
}

void SurfelPass::draw_natively(const Frame& frame, const std::vector<DrawItem>& items,
                               const GBuffer& targets) {
    std::vector<SoftwareSurfels::Source> sources;
    for (const DrawItem& item : items)
        sources.push_back({&item, SurfelProjector(item, frame, spacing_of(item))});
    std::vector<float> opaque(size_t(frame.size.x()) * size_t(frame.size.y()));
    targets.surface.read(3, gl::Format::r32f, 0, 0, frame.size.x(), frame.size.y(),
                         std::as_writable_bytes(std::span(opaque)));
    software_.draw(frame, sources, opaque, pixels_);
    if (!no_attributes_) no_attributes_ = gl::VertexArray::make();
    no_attributes_.bind();
    composite_.draw(frame, pixels_, targets);
}

}  // namespace easypbr::render
