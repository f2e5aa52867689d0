// A mesh's material as shaders/geometry_mesh.frag takes it.
#pragma once

#include "easypbr/gl/program.h"
#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// What the shader's values depend on beside the material.
struct MaterialContext {
    ExtensionSet extensions = 0;                 ///< those that the targets hold; 0: the core model only
    int sample_count = 1;                        ///< of the accumulated picture
    const ResolvedSettings* resolved = nullptr;  ///< needed with extensions
};

/// Macros for the item's textures and extensions, those of the context only.
void add_material_defines(const MaterialContext& context, const DrawItem& item,
                          std::vector<std::string>& defines);

/// Sets the uniforms and binds the textures to units from 0 on, as many as the item has. Returns the first
/// unit that is free.
unsigned set_material(const gl::Program& program, const MaterialContext& context, const DrawItem& item,
                      gpu::TextureCache& textures);

}  // namespace easypbr::render
