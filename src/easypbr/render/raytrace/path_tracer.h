// Path tracing from surfaces that are known.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "easypbr/render/raytrace/catcher_light.h"
#include "easypbr/render/raytrace/emitters.h"
#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/path_lights.h"
#include "easypbr/render/raytrace/sky_sampler.h"

namespace easypbr::render {

struct HitSurfaces;

/// Estimates the radiance that surfaces send back along paths: lights, emissive surfaces and the sky by
/// next-event estimation at each surface, and what directions find that are sampled by the BSDF. The sky and
/// emissive surfaces are found both ways, combined by MIS (Veach and Guibas 1995). Materials are evaluated by
/// shaders/path_plain.glsl and path_extended.glsl, the text that the raster frame lights surfaces by. Lamps
/// shine straight through clear and nearly clear surfaces; all other light is refracted.
class PathTracer {
  public:
    /// The settings and the scene must outlive the calls of the others. `most`: luminance of one path that is
    /// within the limit of PathRadiance, once it is scattered widely; of other reflected light, what is above
    /// 40 times that is lost.
    void prepare(const ResolvedSettings& resolved, const RayScene& scene, float most);

    /// A path that has met a surface.
    struct Hit {
        PathState state;
        RayHit hit;
        Vec3 direction;
        float density;    ///< of the direction, per steradian
        float footprint;  ///< width of what the path stands for there, world units
    };
    /// The hit of a camera's ray.
    static Hit camera_hit(const PathState& state, const RayHit& hit, const Vec3& direction, float footprint);

    /// Adds the radiance of each path to its place in `radiance`: of those of a batch, whose surfaces have no
    /// extensions, and of others that have met a surface. Both are used up.
    void trace(PathBatch& batch, std::vector<Hit>& hits, PathRadiance& radiance) const;
    /// Of surfaces that catch shadows.
    const CatcherLight& catcher() const { return catcher_; }

  private:
    struct Scattered;
    struct Escaped;
    struct Caught;
    /// Paths at surfaces without extensions and with them.
    struct Batches;
    /// Where rays in a direction start, which may go through the surface.
    Vec3 start_towards(const PathBatch& batch, size_t path, const Vec3& direction) const;
    /// The same of rays to lamps. Where their light grazes a face it may come from below it, though not from
    /// below the interpolated normal: they start at the smooth surface there.
    Vec3 start_to_lamp(const PathBatch& batch, size_t path, const Vec3& direction) const;
    /// One step of all paths of a batch: `hits` gets the surfaces that they meet next.
    void step(PathBatch& batch, uint32_t depth, std::vector<Hit>& hits, PathRadiance& radiance) const;
    void scatter(const PathBatch& batch, uint32_t depth, Scattered& to) const;
    /// Chooses the direction of next-event estimation for each path: to the sky, or to an emissive surface.
    void choose_directions(const PathBatch& batch, uint32_t depth, Scattered& to) const;
    void add_direct(const PathBatch& batch, uint32_t depth, const std::vector<ChosenLight>& lamps,
                    const Scattered& scattered, PathRadiance& radiance) const;
    /// The parts of that: of the lamps, and of the directions of next-event estimation.
    void add_lamps(const PathBatch& batch, const std::vector<ChosenLight>& lamps,
                   std::vector<Vec3>& light) const;
    void add_chosen(const PathBatch& batch, uint32_t depth, const Scattered& scattered,
                    std::vector<Vec3>& light) const;
    /// Whether paths of this scattering see only the sky in a shadow catcher. Then next-event estimation
    /// looks for the sky there, too. Before a background of one colour BSDF sampling alone does: only it
    /// tells the specular lobe, which sees the colour, from the diffuse one.
    bool sees_sky_in_ground(Scattering scattered) const;
    /// The part of what lies behind such a ground that it shows where paths have met it, by one sample of its
    /// light for each. `depth`: of the random numbers.
    std::vector<float> shown_by_ground(std::span<const GroundHit> hits, uint32_t depth) const;
    /// What surfaces with extensions emit.
    void add_emission(const PathBatch& batch, const Scattered& scattered, PathRadiance& radiance) const;
    /// Follows the paths to the next surface.
    void follow(const PathBatch& batch, uint32_t depth, const Scattered& scattered, std::vector<Hit>& hits,
                PathRadiance& radiance) const;
    /// What a path becomes that goes on in a direction; false where it ends.
    bool goes_on(const PathBatch& batch, size_t path, uint32_t depth, const Vec3& direction,
                 PathState& state) const;
    /// Of a path at a surface with extensions: the channel whose index of refraction it meets there.
    void choose_color(PathBatch& batch, size_t path, uint32_t depth) const;
    /// The same at a volume's surface: what it is to the medium around it.
    void surround(PathBatch& batch, size_t path) const;
    /// Sets where a path with extensions is, and what its volume is to it.
    void meet_volume(PathBatch& batch, size_t path, const Hit& hit, uint32_t depth) const;
    /// What a surface adds to a path that has met it: what it emits, or the colour that it has in the
    /// picture, as a linear curve would show it.
    Vec3 shown(const HitSurfaces& surfaces, size_t i, const PathState& state) const;
    /// Weakens a path by the volume that it is in.
    void absorb(float distance, PathState& state) const;
    /// What the volume leaves of light that comes to a path's surface from this far in a direction.
    Vec3 left_on_the_way(const PathBatch& batch, size_t path, const Vec3& direction, float distance) const;
    /// The paths that go on from hits.
    Batches arrive(std::vector<Hit>& hits, uint32_t depth, PathRadiance& radiance) const;
    /// Part of what surfaces emit that paths add which have met them in sampled directions.
    std::vector<float> emission_weights(std::span<const Hit> hits) const;
    /// Adds what the sky sends to paths that have left the scene in sampled directions.
    void add_escaped(const Escaped& paths, PathRadiance& radiance) const;
    /// Notes a path that has met a ground that catches shadows, from surface `path` of a batch.
    void note_caught(const PathBatch& batch, size_t path, const Scattered& scattered, const Hit& hit,
                     Caught& to) const;
    /// Adds what such a ground shows of the sky behind it, or of the background's colour.
    void add_caught(const Caught& caught, uint32_t depth, PathRadiance& radiance) const;
    /// The part of a path, as it goes on from a surface of a batch, that sees a background of one colour on
    /// the ground: light that is transmitted alone, and what specular lobes reflect.
    Vec3 part_before_color(const PathBatch& batch, size_t path, const Scattered& scattered,
                           const PathState& state) const;
    /// Adds what a path has found at a surface.
    void add(uint32_t index, const Vec3& found, Scattering scattered, PathRadiance& to) const;

    const ResolvedSettings* resolved_ = nullptr;
    const RayScene* scene_ = nullptr;
    PathLights lights_;
    SkySampler sky_;
    Emitters emitters_;
    CatcherLight catcher_;
    std::optional<Vec3> background_;  ///< radiance, where it is a colour
    float emitter_part_ = 0;  ///< of the directions of next-event estimation; the others are those of the sky
    float most_light_ = 0;    ///< that a path adds after a bounce, luminance
    std::shared_ptr<const void> uniforms_, extended_;
    std::vector<Vec3> absorption_;  ///< of the surfaces' volumes, per RayScene::unit()
};

}  // namespace easypbr::render
