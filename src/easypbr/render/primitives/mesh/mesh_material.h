// A mesh's material as shaders/geometry_mesh.frag takes it.
#pragma once

#include "easypbr/gl/program.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// Macros for the item's textures and extensions, those of the frame only.
void add_material_defines(const Frame& frame, const DrawItem& item, std::vector<std::string>& defines);

/// Sets the uniforms and binds the textures to units from 0 on, as many as the item has. Returns the first
/// unit that is free.
unsigned set_material(const gl::Program& program, const Frame& frame, const DrawItem& item,
                      gpu::TextureCache& textures);

}  // namespace easypbr::render
