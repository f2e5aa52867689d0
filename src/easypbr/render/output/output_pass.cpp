#include "easypbr/render/output/output_pass.h"

#include <algorithm>

#include "easypbr/core/color.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

std::vector<std::string> curve_defines(const Frame& frame, Encoding encoding) {
    if (encoding == Encoding::scene_linear) return {"SCENE_LINEAR"};
    switch (frame.resolved->settings.tonemap.tone_operator) {
        case ToneOperator::reinhard:
            return {"TONE_REINHARD"};
        case ToneOperator::agx:
            return {"TONE_AGX"};
        case ToneOperator::neutral:
            return {"TONE_NEUTRAL"};
        case ToneOperator::none:
            return {"TONE_NONE"};
        default:
            return {"TONE_ACES"};
    }
}

std::vector<std::string> tone_defines(const Frame& frame, const LitPicture& lit, Encoding encoding) {
    std::vector<std::string> defines = curve_defines(frame, encoding);
    if (lit.partly_covered) defines.emplace_back("PARTLY_COVERED");
    return defines;
}

gl::Format format_of(Encoding encoding) {
    return encoding == Encoding::srgb8    ? gl::Format::rgba8
           : encoding == Encoding::srgb16 ? gl::Format::rgba16
                                          : gl::Format::rgba32f;
}

float exposure_of(const Frame& frame, Encoding encoding) {
    return encoding == Encoding::scene_linear ? 1.0f : frame.resolved->exposure;
}

Vec4 background_color(const Frame& frame) {
    const BackgroundSettings& background = frame.resolved->settings.background;
    if (background.mode == BackgroundMode::transparent || background.shows_environment()) return Vec4::Zero();
    const Vec3 c = linear_from_srgb(background.color);
    return {c.x(), c.y(), c.z(), 1};
}

/// Scale and offset of the frame's texture coordinates with which an image covers the picture, centred,
/// nothing distorted.
Vec4 covering_uv(const gl::Texture& image, const Frame& frame) {
    const Vec2 whole = frame.picture_size.cast<float>();
    const float picture = whole.x() / whole.y(), own = float(image.width()) / float(image.height());
    const Vec2 scale = picture > own ? Vec2(1, own / picture) : Vec2(picture / own, 1);
    const Vec2 part = scale.cwiseProduct(frame.size.cast<float>().cwiseQuotient(whole));
    const Vec2 first =
        (Vec2(1, 1) - scale) / 2 + scale.cwiseProduct(frame.origin.cast<float>().cwiseQuotient(whole));
    return {part.x(), part.y(), first.x(), first.y()};
}

constexpr unsigned overlay_unit = 2, glow_unit = 3;

void add_defines(const LitPicture& lit, std::vector<std::string>& defines) {
    if (lit.overlay) defines.emplace_back("OVERLAY");
    if (lit.glow) defines.emplace_back("BLOOM");
}

void bind_overlay(const gl::Program& program, const Target& overlay) {
    program.set("u_overlay", int(overlay_unit));
    overlay.bind(overlay_unit);
}

void bind_lit(const LitPicture& lit, const gl::Program& program) {
    lit.radiance->bind(0);
    if (lit.overlay) bind_overlay(program, *lit.overlay);
    if (lit.glow) set_glow_uniforms(program, *lit.glow, glow_unit);
}

PixelRect united(const PixelRect& a, const PixelRect& b) {
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

/// Screen passes touch only where geometry may be, when nothing else was drawn.
gl::DrawState limited_to(const PixelRect& area, const Frame& frame, const LitPicture& lit,
                         const gl::Blending& blending = gl::replace) {
    if (frame.resolved->settings.background.shows_environment() || lit.spreads) return {.blending = blending};
    return screen_state(area, blending);
}

}  // namespace

void OutputPass::begin(Vec2i size, Encoding encoding) {
    const gl::Format format = format_of(encoding);
    if (!picture_ || picture_.width() != size.x() || picture_.height() != size.y() ||
        picture_.format() != format) {
        picture_ = gl::Texture(format, size.x(), size.y());
        picture_framebuffer_ = gl::Framebuffer({&picture_});
        sum_ = gl::Texture();
        aliased_ = gl::Texture();
    }
    encoding_ = encoding;
}

