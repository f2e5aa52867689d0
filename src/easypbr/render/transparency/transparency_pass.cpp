#include "easypbr/render/transparency/transparency_pass.h"

#include "easypbr/scene/resolve.h"

namespace easypbr::render {

void TransparencyPass::begin(const Frame& frame, const GBuffer& targets, const gl::Texture& opaque,
                             ExtensionSet extensions, bool with_overlay) {
    extensions_ = extensions;
    with_overlay_ = with_overlay;
    if (!query_) query_ = gl::OcclusionQuery::make();
    if (layer_.size() != frame.size) {
        layer_ = GBuffer(frame.size);
        layer_.from_behind = true;
        limit_ = gl::Texture(gl::Format::r32f, frame.size.x(), frame.size.y());
    }
    if (extensions) layer_.add_extensions();
    radiance_.attach({&targets.radiance.drawn()}, &layer_.depth_test());
    if (with_overlay) overlay_.attach({&targets.overlay.drawn()}, &layer_.depth_test());
    peel_ = {&opaque, true};
    count_ = 0;
}

bool TransparencyPass::open_layer(const Frame& frame) {
    kept_ = false;
    if (count_ >= frame.resolved->settings.transparency.max_layers + 1) return false;
    if (count_ > 0) {
        gl::copy(layer_.depth.texture(), limit_);
        peel_ = {&limit_, false};
    }
    // Of what is left beyond the last allowed layer the nearest is worth the most.
    layer_.from_behind = count_ < frame.resolved->settings.transparency.max_layers;
    peel_.farthest = layer_.from_behind;
    layer_.clear_layer();
    query_.begin();
    return true;
}

bool TransparencyPass::close_layer() {
    query_.end();
    const bool drawn = query_.any_drawn();
    if (drawn) ++count_;
    return drawn;
}

void TransparencyPass::keep_picture(const Frame& frame, const GBuffer& targets, bool rough, double reach) {
    if (!picture_ || Vec2i(picture_.width(), picture_.height()) != frame.size) {
        const int levels = std::max(1, gl::full_levels(frame.size.x(), frame.size.y()) - 3);
        picture_ = gl::Texture(gl::Format::rgba32f, frame.size.x(), frame.size.y(), levels);
        picture_.sampling(gl::Filtering::trilinear);
        levels_.clear();
        for (int level = 0; level < levels; ++level)
            levels_.push_back(gl::Framebuffer::of_level(picture_, level));
    }
    if (with_overlay_)
        merge_overlay(frame, targets);
    else
        gl::copy(targets.radiance.texture(), picture_);
    transmission_ = {&picture_, {}, rough ? int(levels_.size()) : 1, &targets.depth, nullptr, nullptr, reach};
    kept_ = true;
    if (!rough) return;
    const gl::Program& program = downsample_.get({});
    program.use();
    program.set("u_finer", 0);
    picture_.bind(0);
    for (int level = 1; level < transmission_.levels; ++level) {
        const gl::Framebuffer& target = levels_[size_t(level)];
        picture_.show_levels(level - 1, level - 1);
        target.bind();
        program.set("u_size", Vec2(float(target.width()), float(target.height())));
        gl::draw_screen({});
    }
    picture_.show_levels(0, transmission_.levels - 1);
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
    gl::draw_screen({});
}

void TransparencyPass::open_exits(const Frame& frame) {
    if (exits_.size() != frame.size) exits_ = GBuffer(frame.size);
    if (extensions_) exits_.add_extensions();
    exits_.clear_layer();
    peel_.limit = &layer_.depth.texture();
    peel_.farthest = false;
    peel_.backs = true;
}

void TransparencyPass::close_exits() {
    peel_.backs = false;
    transmission_.exit_depth = &exits_.depth;
    transmission_.exit_normal = &exits_.normal;
}

void TransparencyPass::bind_layer(const gl::Program& program, const Frame& frame) const {
    program.set("u_size", Vec2(frame.size.cast<float>()));
    const Target* sources[] = {&layer_.radiance, &layer_.albedo, &layer_.material};
    const char* samplers[] = {"u_radiance", "u_albedo", "u_material"};
    for (unsigned unit = 0; unit < 3; ++unit) {
        sources[unit]->bind(unit);
        program.set(samplers[unit], int(unit));
    }
}

void TransparencyPass::blend(const Frame& frame, const GBuffer& targets, const gl::Texture* eye_dome) {
    blend_radiance(frame, targets);
    if (with_overlay_) blend_overlay(frame, eye_dome);
}

void TransparencyPass::blend_radiance(const Frame& frame, const GBuffer& targets) {
    std::vector<std::string> defines;
    if (with_overlay_) defines.emplace_back("OVERLAY");
    const gl::Program& program = programs_.get(defines);
    radiance_.bind();
    program.use();
    bind_layer(program, frame);
    if (with_overlay_) {
        program.set("u_overlay", 3);
        targets.overlay.bind(3);
    }
    // The layer weakens what is behind by its opacity, and covers by what it does not let through.
    gl::draw_screen(
        layer_state(frame, {.source = gl::Factor::one, .target = gl::Factor::one_minus_source1_alpha}));
}

void TransparencyPass::blend_overlay(const Frame& frame, const gl::Texture* eye_dome) {
    overlay_.bind();
    const gl::Blending weaken{.source = gl::Factor::zero, .target = gl::Factor::one_minus_source_alpha};
    for (const bool into : {true, false}) {
        std::vector<std::string> defines = {into ? "INTO_OVERLAY" : "WEAKEN_OVERLAY"};
        if (eye_dome) defines.emplace_back("EYE_DOME");
        const gl::Program& program = programs_.get(defines);
        program.use();
        bind_layer(program, frame);
        if (eye_dome) eye_dome->bind(3);
        program.set("u_shade", 3);
        gl::draw_screen(layer_state(frame, into ? gl::over : weaken));
    }
}

gl::DrawState TransparencyPass::layer_state(const Frame& frame, const gl::Blending& blending) const {
    gl::DrawState state = layer_.covered_state(blending);
    state.scissor = screen_state(frame.covered).scissor;
    return state;
}

}  // namespace easypbr::render
