// What all shaders that light surfaces read.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/scene/resolved_light.h"
#include "easypbr/scene/settings.h"

namespace easypbr::render {

class ShaderInputs;

/// What the uniform blocks hold is stated once, in the text that the shaders include.
namespace blocks {
using vec4 = Vec4;
#include "light_blocks.glsl"
// std140 rounds the size of an element up to that of a vec4.
static_assert(sizeof(Light) == 4 * sizeof(vec4) && sizeof(ShadowMap) == 6 * sizeof(vec4));
static_assert(sizeof(vec4) == 16 && alignof(vec4) <= 16);
}  // namespace blocks

/// A light as shaders see it, in lengths of `unit` world units from an origin.
blocks::Light light_uniform(const ResolvedLight& light, const Vec3d& origin, double unit = 1);

/// The variant of the BRDF.
void set_brdf(ShaderInputs& values, const ShadingSettings& shading);

}  // namespace easypbr::render
