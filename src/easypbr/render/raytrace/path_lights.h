// The analytic lights as paths see them.
#pragma once

#include <memory>
#include <vector>

#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/ray_scene.h"

namespace easypbr {
struct ResolvedSettings;
}

namespace easypbr::render {

/// A light that was chosen for a path.
struct ChosenLight {
    Vec3 light{0, 0,
               0};  ///< what the surface reflects of it, unless it is hidden, as if it stood for all lights
    float all = 0;  ///< luminance of all lights, if none is hidden
    uint32_t index = 0;  ///< in the resolved settings
};

class PathLights {
  public:
    /// The settings must outlive the calls of the others.
    void prepare(const ResolvedSettings& resolved, const RayScene& scene);

    bool empty() const { return blocks_.empty(); }
    /// Chooses a light for each path of a batch, by the pair `dimension` of its numbers. `caught`: the
    /// surfaces catch shadows.
    void choose(const PathBatch& batch, uint32_t depth, bool caught, std::vector<ChosenLight>& chosen) const;
    /// Where the emitter of a chosen light is seen from a place (RayScene's frame); `u` chooses its point.
    struct Towards {
        Vec3 direction{0, 0, 0};  ///< unit; 0: at the emitter, or the light casts no shadows
        float distance = 0;
    };
    Towards towards(uint32_t light, const Vec3& place, const Vec2& u, const RayScene& scene) const;

  private:
    struct Block {
        uint32_t first = 0;
        std::shared_ptr<const void> uniforms, of_catcher, extended;
    };
    const ResolvedSettings* resolved_ = nullptr;
    std::vector<Block> blocks_;
};

/// The surfaces that a shader of paths is for.
enum class PathSurfaces { plain, catcher, extended };
/// What the shaders of paths read of the settings, and of the extensions that there are.
ShaderInputs path_inputs(const ResolvedSettings& resolved, const RayScene& scene, PathSurfaces surfaces);

}  // namespace easypbr::render
