// The analytic lights as paths see them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/ray_scene.h"
#include "easypbr/scene/light.h"

namespace easypbr {
struct ResolvedLight;
struct ResolvedSettings;
}  // namespace easypbr

namespace easypbr::render {

/// A light that was chosen for a path.
struct ChosenLight {
    Vec3 light{0, 0,
               0};  ///< what the surface reflects of it, unless it is hidden, as if it stood for all lights
    float all = 0;  ///< luminance of all lights, if none is hidden
    uint32_t index = 0;  ///< in the resolved settings
    Vec3 way{0, 0, 0};   ///< to its chosen point (RayScene's frame), of parallel light the direction to it
};

class PathLights {
  public:
    void prepare(const ResolvedSettings& resolved, const RayScene& scene);

    bool empty() const { return blocks_.empty(); }
    /// Chooses a light for each path of a batch, and a point of it. `caught`: the surfaces catch
    /// shadows.
    void choose(const PathBatch& batch, uint32_t depth, bool caught, std::vector<ChosenLight>& chosen) const;
    /// The ray from a place (RayScene's frame) to the point of a chosen light; of no length at the light, or
    /// where it casts no shadows.
    RaySegment towards(const ChosenLight& light, const Vec3& from) const;
    /// What reaches places of the light that comes by such rays, of the lights of these indices.
    /// `stopping`: of lights without an area, by RayScene::transmittance().
    std::vector<Vec3> transmittances(std::span<const RaySegment> rays, std::span<const uint32_t> lights,
                                     std::span<const float> stopping, const RayScene& scene) const;
    /// Whether a light shines straight through surfaces, as those without an area do.
    bool shines_straight(uint32_t light) const { return !emitters_[light].is_area; }
    /// Whether there are area lights, which directions meet that are sampled by the BSDF.
    bool has_areas() const { return !areas_.empty(); }

    /// Calls `visit` with each area light that a direction meets which was sampled by the BSDF with a density
    /// per steradian: with its radiance times the weight by MIS, the distance at which it is met, and whether
    /// what lies before hides it.
    template <class Visit>
    void for_each_met(const Vec3& place, const Vec3& direction, float density, Visit&& visit) const {
        for (const Area& area : areas_) {
            const auto [distance, chosen] = met(area, place, direction);
            if (chosen > 0)
                visit(Vec3(area.radiance * (density / (density + chosen))), distance, area.casts_shadows);
        }
    }

  private:
    struct Block {
        uint32_t first = 0;
        std::shared_ptr<const void> uniforms, of_catcher, extended;
    };
    /// An area light in RayScene's frame; see EmitterAxes.
    struct Area {
        LightType type = LightType::rectangle;
        Vec3 centre{0, 0, 0}, x{0, 0, 0}, y{0, 0, 0}, normal{0, 0, 0}, radiance{0, 0, 0};
        float radius = 0, area = 0;
        bool casts_shadows = true;
    };
    /// Where a direction meets it, and the density of next-event estimation there; 0 where it does not.
    struct Met {
        float distance = 0, density = 0;
    };
    static Met met(const Area& area, const Vec3& place, const Vec3& direction);
    static Area area_of(const ResolvedLight& light, const RayScene& scene);
    /// A light as rays that look for it see it.
    struct Emitter {
        bool is_parallel = false;
        /// Its light is refracted by transmissive surfaces: it does not shine straight through.
        bool is_area = false;
        bool casts_shadows = true;
    };

    std::vector<Emitter> emitters_;  ///< of all lights
    std::vector<Area> areas_;
    std::vector<Block> blocks_;
    bool transmits_ = false;  ///< light passes some surface
};

/// The surfaces that a shader of paths is for.
enum class PathSurfaces { plain, catcher, extended };
/// What the shaders of paths read of the settings, and of the extensions that there are.
ShaderInputs path_inputs(const ResolvedSettings& resolved, const RayScene& scene, PathSurfaces surfaces);

}  // namespace easypbr::render
