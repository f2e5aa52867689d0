#include "easypbr/render/transparency/transparency_pass.h"

#include <epoxy/gl.h>

namespace easypbr::render {

void TransparencyPass::begin(Frame& frame, const GBuffer& targets, const gl::Texture& opaque) {
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
    peel_ = {&opaque, true};
    count_ = 0;
}

bool TransparencyPass::open_layer(Frame& frame) {
    frame.behind = nullptr;
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

void TransparencyPass::look_behind(Frame& frame, const GBuffer& targets, bool rough, double reach) {
    if (!picture_ || Vec2i(picture_.width(), picture_.height()) != frame.size) {
        const int levels = std::max(1, gl::full_levels(frame.size.x(), frame.size.y()) - 3);
        picture_ = gl::Texture(gl::Format::rgba32f, frame.size.x(), frame.size.y(), levels);
        picture_.sampling(gl::Filtering::trilinear);
        levels_.clear();
        for (int level = 0; level < levels; ++level)
            levels_.push_back(gl::Framebuffer::of_level(picture_, level));
    }
    if (frame.with_overlay)
        merge_overlay(frame, targets);
    else
        gl::copy(targets.radiance, picture_);
    behind_ = {&picture_, rough ? int(levels_.size()) : 1, &targets.depth, nullptr, nullptr, reach};
    frame.behind = &behind_;
    if (!rough) return;
    const gl::Program& program = downsample_.get({});
    program.use();
    program.set("u_source", 0);
    picture_.bind(0);
    glDisable(GL_DEPTH_TEST);
    for (int level = 1; level < behind_.levels; ++level) {
        const gl::Framebuffer& target = levels_[size_t(level)];
        picture_.show_levels(level - 1, level - 1);
        target.bind();
        program.set("u_size", Vec2(float(target.width()), float(target.height())));
        draw_screen_triangle();
    }
    picture_.show_levels(0, behind_.levels - 1);
}

void TransparencyPass::merge_overlay(const Frame& frame, const GBuffer& targets) {
    const gl::Program& program = merge_.get({});
    levels_.front().bind();
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_exposure", frame.resolved->exposure);
    program.set("u_radiance", 0);
    program.set("u_overlay", 1);
    targets.radiance.bind(0);
    targets.overlay.bind(1);
    glDisable(GL_DEPTH_TEST);
    draw_screen_triangle();
}

void TransparencyPass::open_exits(Frame& frame) {
    if (!exits_.albedo || exits_.size() != frame.size) exits_ = GBuffer(frame.size);
    if (frame.extensions) exits_.add_extensions();
    exits_.clear_layer();
    peel_.limit = &layer_.depth;
    peel_.farthest = false;
    peel_.backs = true;
    frame.peel = &peel_;
}

void TransparencyPass::close_exits(Frame& frame) {
    peel_.backs = false;
    frame.peel = nullptr;
    behind_.exit_depth = &exits_.depth;
    behind_.exit_normal = &exits_.normal;
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

void TransparencyPass::blend(const Frame& frame, const GBuffer& targets, const gl::Texture* eye_dome) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(frame.covered.x, frame.covered.y, frame.covered.width, frame.covered.height);
    glEnable(GL_BLEND);
    layer_.test_covered();
    blend_radiance(frame, targets);
    if (frame.with_overlay) blend_overlay(frame, eye_dome);
    layer_.reset_depth_range();
    glDisable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ZERO);  // a second source is an error where there are several targets, even unused
    glDisable(GL_SCISSOR_TEST);
}

void TransparencyPass::blend_radiance(const Frame& frame, const GBuffer& targets) {
    std::vector<std::string> defines;
    if (frame.with_overlay) defines.emplace_back("OVERLAY");
    const gl::Program& program = programs_.get(defines);
    // The layer weakens what is behind by its opacity, and covers by what it does not let through.
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC1_ALPHA);
    radiance_.bind();
    program.use();
    bind_layer(program, frame);
    if (frame.with_overlay) {
        program.set("u_overlay", 3);
        targets.overlay.bind(3);
    }
    draw_screen_triangle();
}

void TransparencyPass::blend_overlay(const Frame& frame, const gl::Texture* eye_dome) {
    overlay_.bind();
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    for (const char* define : {"INTO_OVERLAY", "WEAKEN_OVERLAY"}) {
        const gl::Program& program = programs_.get(eye_dome ? std::vector<std::string>{define, "EYE_DOME"}
                                                            : std::vector<std::string>{define});
        program.use();
        bind_layer(program, frame);
        if (eye_dome) eye_dome->bind(3);
        program.set("u_shade", 3);
        draw_screen_triangle();
        glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    }
}

void TransparencyPass::end(Frame& frame) {
    frame.peel = nullptr;
    frame.behind = nullptr;
    frame.partly_covered = frame.partly_covered || count_ > 0;
}

}  // namespace easypbr::render
