// The analytic lights as paths see them.
#pragma once

#include <memory>
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
    Vec3 way{0, 0, 0};   ///< to the chosen point, of an area light (RayScene's frame)
};

class PathLights {
  public:
    /// The settings must outlive the calls of the others.
    void prepare(const ResolvedSettings& resolved, const RayScene& scene);

    bool empty() const { return blocks_.empty(); }
    /// Chooses a light for each path of a batch, of area lights a point too. `caught`: the surfaces catch
    /// shadows.
    void choose(const PathBatch& batch, uint32_t depth, bool caught, std::vector<ChosenLight>& chosen) const;
    /// Where the emitter of a chosen light is seen from a place (RayScene's frame). `u` chooses the point of
    /// lights that are not areas.
    struct Towards {
        Vec3 direction{0, 0, 0};  ///< unit; 0: at the emitter, or the light casts no shadows
        float distance = 0;
        /// Its light is refracted by transmissive surfaces: it does not shine straight through.
        bool is_area = false;
    };
    Towards towards(const ChosenLight& light, const Vec3& place, const Vec2& u, const RayScene& scene) const;
    /// What reaches a place of the light that comes from there; rays start at `from`.
    Vec3 transmittance(const Towards& to, const Vec3& from, const RayScene& scene) const;
    /// Whether there are area lights, which directions meet that are sampled by the BSDF.
    bool has_areas() const { return !areas_.empty(); }

    /// Calls `visit` with each area light that a direction meets which was sampled by the BSDF with a density
    /// per steradian: with its radiance times the weight by MIS, and the distance at which it is met; -1 for
    /// lights that nothing hides.
    template <class Visit>
    void for_each_met(const Vec3& place, const Vec3& direction, float density, Visit&& visit) const {
        for (const Area& area : areas_) {
            const auto [distance, chosen] = met(area, place, direction);
            if (chosen > 0)
                visit(Vec3(area.radiance * (density / (density + chosen))),
                      area.casts_shadows ? distance : -1.0f);
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

    const ResolvedSettings* resolved_ = nullptr;
    std::vector<Area> areas_;
    std::vector<Block> blocks_;
    bool transmits_ = false;  ///< light passes some surface
};

/// The surfaces that a shader of paths is for.
enum class PathSurfaces { plain, catcher, extended };
/// What the shaders of paths read of the settings, and of the extensions that there are.
ShaderInputs path_inputs(const ResolvedSettings& resolved, const RayScene& scene, PathSurfaces surfaces);

}  // namespace easypbr::render
