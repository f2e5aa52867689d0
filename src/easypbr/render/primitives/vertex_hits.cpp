#include "easypbr/render/primitives/vertex_hits.h"

#include <algorithm>

#include "easypbr/core/color.h"

namespace easypbr::render {
namespace {

Vec3 color_of_vertex(const DrawItem& item, uint32_t vertex) {
    const ArrayXf& C = item.mesh().C;
    if (!item.with_colors || C.empty()) return Vec3::Ones();
    const auto row = std::min<Eigen::Index>(Eigen::Index(vertex), C.rows() - 1);
    return linear_from_srgb(Vec3(C.row(row).head<3>().transpose().cwiseMax(0.0f).cwiseMin(1.0f)));
}

void put(float* const (&to)[3], size_t at, const Vec3& v) {
    for (int i = 0; i < 3; ++i) to[i][at] = v[i];
}

}  // namespace

void VertexHits::shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& to) const {
    const Material& material = item_.material;
    const SurfaceKind kind = material.unlit ? SurfaceKind::unlit : item_.kind;
    for (size_t i = 0; i < hits.size(); ++i) {
        const Vec3 color = material.base_color.cwiseProduct(color_of_vertex(item_, hits[i].element));
        const Vec3 normal = Eigen::Map<const Vec3>(hits[i].normal);
        put(to.normal, i, normal);
        put(to.face, i, normal);
        put(to.albedo, i, color);
        put(to.emission, i, material.unlit ? color : material.emissive);
        to.parameters[0][i] = material.metallic;
        to.parameters[1][i] = material.roughness;
        to.kind[i] = code_of(kind);
    }
}

}  // namespace easypbr::render
