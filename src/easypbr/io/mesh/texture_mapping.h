// How textures lie on faces, in formats that have less for it than glTF.
#pragma once

#include <string>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// What a format has for the mapping of the textures that it refers to.
struct TextureMapping {
    std::vector<Texture Material::*> textures;
    bool (*has_transform)(const Mat3& uv_transform);
    bool (*has_wraps)(Wrap u, Wrap v);
};

/// OBJ: scales and offsets; images that repeat, or are clamped along both axes.
const TextureMapping& obj_mapping();
/// PLY: base colours that repeat.
const TextureMapping& ply_mapping();

/// The texture that OBJ has for a material's opacity: its own, else the alpha of the base colour's where that
/// shows, which readers do not take out of it by themselves. Without an image: there is none.
Texture obj_opacity_texture(const Material& material);

/// The alpha mode that OBJ has for a material whose opacity has a texture: a mask where all texels of its
/// channel are near 0 or 1 and the opacity is 1.
AlphaMode obj_alpha_mode(float opacity, const Texture& texture);

/// Where the textures of a material share a transform that the format does not have, the texture coordinates
/// of the material's faces are transformed instead. All stay as they are where a vertex would need two.
void bake_uv_transforms(const TextureMapping& mapping, MeshData& mesh);

/// What of the mapping has no place in the format: names for a message. Wraps count where coordinates leave
/// the image. No format here has filters: those other than linear count.
std::vector<std::string> left_out_mappings(const TextureMapping& mapping, const MeshData& mesh);

/// The texture that a PLY file names: the base colour of a mesh with one material, where a file holds it;
/// null: none.
const Texture* ply_texture(const MeshData& mesh);

/// What a format has for textures, where one is written; null: none is.
const TextureMapping* texture_mapping(const MeshData& mesh, const std::string& extension);

}  // namespace easypbr::io
