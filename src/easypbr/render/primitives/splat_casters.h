// What discs and ellipses around vertices share as casters of shadows.
#pragma once

#include <string>
#include <vector>

#include "easypbr/gl/program.h"
#include "easypbr/render/primitives/shadow_layer.h"

namespace easypbr::render {

/// Where the light is in an item's frame: a position, or (w = 0) the direction towards it.
Vec4 light_in_mesh(const ShadowView& view, const DrawItem& item);

/// -ln of what an opacity lets through, as shaders/shadow_target.glsl has it.
float absorbed_by(float opacity);

/// Macros of shaders/shadow_points.frag and its like, for the item's alpha, and their uniforms.
std::vector<std::string> caster_defines(const DrawItem& item);
void set_caster_alpha(const gl::Program& program, const DrawItem& item);

}  // namespace easypbr::render
