#include "easypbr/render/shadow/shadow_pass.h"

#include <algorithm>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/gl/context.h"

namespace easypbr::render {
namespace {

/// The items of a kind that stop light, or those that weaken it.
Casters casters_of(const MapCasters& all, const Primitive& kind, bool tints) {
    Casters casters;
    for (const DrawItem& item : all.list.of(kind.mode()))
        if (item.casts_tint() == tints && std::ranges::find(all.left_out, item.object) == all.left_out.end())
            casters.push_back(&item);
    return casters;
}

}  // namespace

void ShadowPass::draw(const ShadowView& view, const MapCasters& all, gl::Texture& maps, int layer,
                      const gl::Framebuffer& framebuffer) {
    const int resolution = maps.width();
    const bool native = native_ && gl::Context::current().info().software;
    ShadowDepths depths(depths_, resolution);
    const std::vector<Casters> left = rasterise(view, all, native, depths);
    if (depths.empty()) {
        const float nothing[4] = {no_shadow_depth, 0, 0, 0};
        framebuffer.clear_color(0, nothing);
    } else {
        const auto bits = std::as_bytes(depths_.bits());
        maps.upload(bits, 0, layer);
        transfers_.note_upload(bits.size());
    }
    if (std::ranges::all_of(left, &Casters::empty)) return;
    framebuffer.bind();
    draw_rest(view, resolution, left);
}

std::vector<Casters> ShadowPass::rasterise(const ShadowView& view, const MapCasters& all, bool native,
                                           ShadowDepths& depths) {
    std::vector<Casters> left;
    for (const auto& kind : primitives_) {
        left.push_back(casters_of(all, *kind, false));
        if (native && !left.back().empty()) kind->rasterise_shadows(view, left.back(), depths);
    }
    return left;
}

void ShadowPass::draw_rest(const ShadowView& view, int resolution, const std::vector<Casters>& left) {
    for (size_t i = 0; i < left.size(); ++i)
        if (!left[i].empty()) primitives_[i]->draw_shadows({view, resolution, false}, left[i]);
}

void ShadowPass::draw(const ShadowView& view, const MapCasters& all, int resolution, std::span<float> layer) {
    ShadowDepths depths(depths_, resolution);
    const std::vector<Casters> left = rasterise(view, all, true, depths);
    parallel_chunks(layer.size(), size_t(1) << 16, [&](size_t begin, size_t end) {
        const std::span<float> part = layer.subspan(begin, end - begin);
        if (depths.empty())
            std::ranges::fill(part, no_shadow_depth);
        else
            std::ranges::copy(std::as_bytes(depths_.bits().subspan(begin, part.size())),
                              std::as_writable_bytes(part).begin());
    });
    if (std::ranges::all_of(left, &Casters::empty)) return;

    gl::Texture map(gl::Format::r32f, resolution, resolution);
    map.upload(std::as_bytes(layer));
    transfers_.note_upload(layer.size_bytes());
    const gl::Framebuffer framebuffer({&map});
    framebuffer.bind();
    draw_rest(view, resolution, left);
    framebuffer.read(0, gl::Format::r32f, 0, 0, resolution, resolution, std::as_writable_bytes(layer));
    transfers_.note_download(layer.size_bytes());
}

void ShadowPass::draw_tints(const ShadowView& view, const MapCasters& all,
                            const gl::Framebuffer& framebuffer) {
    const float nothing[4] = {0, 0, 0, no_shadow_depth};
    framebuffer.clear_color(0, nothing);
    framebuffer.clear_color(1, nothing);
    framebuffer.bind();
    for (const auto& kind : primitives_)
        if (const Casters casters = casters_of(all, *kind, true); !casters.empty())
            kind->draw_shadows({view, framebuffer.width(), true}, casters);
}

void ShadowPass::draw_tints(const ShadowView& view, const MapCasters& all, TintLayer& layer) {
    for (const auto& kind : primitives_)
        if (const Casters casters = casters_of(all, *kind, true); !casters.empty())
            kind->rasterise_tints(view, casters, layer);
}

}  // namespace easypbr::render
