// A mesh's material as shaders/geometry_mesh.frag takes it.
#pragma once

#include "easypbr/gpu/texture_cache.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::render {

/// What the shader's values depend on beside the material.
struct MaterialContext {
    ExtensionSet extensions = 0;                 ///< those that the targets hold; 0: the core model only
    int sample_count = 1;                        ///< of the accumulated picture
    const ResolvedSettings* resolved = nullptr;  ///< needed with extensions
    bool occlusion = true;                       ///< the material's is read; paths find all of it themselves
};

/// How the mip levels of a texture of the item's material are made. Alpha counts where it hides something.
gpu::TexelKind texel_kind(const DrawItem& item, const Texture& texture, TexelUse use);

/// Macros for what the vertices hold and on which side the surface is seen. `normals_agree`: the winding
/// tells the side of the mesh's normals.
void add_mesh_defines(const DrawItem& item, bool normals_agree, std::vector<std::string>& defines);

/// Macros for the item's textures and extensions, those of the context only.
void add_material_defines(const MaterialContext& context, const DrawItem& item,
                          std::vector<std::string>& defines);

/// The uniforms of the item's shader, natively or for the driver; textures live as long as in the cache.
ShaderInputs material_inputs(const MaterialContext& context, const DrawItem& item,
                             gpu::TextureCache& textures, bool native = false);

}  // namespace easypbr::render
