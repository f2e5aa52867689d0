#include "easypbr/render/effects/bloom/bloom_pass.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace easypbr::render {
namespace {

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

void BloomPass::make_levels(Vec2i size, int count) {
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

void BloomPass::draw(const Frame& frame, const gl::Texture& radiance) {
    make_levels(frame.size, frame.resolved->bloom_levels);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    gather(frame, radiance);
    const size_t count = levels_.size();
    for (size_t i = 1; i < count; ++i)
        resample(levels_[i - 1].light, levels_[i - 1].extent, levels_[i].lit, "DOWN");
    // Upwards each level becomes the mean of itself and the levels below, all counting alike.
    for (size_t i = count; i-- > 0;) {
        resample(levels_[i].light, levels_[i].extent, levels_[i].glowing, "SAME");
        if (i + 1 == count) continue;
        const float own = 1 / float(count - i);
        glEnable(GL_BLEND);
        glBlendColor(own, own, own, own);
        glBlendFunc(GL_ONE_MINUS_CONSTANT_COLOR, GL_CONSTANT_COLOR);
        resample(levels_[i + 1].glow, levels_[i + 1].extent, levels_[i].glowing, "UP");
        glDisable(GL_BLEND);
    }
    glBlendFunc(GL_ONE, GL_ZERO);
}

void BloomPass::gather(const Frame& frame, const gl::Texture& radiance) {
    const Level& first = levels_.front();
    const float black[4] = {0, 0, 0, 0};
    first.lit.clear_color(0, black);
    const PixelRect area = lit_texels(frame, first.light);
    glEnable(GL_SCISSOR_TEST);
    // A texel lies between the block of its own index and the next.
    glScissor(area.x, area.y, area.width + 1, area.height + 1);
    std::vector<std::string> defines = {"BLOCKS"};
    if (frame.resolved->suppress_fireflies) defines.emplace_back("SUPPRESS_FIREFLIES");
    const gl::Program& blocks = gather_.get(defines);
    summed_.bind();
    blocks.use();
    set_bloom_uniforms(blocks, frame);
    blocks.set("u_size", Vec2(frame.size.cast<float>()));
    blocks.set("u_radiance", 0);
    radiance.bind(0);
    draw_screen_triangle();
    glScissor(area.x, area.y, area.width, area.height);
    const gl::Program& texels = gather_.get({});
    first.lit.bind();
    texels.use();
    const char* samplers[] = {"u_rise_rise", "u_fall_rise", "u_rise_fall", "u_fall_fall"};
    for (unsigned i = 0; i < 4; ++i) {
        sums_[i].bind(i);
        texels.set(samplers[i], int(i));
    }
    draw_screen_triangle();
    glDisable(GL_SCISSOR_TEST);
}

void BloomPass::resample(const gl::Texture& from, const Vec2& extent, const gl::Framebuffer& to,
                         const char* step) {
    const gl::Program& program = resample_.get({step});
    to.bind();
    program.use();
    program.set("u_source", 0);
    program.set("u_source_size", Vec2(float(from.width()), float(from.height())));
    program.set("u_extent", extent);
    from.bind(0);
    draw_screen_triangle();
}

}  // namespace easypbr::render
