#include "easypbr/render/effects/bloom/bloom_effect.h"

#include <algorithm>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Widest texels of the pyramid after which a light's glow has faded to 4e-8 of its sum.
constexpr int visible_texels = 6;

/// Texels of the first level that content gives light to.
PixelRect lit_texels(const Frame& frame, const gl::Texture& level) {
    if (frame.resolved->settings.background.shows_environment()) return {0, 0, level.width(), level.height()};
    const PixelRect& r = frame.covered;
    const int x0 = std::max(r.x / glow_texel - 1, 0), y0 = std::max(r.y / glow_texel - 1, 0);
    const int x1 = std::min((r.x + r.width) / glow_texel + 2, level.width()),
              y1 = std::min((r.y + r.height) / glow_texel + 2, level.height());
    return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace

void BloomEffect::make_levels(Vec2i size, int count) {
    if (size_ == size && levels_.size() == size_t(count)) return;
    size_ = size;
    levels_.clear();
    for (int i = 0; i < count; ++i) {
        const int texel = glow_texel << i;
        Level level;
        const int width = (size.x() + texel - 1) / texel, height = (size.y() + texel - 1) / texel;
        for (gl::Texture* texture : {&level.light, &level.glow}) {
            *texture = gl::Texture(gl::Format::rgba16f, width, height);
            texture->sampling(gl::Filtering::linear);
        }
        level.lit = gl::Framebuffer({&level.light});
        level.glowing = gl::Framebuffer({&level.glow});
        level.extent = size.cast<float>() / float(texel);
        levels_.push_back(std::move(level));
    }
    const gl::Texture& first = levels_.front().light;
    for (gl::Texture& sum : sums_)
        sum = gl::Texture(gl::Format::rgba32f, first.width() + 1, first.height() + 1);
    summed_ = gl::Framebuffer({&sums_[0], &sums_[1], &sums_[2], &sums_[3]});
}

bool BloomEffect::is_on(const Shot& shot) const {
    return shot.resolved->settings.bloom.enabled;
}

int BloomEffect::reach(const Frame& whole, const Box3d& /*bounds*/) const {
    return is_on(whole) ? visible_texels * (glow_texel << (whole.resolved->settings.bloom.levels - 1)) : 0;
}

void BloomEffect::draw(const EffectInputs& inputs, LitPicture& lit) {
    const Frame& frame = inputs.frame;
    make_levels(frame.size, frame.resolved->settings.bloom.levels);
    const auto& bloom = frame.resolved->settings.bloom;
    glow_.light = &levels_.front().glow;
    glow_.parameters = {bloom.intensity, frame.resolved->exposure, bloom.threshold,
                        bloom.knee * bloom.threshold};
    gather(frame, lit.radiance->texture());
    const size_t count = levels_.size();
    for (size_t i = 1; i < count; ++i)
        resample(levels_[i - 1].light, levels_[i - 1].extent, levels_[i].lit, {"DOWN"}, gl::replace);
    // Upwards each level becomes the mean of itself and the levels below, all counting alike.
    for (size_t i = count; i-- > 0;) {
        resample(levels_[i].light, levels_[i].extent, levels_[i].glowing, {}, gl::replace);
        if (i + 1 == count) continue;
        const gl::Blending mean{.source = gl::Factor::one_minus_constant,
                                .target = gl::Factor::constant,
                                .constant = 1 / float(count - i)};
        resample(levels_[i + 1].glow, levels_[i + 1].extent, levels_[i].glowing, {"UP"}, mean);
    }
    lit.glow = &glow_;
    // Light falls where nothing is.
    lit.partly_covered = lit.spreads = true;
}

void BloomEffect::gather(const Frame& frame, const gl::Texture& radiance) {
    const Level& first = levels_.front();
    const float black[4] = {0, 0, 0, 0};
    first.lit.clear_color(0, black);
    const PixelRect area = lit_texels(frame, first.light);
    std::vector<std::string> defines;
    if (frame.resolved->settings.bloom.suppress_fireflies) defines.emplace_back("SUPPRESS_FIREFLIES");
    const gl::Program& blocks = blocks_.get(defines);
    summed_.bind();
    blocks.use();
    blocks.set("u_bloom", glow_.parameters);
    blocks.set("u_size", Vec2(frame.size.cast<float>()));
    blocks.set("u_radiance", 0);
    radiance.bind(0);
    // A texel lies between the block of its own index and the next.
    gl::draw_screen(screen_state({area.x, area.y, area.width + 1, area.height + 1}));
    const gl::Program& texels = gather_.get({});
    first.lit.bind();
    texels.use();
    const char* samplers[] = {"u_rise_rise", "u_fall_rise", "u_rise_fall", "u_fall_fall"};
    for (unsigned i = 0; i < 4; ++i) {
        sums_[i].bind(i);
        texels.set(samplers[i], int(i));
    }
    gl::draw_screen(screen_state(area));
}

void BloomEffect::resample(const gl::Texture& from, const Vec2& extent, const gl::Framebuffer& to,
                           const std::vector<std::string>& step, const gl::Blending& blending) {
    const gl::Program& program = resample_.get(step);
    to.bind();
    program.use();
    program.set("u_source", 0);
    program.set("u_source_size", Vec2(float(from.width()), float(from.height())));
    program.set("u_extent", extent);
    from.bind(0);
    gl::draw_screen({.blending = blending});
}

}  // namespace easypbr::render
