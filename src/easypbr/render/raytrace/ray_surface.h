// What a surface is made of where a ray meets it.
#pragma once

#include <algorithm>

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

struct RayHit;

/// Light goes through faces of less roughness as it comes: is_clear() of shaders/path_extended.glsl.
inline constexpr float least_roughness = 0.045f;
/// What roughness does to light that passes a face between media of this ratio of their indices of
/// refraction, whichever is denser: facets turn nothing without it. 0 stands for no refraction.
inline float transmitted_roughness(float roughness, float relative) {
    if (!(relative > 0)) return 0;
    return roughness * std::clamp(2 * std::max(relative, 1 / relative) - 2, 0.0f, 1.0f);
}

/// Part of an element that there is, whatever it is made of: 1 for opaque ones, 0 in the holes of masked
/// ones, and the opacity of blended ones. Of faces at barycentric coordinates.
float coverage_at(const DrawItem& item, int element, float u, float v);
/// How a face or another element lets light through that passes it straight.
struct Passage {
    float coverage = 1;   ///< coverage_at()
    float f0 = 0;         ///< reflectance at normal incidence, of the colour that is reflected most
    float f90 = 0;        ///< reflectance at grazing angles
    Vec3 tint{0, 0, 0};   ///< of its colours, once for a thin surface and once for both faces of a volume
    float thickness = 0;  ///< of the volume below it, world units; 0: thin
    float roughness = 0;  ///< transmitted_roughness()

    /// The tint of one face.
    Vec3 color() const { return thickness > 0 ? Vec3(tint.cwiseSqrt()) : tint; }
    /// What one face does not reflect of light at this cosine to its normal (Schlick 1994).
    float entering(float cosine) const {
        const float c = 1 - std::min(std::abs(cosine), 1.0f);
        return 1 - (f0 + (f90 - f0) * (c * c) * (c * c) * c);
    }
    /// What one face leaves of light at this cosine to its normal but for what a volume absorbs.
    Vec3 left(float cosine) const {
        return Vec3::Constant(1 - coverage) + coverage * entering(cosine) * color();
    }
    /// Nothing passes of a roughness or more.
    void stop_from(float stopping) {
        if (roughness < stopping) return;
        tint.setZero();
        thickness = 0;
    }
};
Passage passage_at(const DrawItem& item, int element, float u, float v);
/// Part of a ray that an element stops: 1 for opaque ones, 0 in the holes of masked ones, and for others what
/// they take from light, each face of a volume by half of its thickness, or of an open mesh by the whole. Of
/// faces at barycentric coordinates, met at this cosine to their normal; of others by their material.
float opacity_at(const DrawItem& item, int element, float u, float v, float cosine, bool is_open);

/// glTF's core model.
struct RaySurface {
    Vec3 diffuse{0, 0, 0};   ///< albedo of the base
    Vec3 f0{0, 0, 0};        ///< reflectance at normal incidence
    Vec3 emission{0, 0, 0};  ///< radiance
    Vec3 normal{0, 0, 1};    ///< unit, interpolated between vertices, towards where the ray came from
    float roughness = 1;
};

/// Radiance that the picture shows as 1, where it shows any.
inline float shown_as_one(float exposure) {
    return exposure > 0 ? 1 / exposure : 1.0f;
}

/// Textures are read at their nearest texel; normal maps do not count. `exposure`: of the picture, in which
/// what is shown past the light has the colour that it has.
RaySurface surface_at(const RayHit& hit, float dielectric_f0, float exposure);

}  // namespace easypbr::render
