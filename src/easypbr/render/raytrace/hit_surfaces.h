// Surfaces that rays have met, with an array for each number.
#pragma once

#include <cstdint>
#include <numeric>
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

/// The numbers of `count` hits, those of a surface together, in order within it; `surface_of`:
/// RayHit::surface.
template <class SurfaceOf>
std::vector<uint32_t> sorted_by_surface(size_t count, SurfaceOf&& surface_of) {
    const auto place_of = [&](size_t i) { return size_t(int64_t(surface_of(i)) + 1); };
    std::vector<uint32_t> begins;
    for (size_t i = 0; i < count; ++i) {
        const size_t after = place_of(i) + 1;
        if (begins.size() <= after) begins.resize(after + 1);
        ++begins[after];
    }
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<uint32_t> sorted(count);
    for (size_t i = 0; i < count; ++i) sorted[begins[place_of(i)]++] = uint32_t(i);
    return sorted;
}

/// Evaluates the surfaces of hits, which are sorted by RayHit::surface; `surfaces` holds that of each.
HitSurfaces evaluate(const RayScene& scene, std::span<const native::ElementHit> hits,
                     std::span<const int> surfaces);

/// The radiance that one surface without extensions shines with.
Vec3 emission_at(const RayScene& scene, const RayHit& hit);

}  // namespace easypbr::render
