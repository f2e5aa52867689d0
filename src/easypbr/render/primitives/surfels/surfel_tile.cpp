#include "easypbr/render/primitives/surfels/surfel_tile.h"

#include "easypbr/core/color.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {

void SurfelTile::place(Vec2i frame, Vec2i tile) {
    left = tile.x() * size;
    top = tile.y() * size;
    right = std::min(left + size, frame.x());
    bottom = std::min(top + size, frame.y());
}

void SurfelTile::project(const std::vector<SurfelSource>& sources, std::span<const uint64_t> entries,
                         std::span<const std::vector<SurfelProjection>> kept) {
    const auto prefetch = [&](uint64_t entry) {
        const size_t source = source_of(entry);
        if (kept.empty()) return sources[source].projector.prefetch(surfel_of(entry));
        const auto* const from = reinterpret_cast<const char*>(&kept[source][surfel_of(entry)]);
        __builtin_prefetch(from);
        __builtin_prefetch(from + sizeof(SurfelProjection) - 1);
    };
    projections.clear();
    for (size_t k = 0; k < entries.size(); ++k) {
        if (k + ahead < entries.size()) prefetch(entries[k + ahead]);
        const size_t source = source_of(entries[k]), surfel = surfel_of(entries[k]);
        projections.push_back(kept.empty() ? *sources[source].projector.project(surfel)
                                           : kept[source][surfel]);
    }
}

std::array<float, SurfelTile::channels> SurfelTile::values_of(const SurfelSource& source, size_t surfel,
                                                              const SurfelProjection& s) {
    const DrawItem& item = *source.item;
    const size_t vertex = source.projector.vertex_of(surfel);
    const Material& m = item.material;
    Vec3 albedo = m.base_color;
    if (item.with_colors)
        albedo = albedo.cwiseProduct(linear_from_srgb(item.mesh().C.row(Eigen::Index(vertex)).head<3>()));
    const Vec3 n = Eigen::Map<const Vec3>(s.normal).normalized();
    return {albedo.x(),
            albedo.y(),
            albedo.z(),
            n.x(),
            n.y(),
            n.z(),
            m.metallic,
            m.roughness,
            0,
            1,
            vertex_alpha(item, vertex)};
}

SurfacePixel SurfelTile::mean(const Frame& frame, const DrawItem& item, size_t i) const {
    const auto& sum = sums[i];
    const double scale = 1.0 / double(sum[weight]);
    const auto of = [&](Channel c) { return float(double(sum[c]) * scale); };
    SurfacePixel pixel;
    pixel.albedo = Vec3(of(red), of(green), of(blue));
    pixel.normal = Vec3(of(normal_x), of(normal_y), of(normal_z)).normalized();
    pixel.metallic = of(metallic);
    pixel.roughness = of(roughness);
    if (item.alpha == AlphaMode::blend) pixel.alpha = of(opacity);
    pixel.kind = item.kind;
    pixel.depth = reversed_depth(frame, limit[i] * (1 - of(distance)));
    pixel.object = uint32_t(item.object - frame.scene->objects.data());
    pixel.is_point = true;
    return pixel;
}

}  // namespace easypbr::render