void OutputPass::accumulate(const Frame& frame, const LitPicture& lit) {
    if (!sum_) {
        sum_ = gl::Texture(gl::Format::rgba32f, frame.size.x(), frame.size.y());
        sum_framebuffer_ = gl::Framebuffer({&sum_});
    }
    drawn_ = frame.sample_index == 0 ? lit.covered : united(drawn_, lit.covered);
    const float zero[4] = {0, 0, 0, 0};
    if (frame.sample_index == 0) sum_framebuffer_.clear_color(0, zero);
    sum_framebuffer_.bind();
    std::vector<std::string> defines = tone_defines(frame, lit, encoding_);
    add_defines(lit, defines);
    const gl::Program& program = accumulate_.get(defines);
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_exposure", exposure_of(frame, encoding_));
    program.set("u_radiance", 0);
    bind_lit(lit, program);
    gl::draw_screen(limited_to(lit.covered, frame, lit, gl::add));
}

void OutputPass::finish(const Frame& frame, const LitPicture& lit, const gl::Texture* background_image,
                        const GBuffer* exact) {
    const bool sum = frame.sample_count > 1;
    std::vector<std::string> defines = tone_defines(frame, lit, encoding_);
    if (sum)
        defines.emplace_back("SUM");
    else
        add_defines(lit, defines);
    if (background_image) defines.emplace_back("BACKGROUND_IMAGE");
    if (encoding_ == Encoding::scene_linear) defines.emplace_back("LINEAR_OUTPUT");
    const gl::Program& program = display_.get(defines);
    gl::DrawState state;
    picture_framebuffer_.bind();
    if (!background_image) {
        const Vec4 b = background_color(frame);
        Vec4 code = b;
        if (encoding_ != Encoding::scene_linear) code.head<3>() = srgb_from_linear(Vec3(b.head<3>()));
        const float rgba[4] = {code.x(), code.y(), code.z(), code.w()};
        picture_framebuffer_.clear_color(0, rgba);
        state = limited_to(sum ? drawn_ : lit.covered, frame, lit);
    }
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_exposure", exposure_of(frame, encoding_));
    program.set("u_sample_scale", 1.0f / float(frame.sample_index + 1));
    program.set("u_background", background_color(frame));
    program.set("u_source", 0);
    if (sum)
        sum_.bind(0);
    else
        bind_lit(lit, program);
    if (background_image) {
        program.set("u_background_image", 1);
        program.set("u_background_uv", covering_uv(*background_image, frame));
        background_image->bind(1);
    }
    gl::draw_screen(state);
    const bool single = !sum && encoding_ != Encoding::scene_linear;
    if (single && frame.resolved->settings.image.antialias == Antialias::fxaa)
        blur_edges(frame, lit.covered, exact);
}

void OutputPass::write_exact(const Frame& frame, const LitPicture& lit, const GBuffer& targets, bool layers) {
    std::vector<std::string> defines = tone_defines(frame, lit, encoding_);
    if (layers) defines.emplace_back("LAYERS");
    if (encoding_ == Encoding::scene_linear) defines.emplace_back("LINEAR_OUTPUT");
    if (lit.overlay) defines.emplace_back("OVERLAY");
    const gl::Program& program = exact_.get(defines);
    picture_framebuffer_.bind();
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_albedo", 0);
    program.set("u_material", 1);
    targets.albedo.bind(0);
    targets.material.bind(1);
    if (lit.overlay) bind_overlay(program, *lit.overlay);
    if (layers) {
        targets.radiance.bind(3);
        program.set("u_radiance", 3);
        program.set("u_exposure", exposure_of(frame, encoding_));
    }
    gl::draw_screen({});
}

void OutputPass::blur_edges(const Frame& frame, const PixelRect& area, const GBuffer* exact) {
    if (area.width == 0 || area.height == 0) return;
    if (!aliased_) {
        aliased_ = gl::Texture(picture_.format(), frame.size.x(), frame.size.y());
        aliased_.sampling(gl::Filtering::linear);
    }
    gl::copy(picture_, aliased_);
    picture_framebuffer_.bind();
    const gl::Program& program =
        fxaa_.get(exact ? std::vector<std::string>{"EXACT"} : std::vector<std::string>{});
    program.use();
    program.set("u_size", Vec2(frame.size.cast<float>()));
    program.set("u_color", 0);
    aliased_.bind(0);
    if (exact) {
        program.set("u_material", 1);
        exact->material.bind(1);
    }
    // Edges are where geometry is; the environment behind it is smooth.
    gl::draw_screen(screen_state(area));
}

}  // namespace easypbr::render
