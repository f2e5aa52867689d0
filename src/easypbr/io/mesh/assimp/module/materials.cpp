#include "easypbr/io/mesh/assimp/module/materials.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"

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

/// An image inside the file: a compressed one, or plain BGRA texels.
std::shared_ptr<const Image> embedded_image(const aiTexture& texture, const std::string& name) {
    if (texture.mHeight == 0)
        return std::make_shared<const Image>(decode_image(
            std::as_bytes(std::span(reinterpret_cast<const char*>(texture.pcData), texture.mWidth)), name));
    auto image = std::make_shared<Image>(int(texture.mWidth), int(texture.mHeight), 4, PixelType::u8);
    for (size_t i = 0; i < image->pixel_count(); ++i) {
        const aiTexel& texel = texture.pcData[i];
        uint8_t* to = image->pixels<uint8_t>().data() + 4 * i;
        to[0] = texel.r, to[1] = texel.g, to[2] = texel.b, to[3] = texel.a;
    }
    return image;
}

class MaterialConverter {
  public:
    MaterialConverter(const aiScene& scene, const std::filesystem::path& path)
        : scene_(scene), path_(path), loader_(path) {}

    Material convert(const aiMaterial& from) {
        Material out;
        out.name = from.GetName().C_Str();
        convert_colors(from, out);
        out.base_color_texture = first_texture(from, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
        out.metallic_texture = first_texture(from, {aiTextureType_METALNESS});
        out.roughness_texture = first_texture(from, {aiTextureType_DIFFUSE_ROUGHNESS});
        out.normal_texture = first_texture(from, {aiTextureType_NORMAL_CAMERA, aiTextureType_NORMALS});
        out.occlusion_texture =
            first_texture(from, {aiTextureType_AMBIENT_OCCLUSION, aiTextureType_LIGHTMAP});
        out.emissive_texture = first_texture(from, {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE});
        out.opacity_texture = first_texture(from, {aiTextureType_OPACITY});
        if (out.opacity_texture) out.alpha_mode = AlphaMode::mask;
        // Old formats leave the factor black where a texture stands.
        if (out.base_color_texture && out.base_color.isZero()) out.base_color.setOnes();
        if (out.emissive_texture && out.emissive.isZero()) out.emissive.setOnes();
        return out;
    }

  private:
    static void convert_colors(const aiMaterial& from, Material& out) {
        if (const auto color = property<aiColor4D>(from, AI_MATKEY_BASE_COLOR)) {
            out.base_color = Vec3(color->r, color->g, color->b);
            out.opacity = color->a;
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
        if (out.opacity < 1) out.alpha_mode = AlphaMode::blend;
        if (const auto two_sided = property<int>(from, AI_MATKEY_TWOSIDED))
            out.double_sided = *two_sided != 0;
        out.metallic = std::clamp(out.metallic, 0.0f, 1.0f);
        out.roughness = std::clamp(out.roughness, 0.0f, 1.0f);
    }

    Texture first_texture(const aiMaterial& from, std::initializer_list<aiTextureType> types) {
        for (const aiTextureType type : types) {
            aiString name;
            aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
            if (from.GetTexture(type, 0, &name, nullptr, nullptr, nullptr, nullptr, modes) !=
                aiReturn_SUCCESS)
                continue;
            Texture texture = load(name);
            texture.wrap_u = wrap_of(modes[0]);
            texture.wrap_v = wrap_of(modes[1]);
            if (texture) return texture;
        }
        return {};
    }

    Texture load(const aiString& name) {
        const aiTexture* embedded = scene_.GetEmbeddedTexture(name.C_Str());
        if (!embedded) return loader_.load(name.C_Str());
        auto [found, is_new] = embedded_.try_emplace(embedded);
        if (is_new) try {
                found->second =
                    embedded_image(*embedded, fmt::format("{}, texture {}", path_.string(), name.C_Str()));
            } catch (const Error& error) {
                log_warning(fmt::format("drawn without a texture: {}", error.what()));
            }
        Texture texture;
        texture.image = found->second;
        return texture;
    }

    const aiScene& scene_;
    const std::filesystem::path& path_;
    TextureLoader loader_;
    std::map<const aiTexture*, std::shared_ptr<const Image>> embedded_;
};

}  // namespace

std::vector<Material> assimp_materials(const aiScene& scene, const std::filesystem::path& path) {
    MaterialConverter converter(scene, path);
    std::vector<Material> out;
    for (unsigned i = 0; i < scene.mNumMaterials; ++i) out.push_back(converter.convert(*scene.mMaterials[i]));
    return out;
}

}  // namespace easypbr::io
