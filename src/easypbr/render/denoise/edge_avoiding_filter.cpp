#include "easypbr/render/denoise/edge_avoiding_filter.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/luminance.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

/// So that what a surface's colour hides is not divided by nothing.
constexpr float least_reflectance = 0.001f;

/// Takes the surfaces' own colours, which may be those of fine textures, out of their light, or puts them
/// back.
void change_colors(const Target& light, const Target& color, bool out) {
    const auto pixels = light.pixels<Vec4>(), colors = color.pixels<Vec4>();
    parallel_for(pixels.size(), size_t(1) << 14, [&](size_t i) {
        const Vec4& sum = colors[i];
        if (!(sum.w() > 0)) return;
        const Vec3 reflectance = (sum.head<3>() / sum.w()).cwiseMax(least_reflectance);
        const float of_luminance = luminance(reflectance);
        const Vec3 light_rgb = pixels[i].head<3>();
        pixels[i].head<3>() =
            out ? Vec3(light_rgb.cwiseQuotient(reflectance)) : Vec3(light_rgb.cwiseProduct(reflectance));
        if (out) pixels[i].w() /= of_luminance * of_luminance;
    });
}

}  // namespace

const Target& EdgeAvoidingFilter::smooth(const NoisyLight& noisy, Transfers& transfers) {
    const Target *from = &noisy.light, *to = &noisy.scratch;
    const PixelRect whole = from->whole();
    change_colors(*from, noisy.color, true);
    for (Target* own : {&guides_, &estimate_})
        if (own->size() != from->size()) *own = Target(gl::Format::rgba32f, from->size());
    guides_.write(whole);
    ShaderInputs sums;
    sums.set("u_surface", noisy.surface);
    sums.set("u_reflectance", noisy.color);
    guiding_.shade(sums, {.target = &guides_, .area = whole}, transfers);
    if (noisy.is_last) noisy.surface.release();
    estimate_.write(whole);
    const auto inputs = [&] {
        ShaderInputs values;
        values.set("u_light", *from);
        values.set("u_guides", guides_);
        values.set("u_size", Vec2(from->size().cast<float>()));
        return values;
    };
    estimating_.shade(inputs(), {.target = &estimate_, .area = whole}, transfers);
    for (int level = 0; level < levels; ++level) {
        to->write(whole);
        ShaderInputs values = inputs();
        if (level == 0) values.define("ESTIMATED");
        if (level == 0) values.set("u_estimate", estimate_);
        values.set("u_step", 1 << level);
        smooth_.shade(values, {.target = to, .area = whole}, transfers);
        estimate_.release();
        std::swap(from, to);
    }
    guides_.release();
    change_colors(*from, noisy.color, false);
    return *from;
}

}  // namespace easypbr::render
