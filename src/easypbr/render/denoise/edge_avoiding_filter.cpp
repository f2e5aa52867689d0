#include "easypbr/render/denoise/edge_avoiding_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "easypbr/core/luminance.h"

namespace easypbr::render {
namespace {

/// Rows whose estimates are held at once.
constexpr int band_rows = 128;

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
    noisy.each([&](size_t i, const SurfaceMean& surface, Noisy /*of*/) {
        to[i] = Vec4(packed(SurfaceMean::values(surface.normal)), packed(noisy.reflectance(surface)),
                     surface.depth, float(surface.frames));
    });
}

const Target& EdgeAvoidingFilter::smooth(const NoisyLight& noisy, Transfers& transfers) {
    const Target *from = &noisy.light, *to = &noisy.scratch;
    const PixelRect whole = from->whole();
    change_colors(*from, noisy, true);
    for (Target* own : {&guides_, &estimate_})
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
        estimating_.shade(inputs(), {.target = &estimate_, .area = estimated}, transfers);
        ShaderInputs values = inputs();
        values.define("ESTIMATED");
        values.set("u_estimate", estimate_);
        values.set("u_step", 1);
        smooth_.shade(values, {.target = to, .area = {0, y, whole.width, end - y}}, transfers);
    }
    estimate_.release();
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
