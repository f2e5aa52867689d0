#include "easypbr/render/transparency_pass.h"

#include <epoxy/gl.h>

namespace easypbr::render {

void TransparencyPass::begin(Frame& frame, const GBuffer& targets) {
    if (!query_) query_ = gl::OcclusionQuery::make();
    if (!layer_.albedo || layer_.size() != frame.size) {
        layer_ = GBuffer(frame.size);
        layer_.from_behind = true;
        limit_ = gl::Texture(gl::Format::r32f, frame.size.x(), frame.size.y());
        radiance_id_ = overlay_id_ = 0;
    }
    if (frame.extensions) layer_.add_extensions();
    // The identity of a texture may be given again once it is deleted, but then the targets' size has
    // changed, and the layer with it.
    if (radiance_id_ != targets.radiance.id()) {
        radiance_ = gl::Framebuffer({&targets.radiance}, &layer_.depth_test);
        radiance_id_ = targets.radiance.id();
    }
    if (frame.with_overlay && overlay_id_ != targets.overlay.id()) {
        overlay_ = gl::Framebuffer({&targets.overlay}, &layer_.depth_test);
        overlay_id_ = targets.overlay.id();
    }
    peel_ = {&targets.depth, true};
    count_ = 0;
}

bool TransparencyPass::open_layer(Frame& frame) {
    if (count_ >= frame.resolved->settings.transparency.max_layers + 1) return false;
    if (count_ > 0) {
        gl::copy(layer_.depth, limit_);
        peel_ = {&limit_, false};
    }
    // Of what is left beyond the last allowed layer the nearest is worth the most.
    layer_.from_behind = count_ < frame.resolved->settings.transparency.max_layers;
    peel_.farthest = layer_.from_behind;
    frame.peel = &peel_;
    layer_.clear_layer();
    query_.begin();
    return true;
}

bool TransparencyPass::close_layer(Frame& frame) {
    query_.end();
    frame.peel = nullptr;
    const bool drawn = query_.any_drawn();
    if (drawn) ++count_;
    return drawn;
}

void TransparencyPass::bind_layer(const gl::Program& program, const Frame& frame) const {
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const gl::Texture* sources[] = {&layer_.radiance, &layer_.albedo, &layer_.material};
    const char* samplers[] = {"u_radiance", "u_albedo", "u_material"};
    for (unsigned unit = 0; unit < 3; ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
}

void TransparencyPass::blend(const Frame& frame, const GBuffer& targets) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(frame.covered.x, frame.covered.y, frame.covered.width, frame.covered.height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    layer_.test_covered();
    blend_radiance(frame, targets);
    if (frame.with_overlay) blend_overlay(frame);
    layer_.reset_depth_range();
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

void TransparencyPass::blend_radiance(const Frame& frame, const GBuffer& targets) {
    std::vector<std::string> defines;
    if (frame.with_overlay) defines.emplace_back("OVERLAY");
    const gl::Program& program = programs_.get(defines);
    radiance_.bind();
    program.use();
    bind_layer(program, frame);
    if (frame.with_overlay) {
        program.set("u_overlay", 3);
        targets.overlay.bind(3);
    }
    draw_screen_triangle();
}

void TransparencyPass::blend_overlay(const Frame& frame) {
    overlay_.bind();
    for (const char* define : {"INTO_OVERLAY", "WEAKEN_OVERLAY"}) {
        const gl::Program& program = programs_.get({define});
        program.use();
        bind_layer(program, frame);
        draw_screen_triangle();
        glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    }
}

void TransparencyPass::end(Frame& frame) {
    frame.peel = nullptr;
    frame.partly_covered = frame.partly_covered || count_ > 0;
}

}  // namespace easypbr::render
