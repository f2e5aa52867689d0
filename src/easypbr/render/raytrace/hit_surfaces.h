// Surfaces that rays have met, with an array for each number.
#pragma once

#include <span>
#include <vector>

#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr::render {

/// The part of its length by which a ray widens, of directions that a matt surface sends: textures are read
/// that much blurred.
inline constexpr float ray_widening = 0.05f;

struct HitSurfaces {
    HitSurfaces(size_t count, bool with_extensions);
    /// The arrays from one of them on.
    native::HitSurfaces from(size_t first);

    PathVectors<3> normal, face, albedo, emission;
    PathVectors<2> parameters;                 ///< metallic, roughness
    std::vector<float> kind;                   ///< code of the surface's
    std::optional<PathExtensions> extensions;  ///< of those whose kind is extended
};

/// `footprint`: width of the ray there, world units.
native::ElementHit native_hit(const RayHit& hit, float footprint);

/// Evaluates the surfaces of hits, which are sorted by RayHit::surface; `surfaces` holds that of each.
HitSurfaces evaluate(const RayScene& scene, std::span<const native::ElementHit> hits,
                     std::span<const int> surfaces);

/// The radiance that one surface without extensions shines with.
Vec3 emission_at(const RayScene& scene, const RayHit& hit);

}  // namespace easypbr::render
