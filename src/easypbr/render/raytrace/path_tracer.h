// Path tracing from surfaces that are known.
#pragma once

#include <memory>
#include <vector>

#include "easypbr/render/raytrace/emitters.h"
#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/path_lights.h"
#include "easypbr/render/raytrace/sky_sampler.h"

namespace easypbr::render {

/// Light that reaches a surface that catches shadows, and what would reach it if nothing stood there:
/// luminances.
struct CaughtLight {
    float arrives = 0, all = 0;
};

/// Estimates the radiance that surfaces send back along paths: lights, emissive surfaces and the sky by
/// next-event estimation at each surface, and what directions find that are sampled by the BSDF. The sky and
/// emissive surfaces are found both ways, combined by MIS (Veach and Guibas 1995). Materials are evaluated by
/// shaders/path_surface.glsl, the text that the raster frame lights surfaces by. Of surfaces behind the
/// first, the core model counts.
class PathTracer {
  public:
    /// The settings and the scene must outlive the calls of the others.
    void prepare(const ResolvedSettings& resolved, const RayScene& scene);

    /// Adds the radiance of each path to its place in `radiance`. The batch is used up.
    void trace(PathBatch& batch, std::vector<Vec3>& radiance) const;
    /// The light of surfaces that catch shadows, from lights and sky alone, added by the paths' places.
    void trace_caught(const PathBatch& batch, std::vector<CaughtLight>& light) const;

    /// Where rays start that leave the place of a path: back along the path too, so that it is on the right
    /// side of other surfaces that meet this one there.
    Vec3 start_of(const PathBatch& batch, size_t path) const;

  private:
    struct Scattered;
    struct Found;
    void scatter(const PathBatch& batch, uint32_t depth, bool caught, Scattered& to) const;
    /// Chooses the direction of next-event estimation for each path: to the sky, or to an emissive surface.
    void choose_directions(const PathBatch& batch, uint32_t depth, bool caught, Scattered& to) const;
    void add_direct(const PathBatch& batch, uint32_t depth, const std::vector<ChosenLight>& lamps,
                    const Scattered& scattered, std::vector<Vec3>& radiance) const;
    /// Follows the paths to the next surface: what they found there is in `found`.
    void follow(PathBatch& batch, uint32_t depth, const Scattered& scattered, Found& found,
                std::vector<Vec3>& radiance) const;
    /// The batch becomes the paths that go on from what they found.
    void arrive(PathBatch& batch, uint32_t depth, Found& found, std::vector<Vec3>& radiance) const;
    /// Part of what a surface emits that a path adds which has met it in a sampled direction.
    float emission_weight(const RayHit& hit, const Vec3& direction, float density) const;
    /// What the sky adds to a path that left a surface in a sampled direction; `sky_part` of the directions
    /// of next-event estimation are those of the sky.
    Vec3 escaped(const Vec3& direction, float density, float sky_part) const;
    /// What a ground that catches shadows shows of the sky behind it.
    Vec3 caught_sky(const RayHit& hit, const Vec3& direction, const Vec2& u) const;
    Vec3 limited(const Vec3& light, uint32_t depth) const;

    const ResolvedSettings* resolved_ = nullptr;
    const RayScene* scene_ = nullptr;
    PathLights lights_;
    SkySampler sky_;
    Emitters emitters_;
    float emitter_part_ = 0;  ///< of the directions of next-event estimation; the others are those of the sky
    std::shared_ptr<const void> uniforms_, of_catcher_;
};

}  // namespace easypbr::render
