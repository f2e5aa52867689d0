// The light of surfaces that catch shadows.
#pragma once

#include <span>
#include <vector>

#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/path_lights.h"
#include "easypbr/render/raytrace/sky_sampler.h"

namespace easypbr::render {

/// Light that reaches a surface that catches shadows, and what would reach it if nothing stood there:
/// luminances. One sample can be less than none.
struct CaughtLight {
    float arrives = 0, all = 0;
};

/// A path that meets a ground that catches shadows.
struct GroundHit {
    PathState state;
    Vec3 position;  ///< RayScene's frame
};

/// Estimates how much of the irradiance that lamps and the sky send a ground without casters arrives. Where
/// all casters are seen within a cone, the sky's light without them is known, and what they hide is sampled
/// within the cone; elsewhere directions are distributed by the cosine. Bright parts of the sky are found by
/// its own directions too, combined by MIS (Veach and Guibas 1995).
class CatcherLight {
  public:
    /// Of the ground of the scene. All must outlive the calls of the others.
    void prepare(const RayScene& scene, const PathLights& lights, const SkySampler& sky);

    /// Of places (RayScene's frame) from the middle of the ball that holds the casters, in its radii.
    std::vector<float> distances(const PathVectors<3>& places) const;
    /// One sample for each path of a batch, added by the paths' places, whose distances() these are. `depth`:
    /// of the random numbers.
    void add_samples(PathBatch& batch, const std::vector<float>& distances, uint32_t depth,
                     std::vector<CaughtLight>& light) const;
    /// The part of the light that arrives where paths meet the ground, by one sample of each.
    std::vector<float> sampled_parts(std::span<const GroundHit> hits, uint32_t depth) const;

  private:
    struct Cone;
    struct SkyPoint;
    void add_lamps(const PathBatch& batch, uint32_t depth, std::vector<CaughtLight>& light) const;
    std::vector<SkyPoint> sky_points(const PathBatch& batch, const std::vector<float>& distances,
                                     uint32_t depth) const;
    void add_skies(const PathBatch& batch, const std::vector<float>& distances, uint32_t depth,
                   std::vector<CaughtLight>& light) const;
    struct Looks;
    /// What a direction to the casters would bring, of a place outside of their ball.
    void add_hidden(const PathBatch& batch, const SkyPoint& point, const SkySampler::Sample& sky,
                    float cone_density, Looks& looks) const;
    /// What the chosen direction of the sky brings.
    void add_chosen(const PathBatch& batch, const SkyPoint& point, Looks& looks) const;
    /// What a direction brings that is distributed by the cosine, area lights included.
    void add_matt(const PathBatch& batch, size_t path, const SkySampler::Sample& sky, float density,
                  Looks& looks) const;

    const RayScene* scene_ = nullptr;
    const PathLights* lights_ = nullptr;
    const SkySampler* sky_ = nullptr;
    float sky_light_ = 0;  ///< irradiance by the sky over pi, luminance
};

}  // namespace easypbr::render
