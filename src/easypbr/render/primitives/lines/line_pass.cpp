#include "easypbr/render/primitives/lines/line_pass.h"

#include "easypbr/core/color.h"

namespace easypbr::render {

void LinePass::begin(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets,
                     const gl::Texture& opaque) {
    if (items.empty()) return;
    if (!depth_ || overlay_id_ != targets.overlay.attachment().id()) {
        depth_ = gl::Texture(gl::Format::depth32f, frame.size.x(), frame.size.y());
        framebuffer_ = gl::Framebuffer({&targets.overlay.drawn()}, &depth_);
        overlay_id_ = targets.overlay.attachment().id();
        last_depth_ = gl::Texture();
    }
    opaque_ = &opaque;
    normal_ = &targets.normal.texture();
    has_last_ = false;
    framebuffer_.bind();
    framebuffer_.clear_depth(0);
    draw_items(frame, items, Kind::nearest);
}

void LinePass::draw_behind(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets,
                           const GBuffer& layer) {
    if (items.empty()) return;
    add(frame, items, targets, Kind::ordered, &layer);
    if (!last_depth_) {
        last_depth_ = gl::Texture(gl::Format::r32f, frame.size.x(), frame.size.y());
        last_normal_ = gl::Texture(gl::Format::rg16, frame.size.x(), frame.size.y());
    }
    gl::copy(layer.depth.texture(), last_depth_);
    gl::copy(layer.normal.texture(), last_normal_);
    has_last_ = true;
}

void LinePass::draw_rest(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets) {
    add(frame, items, targets, Kind::ordered, nullptr);
}

void LinePass::draw_over(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets) {
    add(frame, items, targets, Kind::over, nullptr);
}

void LinePass::add(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets, Kind kind,
                   const GBuffer* next) {
    if (items.empty()) return;
    targets.display().bind();
    draw_items(frame, items, kind, next);
}

void LinePass::bind_surfaces(const gl::Program& program, const GBuffer* next) const {
    const auto bind = [&](const gl::Texture& texture, const char* sampler, unsigned unit) {
        texture.bind(unit);
        program.set(sampler, int(unit));
    };
    bind(*opaque_, "u_depth_target", 0);
    bind(*normal_, "u_normal", 1);
    if (has_last_) {
        bind(last_depth_, "u_last_depth", 3);
        bind(last_normal_, "u_last_normal", 4);
    }
    if (!next) return;
    bind(next->depth.texture(), "u_next_depth", 5);
    bind(next->normal.texture(), "u_next_normal", 6);
}

void LinePass::draw_items(const Frame& frame, const std::vector<LineItem>& items, Kind kind,
                          const GBuffer* next) {
    std::vector<std::string> defines = camera_defines(frame);
    if (kind == Kind::nearest) defines.emplace_back("DEPTH_ONLY");
    if (kind == Kind::ordered && has_last_) defines.emplace_back("AFTER");
    if (next) defines.emplace_back("BEFORE");
    const gl::Program& program = programs_.get(defines);
    program.use();
    set_camera_uniforms(program, frame);
    bind_surfaces(program, next);
    if (kind != Kind::nearest) depth_.bind(2);
    program.set("u_nearest_line", 2);
    program.set("u_least_w", frame.orthographic() ? 0.5f : float(frame.camera.near));
    const gl::DrawState nearest{
        .depth_test = gl::DepthTest::greater_equal, .write_depth = true, .write_color = false};
    const gl::DrawState state = kind == Kind::nearest ? nearest : gl::DrawState{.blending = gl::over};
    for (const LineItem& item : items) {
        if (kind != Kind::nearest && item.style.overlay != (kind == Kind::over)) continue;
        const LineBuffers& buffers = cache_.get(*item.object->mesh, item.kind, item.length);
        if (buffers.count == 0) continue;
        const Mat4d clip_from_mesh =
            frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
        program.set("u_clip_from_mesh", Mat4(clip_from_mesh.cast<float>()));
        program.set("u_half_width", item.style.line_width / 2);
        program.set("u_dash", item.style.line_dash);
        program.set("u_always", item.style.overlay ? 1.0f : 0.0f);
        program.set("u_color", item.color);
        gl::draw_quads(state, buffers.array, buffers.count);
    }
}

}  // namespace easypbr::render
