// What a surface is made of where a ray meets it.
#pragma once

#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

struct RayHit;

/// Part of an element that there is, whatever it is made of: 1 for opaque ones, 0 in the holes of masked
/// ones, and the opacity of blended ones. Of faces at barycentric coordinates.
float coverage_at(const DrawItem& item, int element, float u, float v);
/// What an element leaves of light that passes it straight; its material is that of the factors alone.
Vec3 transmittance_at(const DrawItem& item, int element, float u, float v);
/// Part of a ray that an element stops: 1 for opaque ones, 0 in the holes of masked ones, and for others what
/// they take from light. Of faces at barycentric coordinates; of others by their material.
float opacity_at(const DrawItem& item, int element, float u, float v);

/// glTF's core model.
struct RaySurface {
    Vec3 diffuse{0, 0, 0};   ///< albedo of the base
    Vec3 f0{0, 0, 0};        ///< reflectance at normal incidence
    Vec3 emission{0, 0, 0};  ///< radiance
    Vec3 normal{0, 0, 1};    ///< unit, interpolated between vertices, towards where the ray came from
    float roughness = 1;
};

/// Textures are read at their nearest texel; normal maps do not count.
RaySurface surface_at(const RayHit& hit, float dielectric_f0);

}  // namespace easypbr::render
