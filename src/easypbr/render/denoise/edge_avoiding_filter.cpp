#include "easypbr/render/denoise/edge_avoiding_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "easypbr/core/luminance.h"

namespace easypbr::render {
namespace {

/// Rows whose estimates are held at once.
constexpr int band_rows = 64;

/// So that what a surface's colour hides is not divided by nothing.
constexpr float least_reflectance = 0.001f;

/// Takes the surfaces' own colours, which may be those of fine textures, and the exposure out of their light,
/// or puts them back.
void change_colors(const Target& light, const NoisyLight& noisy, bool out) {
    const auto pixels = light.pixels<Vec4>();
    noisy.each([&](size_t i, const SurfaceMean& surface, Noisy of) {
        if (surface.frames == 0) return;
        const Vec3 color = noisy.reflectance(surface).cwiseMax(least_reflectance) *
                           (of == Noisy::radiance ? noisy.white : 1.0f);
        const float of_luminance = luminance(color);
        const Vec3 light_rgb = pixels[i].head<3>();
        pixels[i].head<3>() =
            out ? Vec3(light_rgb.cwiseQuotient(color)) : Vec3(light_rgb.cwiseProduct(color));
        if (out) pixels[i].w() = pixels[i].w() / of_luminance / of_luminance;
    });
}

/// Of each part of a tile that has one sum of the hue's squares: the variance of the light's red and blue in
/// parts of that of its luminance, over the reflectance each: 1 of noise without a hue.
using HueNoise = std::array<float, native::NoisyTile::pixels / native::NoisyTile::hue_rows>;

HueNoise hue_noise(const native::NoisyTile& tile) {
    // Less than what sums of floats are rounded by is no noise, by the square of the mean. The filter takes
    // noise from around: what hue that has is not known here, and a bounce off a wall may have much.
    constexpr float rounding = 1e-5f, unknown = 8, least = 0.25f, most = 1e4f;
    HueNoise of_hue{}, of_luminance{}, bright{};
    std::ranges::copy(tile.hue_squares, of_hue.begin());
    for (int place = 0; place < native::NoisyTile::pixels; ++place) {
        const NoisyPixel pixel = noisy_pixel_at(tile, size_t(place));
        if (pixel.frames == 0) continue;
        const Vec3 color =
            noisy_surface_at(tile, size_t(place)).mean_reflectance().cwiseMax(least_reflectance);
        const auto part = size_t(native::NoisyTile::hue_place(place));
        const auto of_hue_in = [](const Vec3& c) { return c.x() * c.x() + c.z() * c.z(); };
        // What noise without a hue would have, of light that the surface colours.
        const float colored = of_hue_in(color) / std::pow(luminance(color), 2.0f),
                    count = float(pixel.frames);
        // Of one frame the squares are all that is known.
        const float known = pixel.frames > 1 ? 1 / count : 0;
        const float of_mean = std::pow(luminance(pixel.light), 2.0f);
        of_hue[part] -= known * of_hue_in(pixel.light);
        of_luminance[part] += colored * (pixel.squares - known * of_mean);
        bright[part] += colored * of_mean / count;
    }
    for (size_t part = 0; part < of_hue.size(); ++part)
        of_hue[part] = of_luminance[part] <= rounding * bright[part]
                           ? unknown
                           : std::clamp(of_hue[part] / of_luminance[part], least, most);
    return of_hue;
}

/// Numbers from 0 to 1 in eight bits each, as unpackUnorm4x8() of GLSL reads them from a float's bits.
float packed(const Vec3& values) {
    uint32_t bits = 0;
    for (int i = 0; i < 3; ++i) bits |= uint32_t(std::lrint(values[i] * 255)) << (8 * i);
    return std::bit_cast<float>(bits);
}

}  // namespace

void EdgeAvoidingFilter::write_guides(const NoisyLight& noisy) {
    guides_.write(guides_.whole());
    const auto to = guides_.pixels<Vec4>();
    const TileGrid& grid = noisy.pixels.grid();
    std::vector<HueNoise> hues(grid.count());
    parallel_for(hues.size(), 64, [&](size_t tile) {
        if (const native::NoisyTile* of = noisy.pixels.of(tile); of && !noisy.is_white)
            hues[tile] = hue_noise(*of);
        else
            hues[tile].fill(1);
    });
    const auto width = size_t(grid.size().x());
    noisy.each([&](size_t i, const SurfaceMean& surface, Noisy /*of*/) {
        const int x = int(i % width), y = int(i / width);
        const int part = native::NoisyTile::hue_place(int(TileGrid::place_of(x, y)));
        to[i] = Vec4(packed(SurfaceMean::values(surface.normal)), packed(noisy.reflectance(surface)),
                     surface.depth, surface.frames > 0 ? hues[grid.tile_at(x, y)][size_t(part)] : 0.0f);
    });
}

const Target& EdgeAvoidingFilter::smooth(const NoisyLight& noisy, Transfers& transfers) {
    const Target *from = &noisy.light, *to = &noisy.scratch;
    const PixelRect whole = from->whole();
    change_colors(*from, noisy, true);
    for (Target* own : {&guides_, &estimate_, &estimated_hue_})
        if (own->size() != from->size()) *own = Target(gl::Format::rgba32f, from->size());
    write_guides(noisy);
    const auto inputs = [&] {
        ShaderInputs values;
        values.set("u_light", *from);
        values.set("u_guides", guides_);
        values.set("u_size", Vec2(from->size().cast<float>()));
        return values;
    };
    to->write(whole);
    for (int y = 0; y < whole.height; y += band_rows) {
        const int end = std::min(y + band_rows, whole.height), first = std::max(0, y - first_reach),
                  last = std::min(end + first_reach, whole.height);
        const PixelRect estimated{0, first, whole.width, last - first};
        estimate_.write(estimated);
        estimated_hue_.write(estimated);
        estimating_.shade(inputs(), {.target = &estimate_, .area = estimated, .further = {&estimated_hue_}},
                          transfers);
        ShaderInputs values = inputs();
        values.define("ESTIMATED");
        values.set("u_estimate", estimate_);
        values.set("u_estimated_hue", estimated_hue_);
        values.set("u_step", 1);
        smooth_.shade(values, {.target = to, .area = {0, y, whole.width, end - y}}, transfers);
    }
    estimate_.release();
    estimated_hue_.release();
    for (int level = 1; level < levels; ++level) {
        std::swap(from, to);
        to->write(whole);
        ShaderInputs values = inputs();
        values.set("u_step", 1 << level);
        smooth_.shade(values, {.target = to, .area = whole}, transfers);
    }
    guides_.release();
    change_colors(*to, noisy, false);
    return *to;
}

}  // namespace easypbr::render
