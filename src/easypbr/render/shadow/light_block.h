// Lights that are drawn in one go, and the shadow maps they see.
#pragma once

#include <algorithm>
#include <vector>

#include "easypbr/gl/texture.h"
#include "easypbr/native/views.h"
#include "easypbr/render/frame/shadow_view.h"

namespace easypbr::render {

/// The maps of one light.
struct LightShadow {
    const ShadowProjection* projection = nullptr;
    int first_layer = 0;
    /// Radius of the light that the maps do not account for: world units, or the tangent of an angle for
    /// directional lights.
    double radius = 0;
};

/// What surfaces that let light through take from it, in arrays beside that of the maps, per channel of the
/// light; see shaders/shadow_target.glsl.
struct ShadowTints {
    gl::Texture absorption;  ///< rgb: sum of -ln(transmittance); a: depth of the first caster
    gl::Texture moment;      ///< rgb: sum of -ln(transmittance) times depth; a: minus the last caster's depth

    explicit operator bool() const { return bool(absorption); }
};

/// As the blocks in shaders/common_arriving.glsl.
inline constexpr size_t lights_per_block = 64;

struct LightBlock {
    /// Those without shadows first, then those with one map, then those with a cube.
    std::vector<const ResolvedLight*> lights;
    std::vector<LightShadow> shadows;    ///< of the last of the lights
    size_t cubes = 0;                    ///< how many of the shadows are cubes
    int resolution = 0;                  ///< of the maps
    const gl::Texture* maps = nullptr;   ///< the driver's
    native::Layers host_maps = {};       ///< those in host memory
    const ShadowTints* tints = nullptr;  ///< where casters let light through: the driver's
    native::Layers4 host_absorption = {}, host_moment = {};  ///< the same in host memory
    bool first = true;                                       ///< of the frame's blocks

    bool has_tints() const { return tints || host_absorption.data; }
    size_t plain() const { return lights.size() - shadows.size(); }
    bool has_area() const {
        return std::ranges::any_of(lights, [](const ResolvedLight* light) { return is_area(light->type); });
    }
};

}  // namespace easypbr::render
