#include "easypbr/render/effects/bloom/bloom_effect.h"

#include <algorithm>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Widest texels of the pyramid after which a light's glow has faded to 4e-8 of its sum.
constexpr int visible_texels = 6;

/// Texels of the first level that content gives light to.
PixelRect lit_texels(const Frame& frame, const Target& level) {
    if (frame.resolved->settings.background.shows_environment()) return level.whole();
    const PixelRect& r = frame.covered;
    const int x0 = std::max(r.x / glow_texel - 1, 0), y0 = std::max(r.y / glow_texel - 1, 0);
    const int x1 = std::min((r.x + r.width) / glow_texel + 2, level.width()),
              y1 = std::min((r.y + r.height) / glow_texel + 2, level.height());
    return {x0, y0, x1 - x0, y1 - y0};
}

/// A texel lies between the block of its own index and the next.
PixelRect blocks_of(const PixelRect& texels) {
    return {texels.x, texels.y, texels.width + 1, texels.height + 1};
}

/// What a target of this extent holds, for another level, by "DOWN", "UP", or nullptr: of the same size.
ShaderInputs resample_inputs(const Target& from, const Vec2& extent, const char* step) {
    ShaderInputs values;
    if (step) values.define(step);
    values.set("u_level", from);
    values.set("u_level_size", Vec2(from.size().cast<float>()));
    values.set("u_extent", extent);
    return values;
}

}  // namespace

void BloomEffect::make_levels(Vec2i size, int count) {
    if (size_ == size && levels_.size() == size_t(count)) return;
    size_ = size;
    levels_.clear();
    for (int i = 0; i < count; ++i) {
        const int texel = glow_texel << i;
        const Vec2i own((size.x() + texel - 1) / texel, (size.y() + texel - 1) / texel);
        Level level;
        level.light.target = Target(gl::Format::rgba16f, own);
        level.glow.target = Target(gl::Format::rgba16f, own);
        level.extent = size.cast<float>() / float(texel);
        levels_.push_back(std::move(level));
    }
    const Vec2i blocks = levels_.front().light.target.size() + Vec2i(1, 1);
    for (Target& sum : sums_) sum = Target(gl::Format::rgba32f, blocks);
    summed_ = gl::Framebuffer();
}

void BloomEffect::make_framebuffers() {
    for (const Target& sum : sums_) sum.drawn();
    if (summed_) return;
    summed_ = gl::Framebuffer(
        {&sums_[0].attachment(), &sums_[1].attachment(), &sums_[2].attachment(), &sums_[3].attachment()});
    for (Level& level : levels_)
        for (Picture* picture : {&level.light, &level.glow}) {
            picture->target.attachment().sampling(gl::Filtering::linear);
            picture->framebuffer = gl::Framebuffer({&picture->target.attachment()});
        }
}

bool BloomEffect::is_on(const Shot& shot) const {
    return shot.resolved->settings.bloom.enabled;
}

int BloomEffect::reach(const Frame& whole, const Box3d& /*bounds*/) const {
    return is_on(whole) ? visible_texels * (glow_texel << (whole.resolved->settings.bloom.levels - 1)) : 0;
}

void BloomEffect::begin(const Frame& frame) {
    const auto& bloom = frame.resolved->settings.bloom;
    make_levels(frame.size, bloom.levels);
    glow_.light = &levels_.front().glow.target;
    glow_.parameters = {bloom.intensity, frame.resolved->exposure, bloom.threshold,
                        bloom.knee * bloom.threshold};
}

void BloomEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const Frame& frame = inputs.frame;
    begin(frame);
    make_framebuffers();
    const Picture& first = levels_.front().light;
    const PixelRect area = lit_texels(frame, first.target);
    summed_.bind();
    blocks_.draw(block_inputs(frame, *lit.radiance), screen_state(blocks_of(area)));
    const float black[4] = {0, 0, 0, 0};
    first.target.drawn();
    first.framebuffer.clear_color(0, black);
    first.framebuffer.bind();
    gather_.draw(gather_inputs(), screen_state(area));
    spread([](ScreenShader& shader, const ShaderInputs& values, Picture& to, float kept) {
        to.target.drawn();
        to.framebuffer.bind();
        const gl::Blending mix{
            .source = gl::Factor::one_minus_constant, .target = gl::Factor::constant, .constant = kept};
        shader.draw(values, {.blending = kept > 0 ? mix : gl::replace});
    });
    finish(lit);
}

void BloomEffect::shade(const EffectInputs& inputs, LitPicture& lit, Transfers& transfers) {
    const Frame& frame = inputs.frame;
    begin(frame);
    const Target& first = levels_.front().light.target;
    const PixelRect area = lit_texels(frame, first), blocks = blocks_of(area);
    for (const Target& sum : sums_) sum.write(blocks);
    blocks_.shade(block_inputs(frame, *lit.radiance),
                  {.target = &sums_[0], .area = blocks, .further = {&sums_[1], &sums_[2], &sums_[3]}},
                  transfers);
    first.write(first.whole());
    std::ranges::fill(first.pixels<std::byte>(), std::byte{0});
    gather_.shade(gather_inputs(), {.target = &first, .area = area}, transfers);
    spread([&](ScreenShader& shader, const ShaderInputs& values, Picture& to, float kept) {
        if (kept <= 0) to.target.write(to.target.whole());
        shader.shade(values,
                     {.target = &to.target,
                      .area = to.target.whole(),
                      .store = kept > 0 ? native::Store::mix : native::Store::replace,
                      .kept = kept},
                     transfers);
    });
    finish(lit);
}

void BloomEffect::finish(LitPicture& lit) {
    lit.glow = &glow_;
    // Light falls where nothing is.
    lit.partly_covered = lit.spreads = true;
}

ShaderInputs BloomEffect::block_inputs(const Frame& frame, const Target& radiance) const {
    ShaderInputs values;
    if (frame.resolved->settings.bloom.suppress_fireflies) values.define("SUPPRESS_FIREFLIES");
    values.set("u_bloom", glow_.parameters);
    values.set("u_size", Vec2(frame.size.cast<float>()));
    values.set("u_radiance", radiance);
    return values;
}

ShaderInputs BloomEffect::gather_inputs() const {
    ShaderInputs values;
    const char* samplers[] = {"u_rise_rise", "u_fall_rise", "u_rise_fall", "u_fall_fall"};
    for (size_t i = 0; i < 4; ++i) values.set(samplers[i], sums_[i]);
    return values;
}

void BloomEffect::spread(const Run& run) {
    const size_t count = levels_.size();
    for (size_t i = 1; i < count; ++i) {
        const Level& larger = levels_[i - 1];
        run(resample_, resample_inputs(larger.light.target, larger.extent, "DOWN"), levels_[i].light, 0);
    }
    // Upwards each level becomes the mean of itself and the levels below, all counting alike.
    for (size_t i = count; i-- > 0;) {
        Level& level = levels_[i];
        run(resample_, resample_inputs(level.light.target, level.extent, nullptr), level.glow, 0);
        if (i + 1 == count) continue;
        const Level& smaller = levels_[i + 1];
        run(resample_, resample_inputs(smaller.glow.target, smaller.extent, "UP"), level.glow,
            1 / float(count - i));
    }
}

}  // namespace easypbr::render
