#include "easypbr/render/primitives/splats/splat_hits.h"

#include "easypbr/core/color.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/primitives/splats/splat_color.h"

namespace easypbr::render {

SplatHits::Shown SplatHits::shown(Eigen::Index splat, const Vec3& normal) const {
    if (are_lit_ && parts_) {
        const Vec3 light = parts_->lit(*light_.light(), item_, splat, normal.cast<double>());
        return {light, light};
    }
    Vec3 color = splat_color(item_, splat, -normal);
    if (parts_) color = parts_->darkened(*light_.light(), item_, splat, normal.cast<double>(), color);
    color = linear_from_srgb(color);
    return {color, inverse_tone_map(color, tone_)};
}

void SplatHits::shade(std::span<const native::ElementHit> hits, const native::HitSurfaces& to) const {
    for (size_t i = 0; i < hits.size(); ++i) {
        const Vec3 normal = Eigen::Map<const Vec3>(hits[i].normal);
        const auto [albedo, emission] = shown(Eigen::Index(hits[i].element), normal);
        for (int c = 0; c < 3; ++c) {
            to.normal[c][i] = to.face[c][i] = normal[c];
            to.albedo[c][i] = albedo[c];
            to.emission[c][i] = emission[c];
        }
        to.parameters[0][i] = 0;
        to.parameters[1][i] = 1;
        to.kind[i] = code_of(SurfaceKind::unlit);
    }
}

}  // namespace easypbr::render
