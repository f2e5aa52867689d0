#include "easypbr/render/transparency/layer_guides.h"

#include <array>
#include <cmath>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/render/frame/held_pixels.h"
#include "easypbr/render/frame/surface_kind.h"

namespace easypbr::render {
namespace {

using Albedo = std::array<uint16_t, 4>;
using Material = std::array<uint8_t, 4>;
constexpr float whole_opacity = 65535;

template <class Channels>
void blend(const Channels& from, float opacity, size_t channels, Channels& to) {
    for (size_t i = 0; i < channels; ++i)
        to[i] = typename Channels::value_type(
            std::lround(float(from[i]) * opacity + float(to[i]) * (1 - opacity)));
}

/// The pixels of surfaces in host memory.
struct HeldSurfaces {
    explicit HeldSurfaces(const GBuffer& targets)
        : albedo(targets.albedo), normal(targets.normal), material(targets.material), depth(targets.depth) {}

    HeldPixels<Albedo> albedo;
    HeldPixels<uint32_t> normal;
    HeldPixels<Material> material;
    HeldPixels<float> depth;
};

/// A pixel of a layer over what is behind it.
void add_pixel(const HeldSurfaces& from, const HeldSurfaces& to, int x, int y, bool over_nothing) {
    const Albedo& albedo = *from.albedo.at(x, y);
    const Material& material = *from.material.at(x, y);
    const float nearer = *from.depth.at(x, y), opacity = float(albedo[3]) / whole_opacity;
    float* depth = to.depth.at(x, y);
    if (!(nearer > 0) || !depth || !is_lit_by_scene(material[3])) return;
    Albedo& blended = *to.albedo.at(x, y);
    const uint8_t behind = (*to.material.at(x, y))[3];
    const bool is_first = !(*depth > 0) || !is_lit_by_scene(behind);
    // What shows its own colour is an overlay, and the radiance in front of it is the layer's alone.
    const bool is_alone = is_first && *depth > 0 && is_display(SurfaceKind(behind));
    const bool is_over_nothing =
        over_nothing && (!(*depth > 0) || behind == uint8_t(SurfaceKind::ground_catcher));
    if (is_first) blended = {65535, 65535, 65535, uint16_t(is_over_nothing ? 0 : 65535)};
    const float covered = float(blended[3]) / whole_opacity, covers = opacity + covered * (1 - opacity);
    // Light is divided by the coverage too, so that colours are those of what covers.
    const float part = is_alone || !(covers > 0) ? 1.0f : opacity / covers;
    if (is_first || opacity >= 0.5f) {
        *depth = nearer;
        *to.normal.at(x, y) = *from.normal.at(x, y);
    }
    blend(albedo, part, 3, blended);
    blended[3] = uint16_t(std::lround(covers * whole_opacity));
    blend(material, is_first ? 1 : part, 2, *to.material.at(x, y));
    if (is_first) (*to.material.at(x, y))[3] = material[3];
}

}  // namespace

void LayerGuides::begin(const GBuffer& targets, bool over_nothing, Transfers& transfers) {
    over_nothing_ = over_nothing;
    if (guides_.size() != targets.size()) guides_ = GBuffer(targets.size());
    guides_.write(targets.depth.whole(), {});
    const auto copy = [&](const Target& from, const Target& to) {
        from.download(from.whole(), transfers);
        const PixelRect& area = from.area();
        std::ranges::fill(to.pixels<std::byte>(), std::byte{0});
        const size_t pixel = gl::pixel_bytes(from.format()), row = size_t(area.width) * pixel;
        const auto source = from.pixels<std::byte>(), target = to.pixels<std::byte>();
        for (int y = 0; y < area.height; ++y)
            std::ranges::copy(
                source.subspan(size_t(y) * row, row),
                target.begin() +
                    ptrdiff_t((size_t(area.y + y) * size_t(to.width()) + size_t(area.x)) * pixel));
    };
    copy(targets.albedo, guides_.albedo);
    copy(targets.normal, guides_.normal);
    copy(targets.material, guides_.material);
    copy(targets.depth, guides_.depth);
    for (Albedo& albedo : guides_.albedo.pixels<Albedo>()) albedo[3] = uint16_t(whole_opacity);
}

void LayerGuides::add(const GBuffer& layer) {
    const HeldSurfaces from(layer), to(guides_);
    const PixelRect area = layer.depth.area();
    parallel_for(size_t(area.height), 16, [&](size_t row) {
        const int y = area.y + int(row);
        for (int x = area.x; x < area.x + area.width; ++x) add_pixel(from, to, x, y, over_nothing_);
    });
}

}  // namespace easypbr::render
