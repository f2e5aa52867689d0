#include "easypbr/render/primitives/splats/splat_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace easypbr::render {
namespace {

constexpr int tint_tile = SplatTiles::tile_size;
/// Standard deviations beyond which a splat stops next to nothing.
constexpr double deviations = 3;

/// What the splats of a tile take from light.
struct TileTints {
    struct Texel {
        float absorption = 0, moment = 0, first = no_shadow_depth, last = no_shadow_depth;
    };
    std::array<Texel, size_t(tint_tile) * tint_tile> texels{};
    int left, top;

    void add(const ProjectedSplat& splat);
};

/// First and one past the last texel of a tile whose centres lie within a reach.
std::array<int, 2> span_of(float centre, float reach, int first) {
    const auto inside = [&](float texel) {
        return int(std::clamp(texel - float(first), 0.0f, float(tint_tile)));
    };
    return {inside(std::ceil(centre - reach - 0.5f)), inside(std::floor(centre + reach - 0.5f) + 1)};
}

void TileTints::add(const ProjectedSplat& splat) {
    const auto [x0, x1] = span_of(splat.x, splat.half_width, left);
    const auto [y0, y1] = span_of(splat.y, splat.half_height, top);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float dx = float(left + x) + 0.5f - splat.x, dy = float(top + y) + 0.5f - splat.y;
            const float power = 0.5f * (splat.xx * dx * dx + splat.yy * dy * dy) + splat.xy * dx * dy;
            const float alpha = std::min(splat.opacity * std::exp(-power), most_splat_alpha);
            if (alpha < least_splat_alpha) continue;
            const float absorbed = -std::log1p(-alpha);
            const float depth = splat.depth + splat.depth_x * dx + splat.depth_y * dy;
            Texel& texel = texels[size_t(y) * tint_tile + size_t(x)];
            texel.absorption += absorbed;
            texel.moment += absorbed * depth;
            texel.first = std::max(texel.first, depth);
            texel.last = std::max(texel.last, -depth);
        }
}

/// The 99th percentile of the longest axes, in the mesh's units: a few are far larger than all others.
double usual_length(const MeshData& mesh) {
    std::vector<float> lengths(size_t(mesh.V.rows()));
    for (size_t i = 0; i < lengths.size(); ++i)
        lengths[i] = mesh.splats.scales.row(Eigen::Index(i)).maxCoeff();
    if (lengths.empty()) return 0;
    const auto place = lengths.begin() + std::ptrdiff_t((lengths.size() - 1) * 99 / 100);
    std::ranges::nth_element(lengths, place);
    return double(*place);
}

}  // namespace

double SplatShadows::reach(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    return deviations * item.object->T_world_mesh.linear().colwise().norm().maxCoeff() *
           reaches_.get(mesh.splats.scales.revision(), [&] { return usual_length(mesh); });
}

void SplatShadows::rasterise(const ShadowView& view, const Casters& casters, TintLayer& layer) {
    const int resolution = layer.resolution();
    set_.begin(view_of(view, resolution), casters);
    set_.for_each_tile([&](int column, int row, std::span<const uint32_t> places) {
        TileTints tile{.left = column * tint_tile, .top = row * tint_tile};
        for (const uint32_t place : places) tile.add(set_.splats()[place]);
        const int width = std::min(tint_tile, resolution - tile.left),
                  height = std::min(tint_tile, resolution - tile.top);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const TileTints::Texel& texel = tile.texels[size_t(y) * tint_tile + size_t(x)];
                layer.add(size_t(tile.top + y) * size_t(resolution) + size_t(tile.left + x),
                          {.absorption = Vec3::Constant(texel.absorption),
                           .moment = Vec3::Constant(texel.moment),
                           .first = texel.first,
                           .last = -texel.last});
            }
    });
}

void SplatShadows::draw(const ShadowLayer& layer, const Casters& casters) {
    const Vec2i size(layer.resolution, layer.resolution);
    for (Target* target : {&absorption_, &moment_}) {
        if (target->size() != size) *target = Target(gl::Format::rgba32f, size);
        target->write(target->whole());
    }
    TintLayer tints(absorption_.pixels<float>(), moment_.pixels<float>(), layer.resolution, no_shadow_depth);
    rasterise(layer.view, casters, tints);
    Transfers transfers;
    absorption_.upload(transfers);
    moment_.upload(transfers);
    const gl::Program& program = programs_.get({});
    program.use();
    program.set("u_absorption", 0);
    program.set("u_moment", 1);
    absorption_.bind(0);
    moment_.bind(1);
    gl::draw_screen(layer.state());
}

}  // namespace easypbr::render
