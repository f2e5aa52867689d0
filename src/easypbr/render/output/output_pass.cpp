#include "easypbr/render/output/output_pass.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "easypbr/core/color.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/effects/ground/ground_pass.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/output/background_image.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

std::vector<std::string> curve_defines(const Frame& frame, Encoding encoding) {
    if (encoding == Encoding::scene_linear) return {"SCENE_LINEAR"};
    return {std::string(tone_feature(frame.resolved->settings.tonemap.tone_operator))};
}

std::vector<std::string> tone_defines(const Frame& frame, const LitPicture& lit, Encoding encoding) {
    std::vector<std::string> defines = curve_defines(frame, encoding);
    if (lit.partly_covered)
        defines.emplace_back("PARTLY_COVERED");
    else if (frame.averages_radiance)
        defines.emplace_back("COVERED_AT_EDGES");
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

void add_image(const BackgroundImage& background, const Frame& frame, const Target& light,
               ShaderInputs& values) {
    values.define("BACKGROUND_IMAGE");
    values.set("u_background_uv", background.uv(frame));
    values.set("u_background_image", light);
}

/// Whether codes hold a shadow by how viewers blend it.
bool has_shadow(const LitPicture& lit, Encoding encoding) {
    return lit.caught && encoding != Encoding::scene_linear;
}

void add_lit(const LitPicture& lit, const char* radiance, ShaderInputs& values) {
    if (lit.overlay) values.define("OVERLAY");
    if (lit.glow) values.define("BLOOM");
    values.set(radiance, *lit.radiance);
    if (lit.overlay) values.set("u_overlay", *lit.overlay);
    if (!lit.glow) return;
    values.set("u_bloom", lit.glow->parameters);
    values.set("u_glow", *lit.glow->light);
    values.set("u_glow_size", lit.glow->size());
}

/// Of a frame that is added to others.
ShaderInputs sample_inputs(const Frame& frame, const LitPicture& lit, Encoding encoding) {
    ShaderInputs values;
    values.define(tone_defines(frame, lit, encoding));
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_exposure", exposure_of(frame, encoding));
    add_lit(lit, "u_radiance", values);
    return values;
}

/// The background as the picture holds it.
Vec4 background_code(const Vec4& behind, Encoding encoding) {
    Vec4 code = behind;
    if (encoding != Encoding::scene_linear) code.head<3>() = srgb_from_linear(Vec3(code.head<3>()));
    return code;
}

PixelRect united(const PixelRect& a, const PixelRect& b) {
    const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

/// Writes one value to all pixels but those of a rectangle.
template <class Pixel>
void fill_around(const Target& picture, const PixelRect& area, const Pixel& value) {
    const auto pixels = picture.pixels<Pixel>();
    const int width = picture.width();
    parallel_for(size_t(picture.height()), 64, [&](size_t y) {
        Pixel* row = pixels.data() + y * size_t(width);
        const bool crosses = int(y) >= area.y && int(y) < area.y + area.height && area.width > 0;
        std::fill(row, row + (crosses ? area.x : width), value);
        if (crosses) std::fill(row + area.x + area.width, row + width, value);
    });
}

void fill_around(const Target& picture, const PixelRect& area, const Vec4& code) {
    const Vec4 c = code.cwiseMax(0.0f).cwiseMin(1.0f);
    if (picture.format() == gl::Format::rgba32f)
        fill_around<Vec4>(picture, area, code);
    else if (picture.format() == gl::Format::rgba16)
        fill_around<Eigen::Vector4<uint16_t>>(picture, area, (c * 65535.0f).array().round().cast<uint16_t>());
    else
        fill_around<Eigen::Vector4<uint8_t>>(picture, area, (c * 255.0f).array().round().cast<uint8_t>());
}

/// A single frame is anti-aliased by what it shows.
bool is_blurred(const Shot& shot, Encoding encoding) {
    return shot.sample_count == 1 && encoding != Encoding::scene_linear &&
           shot.resolved->settings.image.antialias == Antialias::fxaa;
}

/// Light may have reached all pixels.
bool is_whole(const Frame& frame, const LitPicture& lit) {
    return frame.resolved->settings.background.shows_environment() || lit.spreads;
}

/// Rows of noisy light that are held at once on their way to the mean.
constexpr int sample_rows = 128;

/// Screen passes touch only where geometry may be, when nothing else was drawn.
gl::DrawState limited_to(const PixelRect& area, const Frame& frame, const LitPicture& lit,
                         const gl::Blending& blending = gl::replace) {
    if (is_whole(frame, lit)) return {.blending = blending};
    return screen_state(area, blending);
}

}  // namespace

bool OutputPass::is_transparent(const Frame& frame) const {
    return without_image_ || frame.resolved->settings.background.mode == BackgroundMode::transparent;
}

Vec4 OutputPass::behind(const Frame& frame) const {
    const BackgroundSettings& background = frame.resolved->settings.background;
    if (is_transparent(frame) || background.shows_environment()) return Vec4::Zero();
    const Vec3 c = linear_from_srgb(background.color);
    return {c.x(), c.y(), c.z(), 1};
}

ShaderInputs OutputPass::display_inputs(const Frame& frame, const LitPicture& lit, const Target* sum) const {
    ShaderInputs values;
    values.define(tone_defines(frame, lit, encoding_));
    if (encoding_ == Encoding::scene_linear) values.define("LINEAR_OUTPUT");
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_exposure", exposure_of(frame, encoding_));
    values.set("u_sample_scale", 1.0f / float(frame.sample_index + 1));
    values.set("u_background", behind(frame));
    if (has_shadow(lit, encoding_)) {
        values.define("SHADOW");
        values.set("u_shadow_share", shadow_share_);
        values.set("u_share_scale", 1.0f / float(frame.sample_index + 1));
    }
    if (sum) {
        values.define("SUM");
        values.set("u_source", *sum);
    } else {
        add_lit(lit, "u_source", values);
    }
    return values;
}

void OutputPass::begin(Vec2i size, Encoding encoding, bool without_image) {
    const gl::Format format = format_of(encoding);
    if (picture_.size() != size || picture_.format() != format) {
        picture_ = Target(format, size);
        sum_ = Target(gl::Format::rgba32f, size);
        aliased_ = Target(format, size);
        shadow_share_ = Target(gl::Format::r32f, size);
        share_framebuffer_ = gl::Framebuffer();
        picture_framebuffer_ = gl::Framebuffer();
        sum_framebuffer_ = gl::Framebuffer();
    }
    encoding_ = encoding;
    without_image_ = without_image;
}

const gl::Framebuffer& OutputPass::framebuffer() const {
    picture_.upload(transfers_);
    if (!picture_framebuffer_) picture_framebuffer_ = gl::Framebuffer({&picture_.attachment()});
    picture_.drawn();
    return picture_framebuffer_;
}

const gl::Texture& OutputPass::texture() const {
    picture_.upload(transfers_);
    return picture_.texture();
}

const gl::Texture& OutputPass::drawn() const {
    picture_.upload(transfers_);
    return picture_.drawn();
}

void OutputPass::accumulate(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces) {
    const bool first = frame.sample_index == 0;
    drawn_ = first ? lit.covered : united(drawn_, lit.covered);
    add_shadow_share(frame, lit, surfaces);
    if (frame.averages_radiance) return add_radiance(frame, lit, surfaces, mean_);
    const ShaderInputs values = sample_inputs(frame, lit, encoding_);
    if (lit.radiance->is_ahead() && (first || sum_.is_ahead())) return add_natively(frame, lit, values);

    lit.radiance->upload(transfers_);
    sum_.upload(transfers_);
    if (!sum_framebuffer_) sum_framebuffer_ = gl::Framebuffer({&sum_.attachment()});
    sum_.drawn();
    const float zero[4] = {0, 0, 0, 0};
    if (first) sum_framebuffer_.clear_color(0, zero);
    sum_framebuffer_.bind();
    accumulate_.draw(values, limited_to(lit.covered, frame, lit, gl::add));
}

void OutputPass::accumulate_layers(const Frame& frame, const LitPicture& lit, const GBuffer& surfaces) {
    add_radiance(frame, lit, surfaces, layers_mean_);
}

LitPicture OutputPass::layers_mean(const Frame& frame) {
    LitPicture lit;
    lit.partly_covered = true;
    return mean_of(frame, lit, layers_mean_);
}

// The mean of noisy light comes before the tone curve, and what covers it after.
void OutputPass::add_radiance(const Frame& frame, const LitPicture& lit_frame, const GBuffer& surfaces,
                              RadianceMean& mean) {
    const bool looks_for_noise = frame.resolved->settings.image.noise > 0;
    if (frame.sample_index == 0)
        mean.begin(frame.size, looks_for_noise || denoising_of(frame) != Denoising::off);
    LitPicture lit = lit_frame;
    if (const Target* overlay = std::exchange(lit.overlay, nullptr))
        mean.add_overlay(frame, *overlay, transfers_);
    lit.partly_covered = true;
    const ShaderInputs values = sample_inputs(frame, lit, Encoding::scene_linear);
    const PixelRect area = is_whole(frame, lit) ? frame.whole() : lit.covered;
    const GBuffer& seen = lit.guides ? *lit.guides : surfaces;
    const Target& sample = mean.sample();
    mean.begin_frame(frame, lit.guides != nullptr);
    if (lit.radiance->is_ahead()) {
        for (int y = 0; y < area.height; y += sample_rows) {
            const PixelRect band{area.x, area.y + y, area.width, std::min(sample_rows, area.height - y)};
            sample.write(band);
            accumulate_.shade(values, {.target = &sample, .area = band}, transfers_);
            mean.add(frame, band, seen, transfers_);
        }
    } else {
        sample.drawn();
        sample_framebuffer_ = gl::Framebuffer({&sample.attachment()});
        sample_framebuffer_.bind();
        accumulate_.draw(values, screen_state(area));
        mean.add(frame, area, seen, transfers_);
    }
    mean.end_frame();
}

bool OutputPass::is_good(const Frame& frame) const {
    const float noise = frame.resolved->settings.image.noise;
    return noise > 0 && frame.averages_radiance && mean_.is_good(noise, exposure_of(frame, Encoding::srgb8));
}

void OutputPass::end_tiles(const Frame& frame) {
    const float noise = frame.resolved->settings.image.noise;
    if (noise > 0) mean_.end_tiles(noise, exposure_of(frame, Encoding::srgb8));
}

Denoising OutputPass::denoising_of(const Frame& frame) const {
    const Denoising asked = frame.resolved->settings.path.denoise;
    const bool is_reference = encoding_ == Encoding::scene_linear && frame.resolved->asks_for_paths;
    return is_reference && asked == Denoising::best ? Denoising::off : asked;
}

void OutputPass::add_natively(const Frame& frame, const LitPicture& lit, const ShaderInputs& values) {
    if (frame.sample_index == 0) {
        sum_.write(sum_.whole());
        fill_around<Vec4>(sum_, {}, Vec4::Zero());
    }
    accumulate_.shade(values,
                      {.target = &sum_,
                       .area = is_whole(frame, lit) ? frame.whole() : lit.covered,
                       .store = native::Store::add},
                      transfers_);
}

// It is to the sum or the mean what shadows are in it: of a sum of displayed frames overlays are a part.
void OutputPass::add_shadow_share(const Frame& frame, const LitPicture& lit_frame, const GBuffer& surfaces) {
    if (!has_shadow(lit_frame, encoding_)) return;
    const bool is_displayed = frame.sample_count > 1 && !frame.averages_radiance;
    LitPicture lit = lit_frame;
    if (!is_displayed) {
        lit.overlay = nullptr;
        lit.glow = nullptr;
        lit.partly_covered = true;
    }
    ShaderInputs values = sample_inputs(frame, lit, is_displayed ? encoding_ : Encoding::scene_linear);
    values.set("u_material", surfaces.material);
    values.set("u_depth_target", surfaces.depth);
    GroundPass::set_caught(values, *frame.resolved, *lit.caught);
    const bool first = frame.sample_index == 0;
    if (lit.radiance->is_ahead() && (first || shadow_share_.is_ahead())) {
        if (first) {
            shadow_share_.write(shadow_share_.whole());
            std::ranges::fill(shadow_share_.pixels<float>(), 0.0f);
        }
        return share_.shade(values,
                            {.target = &shadow_share_, .area = frame.whole(), .store = native::Store::add},
                            transfers_);
    }
    for (const Target* target : std::initializer_list<const Target*>{
             lit.radiance, lit.caught, &surfaces.material, &surfaces.depth, &shadow_share_})
        target->upload(transfers_);
    if (!share_framebuffer_) share_framebuffer_ = gl::Framebuffer({&shadow_share_.attachment()});
    shadow_share_.drawn();
    const float zero[4] = {0, 0, 0, 0};
    if (first) share_framebuffer_.clear_color(0, zero);
    share_framebuffer_.bind();
    share_.draw(values, {.blending = gl::add});
}

LitPicture OutputPass::mean_of(const Frame& frame, const LitPicture& lit, RadianceMean& mean) {
    LitPicture shown = lit;
    shown.radiance = &mean.mean(denoising_of(frame), frame.resolved->exposure, transfers_);
    shown.overlay = mean.overlay_mean();
    shown.glow = nullptr;
    shown.covered = drawn_;
    return shown;
}

const Target* OutputPass::sum_of(const Frame& frame) const {
    return frame.sample_count > 1 && !frame.averages_radiance ? &sum_ : nullptr;
}

LitPicture OutputPass::finish(const Frame& frame, const LitPicture& lit_frame, BackgroundImage* background,
                              const GBuffer& surfaces, const GBuffer* exact) {
    if (frame.sample_count == 1 && !frame.averages_radiance) add_shadow_share(frame, lit_frame, surfaces);
    const LitPicture lit = frame.averages_radiance ? mean_of(frame, lit_frame, mean_) : lit_frame;
    const Target* sum = sum_of(frame);
    if ((sum ? sum : lit.radiance)->is_ahead())
        finish_natively(frame, lit, background, exact);
    else
        finish_by_driver(frame, lit, background, exact);
    return lit;
}

void OutputPass::finish_by_driver(const Frame& frame, const LitPicture& lit, BackgroundImage* background,
                                  const GBuffer* exact) {
    const Target* sum = sum_of(frame);
    (sum ? sum : lit.radiance)->upload(transfers_);
    if (has_shadow(lit, encoding_)) shadow_share_.upload(transfers_);
    ShaderInputs values = display_inputs(frame, lit, sum);
    gl::DrawState state;
    picture_.drawn();
    framebuffer().bind();
    if (background) {
        const Target& light =
            background->light(frame.picture_size, gl::Context::current().info().max_texture_size);
        light.upload(transfers_);
        light.release();
        light.attachment().sampling(gl::Filtering::linear);
        add_image(*background, frame, light, values);
    } else {
        const Vec4 code = background_code(behind(frame), encoding_);
        const float rgba[4] = {code.x(), code.y(), code.z(), code.w()};
        picture_framebuffer_.clear_color(0, rgba);
        state = limited_to(sum ? drawn_ : lit.covered, frame, lit);
    }
    display_.draw(values, state);
    if (is_blurred(frame, encoding_)) blur_edges(frame, lit, exact);
}

void OutputPass::finish_natively(const Frame& frame, const LitPicture& lit, BackgroundImage* background,
                                 const GBuffer* exact) {
    const Target* sum = sum_of(frame);
    const PixelRect area = background || is_whole(frame, lit) ? frame.whole() : sum ? drawn_ : lit.covered;
    ShaderInputs values = display_inputs(frame, lit, sum);
    if (background)
        add_image(*background, frame,
                  background->light(frame.picture_size, BackgroundImage::most_native_side), values);
    picture_.write(picture_.whole());
    fill_around(picture_, area, background_code(behind(frame), encoding_));
    display_.shade(values, {.target = &picture_, .area = area}, transfers_);
    if (is_blurred(frame, encoding_)) blur_edges_natively(frame, lit, exact);
}

void OutputPass::write_exact(const Frame& frame, const LitPicture& lit, const GBuffer& targets, bool layers) {
    ShaderInputs values;
    values.define(tone_defines(frame, lit, encoding_));
    if (layers) values.define("LAYERS");
    if (encoding_ == Encoding::scene_linear) values.define("LINEAR_OUTPUT");
    if (lit.overlay) values.define("OVERLAY");
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_albedo", targets.albedo);
    values.set("u_material", targets.material);
    values.set("u_depth_target", targets.depth);
    if (lit.overlay) values.set("u_overlay", *lit.overlay);
    if (layers) {
        values.set("u_radiance", *lit.radiance);
        values.set("u_exposure", exposure_of(frame, encoding_));
    }
    if (is_finished_natively()) {
        const PixelRect area = targets.depth.is_ahead() ? targets.depth.area() : frame.whole();
        return exact_.shade(values, {.target = &picture_, .area = area}, transfers_);
    }
    framebuffer().bind();
    exact_.draw(values, {});
}

ShaderInputs OutputPass::edge_inputs(const Frame& frame, const LitPicture& lit, const GBuffer* exact) const {
    ShaderInputs values;
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_color", aliased_);
    if (is_transparent(frame)) values.define("ALPHA");
    if (lit.lines) {
        values.define("LINES");
        values.set("u_nearest_line", *lit.lines);
    }
    if (!exact) return values;
    values.define("EXACT");
    values.set("u_material", exact->material);
    values.set("u_depth_target", exact->depth);
    return values;
}

void OutputPass::blur_edges(const Frame& frame, const LitPicture& lit, const GBuffer* exact) {
    const PixelRect& area = lit.covered;
    if (area.width == 0 || area.height == 0) return;
    const gl::Texture& aliased = aliased_.drawn();
    aliased_.attachment().sampling(gl::Filtering::linear);
    gl::copy(picture_.texture(), aliased);
    framebuffer().bind();
    // Edges are where geometry is; the environment behind it is smooth.
    if (lit.lines) lit.lines->upload(transfers_);
    fxaa_.draw(edge_inputs(frame, lit, exact), screen_state(area));
}

void OutputPass::blur_edges_natively(const Frame& frame, const LitPicture& lit, const GBuffer* exact) {
    const PixelRect& area = lit.covered;
    if (area.width == 0 || area.height == 0) return;
    // As far as FXAA looks: half its span, and the filter.
    constexpr int reach = 6;
    const int first = std::max(0, area.y - reach),
              last = std::min(frame.size.y(), area.y + area.height + reach);
    aliased_.write(aliased_.whole());
    const auto from = picture_.pixels<std::byte>(), to = aliased_.pixels<std::byte>();
    const size_t row = size_t(frame.size.x()) * gl::pixel_bytes(picture_.format());
    parallel_for(size_t(last - first), 64, [&](size_t i) {
        const size_t at = (size_t(first) + i) * row;
        std::copy_n(from.data() + at, row, to.data() + at);
    });
    fxaa_.shade(edge_inputs(frame, lit, exact), {.target = &picture_, .area = area}, transfers_);
}

}  // namespace easypbr::render
