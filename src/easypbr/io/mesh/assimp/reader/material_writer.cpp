#include "easypbr/io/mesh/assimp/reader/material_writer.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {
namespace {

/// A property of a material, by one of assimp's keys, which are three arguments.
template <class T>
std::optional<T> property(const aiMaterial& material, const char* key, unsigned type, unsigned index) {
    T value;
    if (material.Get(key, type, index, value) != aiReturn_SUCCESS) return std::nullopt;
    return value;
}

Vec3 positive(const aiColor3D& color) {
    return Vec3(color.r, color.g, color.b).cwiseMax(0.0f);
}

Wrap wrap_of(aiTextureMapMode mode) {
    if (mode == aiTextureMapMode_Mirror) return Wrap::mirror;
    return mode == aiTextureMapMode_Wrap ? Wrap::repeat : Wrap::clamp;
}

/// "#RRGGBB" or "#RRGGBBAA", whose alpha is the opacity (3MF Core Specification, 3.4.1.1). assimp has an
/// alpha of 0 where the text has none.
void convert_display_color(const aiColor4D& color, Material& out) {
    out.base_color = {linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b)};
    if (color.a > 0) out.opacity = std::min(color.a, 1.0f);
}

/// 3MF materials have display colours, but for the one that assimp gives to a file without materials: its
/// colour is linear, as ours. The names of those that a file has begin with "id" there.
bool has_display_color(const aiMaterial& material, bool is_3mf) {
    return is_3mf && std::string_view(material.GetName().C_Str()) != AI_DEFAULT_MATERIAL_NAME;
}

void convert_factors(const aiMaterial& from, bool is_3mf, Material& out) {
    if (const auto color = property<aiColor4D>(from, AI_MATKEY_BASE_COLOR)) {
        out.base_color = Vec3(color->r, color->g, color->b);
        out.opacity = color->a;
    } else if (const auto display = property<aiColor4D>(from, AI_MATKEY_COLOR_DIFFUSE);
               display && has_display_color(from, is_3mf)) {
        convert_display_color(*display, out);
    } else if (const auto diffuse = property<aiColor3D>(from, AI_MATKEY_COLOR_DIFFUSE)) {
        out.base_color = positive(*diffuse);
    }
    out.metallic = property<float>(from, AI_MATKEY_METALLIC_FACTOR).value_or(0.0f);
    const auto shininess = property<float>(from, AI_MATKEY_SHININESS);
    if (const auto roughness = property<float>(from, AI_MATKEY_ROUGHNESS_FACTOR))
        out.roughness = *roughness;
    else if (shininess && *shininess > 0)
        out.roughness = std::pow(2 / (*shininess + 2), 0.25f);
    if (const auto emissive = property<aiColor3D>(from, AI_MATKEY_COLOR_EMISSIVE))
        out.emissive = positive(*emissive);
    if (const auto opacity = property<float>(from, AI_MATKEY_OPACITY))
        out.opacity = std::clamp(*opacity, 0.0f, 1.0f);
    if (const auto two_sided = property<int>(from, AI_MATKEY_TWOSIDED)) out.double_sided = *two_sided != 0;
    out.metallic = std::clamp(out.metallic, 0.0f, 1.0f);
    out.roughness = std::clamp(out.roughness, 0.0f, 1.0f);
}

void write_factors(const Material& material, MessageWriter& out) {
    const Vec3 &base = material.base_color, &emissive = material.emissive;
    out.put(MessageFactors{{base.x(), base.y(), base.z()},
                           material.opacity,
                           material.metallic,
                           material.roughness,
                           {emissive.x(), emissive.y(), emissive.z()},
                           material.double_sided});
}

/// A texture of a material, and how assimp's importers name the image.
struct TextureName {
    aiString name;
    Wrap wrap_u, wrap_v;
};

/// What the material names for a slot, the most wanted first.
std::vector<TextureName> textures_of(const aiMaterial& from, std::initializer_list<aiTextureType> types) {
    std::vector<TextureName> out;
    for (const aiTextureType type : types) {
        aiString name;
        aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        if (from.GetTexture(type, 0, &name, nullptr, nullptr, nullptr, nullptr, modes) == aiReturn_SUCCESS)
            out.push_back({name, wrap_of(modes[0]), wrap_of(modes[1])});
    }
    return out;
}

void write_texture(const aiScene& scene, const TextureName& texture, MessageWriter& out) {
    const aiTexture* embedded = scene.GetEmbeddedTexture(texture.name.C_Str());
    out.put(embedded ? MessageTexture::embedded : MessageTexture::file);
    out.put(uint8_t(texture.wrap_u));
    out.put(uint8_t(texture.wrap_v));
    if (embedded)
        out.put(uint32_t(std::find(scene.mTextures, scene.mTextures + scene.mNumTextures, embedded) -
                         scene.mTextures));
    out.put_text(texture.name.C_Str());
}

void write_slot(const aiScene& scene, const aiMaterial& from, std::initializer_list<aiTextureType> types,
                MessageWriter& out) {
    const std::vector<TextureName> textures = textures_of(from, types);
    out.put(uint8_t(textures.size()));
    for (const TextureName& texture : textures) write_texture(scene, texture, out);
}

void write_material(const aiScene& scene, const aiMaterial& from, bool is_3mf, MessageWriter& out) {
    Material factors;
    convert_factors(from, is_3mf, factors);
    out.put_text(from.GetName().C_Str());
    write_factors(factors, out);
    write_slot(scene, from, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, out);
    write_slot(scene, from, {aiTextureType_METALNESS}, out);
    write_slot(scene, from, {aiTextureType_DIFFUSE_ROUGHNESS}, out);
    write_slot(scene, from, {aiTextureType_NORMAL_CAMERA, aiTextureType_NORMALS}, out);
    write_slot(scene, from, {aiTextureType_AMBIENT_OCCLUSION, aiTextureType_LIGHTMAP}, out);
    write_slot(scene, from, {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE}, out);
    write_slot(scene, from, {aiTextureType_OPACITY}, out);
}

/// A compressed image as it is, or texels, which assimp has as BGRA.
void write_image(const aiTexture& texture, MessageWriter& out) {
    if (texture.mHeight == 0) {
        out.put(MessageImage::compressed);
        out.put_count(texture.mWidth);
        out.put_bytes(texture.pcData, texture.mWidth);
        return;
    }
    out.put(MessageImage::pixels);
    out.put(uint32_t(texture.mWidth));
    out.put(uint32_t(texture.mHeight));
    for (size_t i = 0; i < size_t(texture.mWidth) * texture.mHeight; ++i) {
        const aiTexel& texel = texture.pcData[i];
        out.put(std::array<uint8_t, 4>{texel.r, texel.g, texel.b, texel.a});
    }
}

}  // namespace

void write_images(const aiScene& scene, MessageWriter& out) {
    out.put_count(scene.mNumTextures);
    for (unsigned i = 0; i < scene.mNumTextures; ++i) write_image(*scene.mTextures[i], out);
}

void write_materials(const aiScene& scene, bool is_3mf, MessageWriter& out) {
    out.put_count(scene.mNumMaterials);
    for (unsigned i = 0; i < scene.mNumMaterials; ++i)
        write_material(scene, *scene.mMaterials[i], is_3mf, out);
}

}  // namespace easypbr::io
