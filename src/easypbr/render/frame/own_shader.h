// Programs with a material's own shader in them.
#pragma once

#include "easypbr/render/frame/programs.h"
#include "easypbr/scene/material.h"

namespace easypbr::render {

/// The variant of programs with geometry_shader.glsl that runs this shader, which is not empty. Throws
/// ShaderError where it has no function `surface`, and where it does not compile.
const gl::Program& with_shader(ProgramVariants& programs, const SurfaceShader& shader,
                               const std::vector<std::string>& defines);

}  // namespace easypbr::render
