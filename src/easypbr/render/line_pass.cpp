#include "easypbr/render/line_pass.h"

#include <epoxy/gl.h>

#include "easypbr/core/color.h"

namespace easypbr::render {

void LinePass::draw(const Frame& frame, const std::vector<LineItem>& items, const GBuffer& targets) {
    if (items.empty()) return;
    if (!depth_ || overlay_id_ != targets.overlay.id()) {
        depth_ = gl::Texture(gl::Format::depth32f, frame.size.x(), frame.size.y());
        framebuffer_ = gl::Framebuffer({&targets.overlay}, &depth_);
        overlay_id_ = targets.overlay.id();
    }
    framebuffer_.bind();
    framebuffer_.allow_depth_writes();
    framebuffer_.clear_depth(0);
    targets.depth.bind(0);
    targets.normal.bind(1);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_items(frame, items, true);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    targets.display.bind();
    glDisable(GL_DEPTH_TEST);
    depth_.bind(2);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_items(frame, items, false);
    glDisable(GL_BLEND);
}

void LinePass::draw_items(const Frame& frame, const std::vector<LineItem>& items, bool depth_only) {
    std::vector<std::string> defines = camera_defines(frame);
    if (depth_only) defines.emplace_back("DEPTH_ONLY");
    const gl::Program& program = programs_.get(defines);
    program.use();
    set_camera_uniforms(program, frame);
    program.set("u_depth_target", 0);
    program.set("u_normal", 1);
    program.set("u_nearest_line", 2);
    program.set("u_least_w", frame.orthographic() ? 0.5f : float(frame.camera.near));
    for (const LineItem& item : items) {
        const gpu::LineBuffers& buffers = cache_.get(*item.object->mesh, item.kind, item.length);
        if (buffers.count == 0) continue;
        const Mat4d clip_from_mesh =
            frame.clip_from_view * frame.camera.view() * item.object->T_world_mesh.matrix();
        program.set("u_clip_from_mesh", Mat4(clip_from_mesh.cast<float>()));
        program.set("u_half_width", item.style.line_width / 2);
        program.set("u_dash", item.style.line_dash);
        program.set("u_always", item.style.overlay ? 1.0f : 0.0f);
        program.set("u_color", item.color);
        buffers.array.bind();
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, buffers.count);
    }
}

}  // namespace easypbr::render
