#include "easypbr/io/mesh/gltf/glb_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "easypbr/core/luminance.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/gltf/gltf_extensions.h"

namespace easypbr::io {
namespace {

/// One channel of an image, as 8 bits.
struct Plane {
    std::shared_ptr<const Image> image;  ///< null: none
    int channel = 0;
    /// From the texture coordinates of the merged texture to its own, where these are others.
    std::optional<Mat3d> transform = {};

    uint8_t at(int x, int y, int width, int height) const {
        if (transform) return at_center(x, y, width, height);
        const int column = int((long long)x * image->width() / width),
                  row = int((long long)y * image->height() / height);
        return image->at<uint8_t>(column, row)[channel];
    }

    uint8_t at_center(int x, int y, int width, int height) const {
        const Vec3d uv = *transform * Vec3d((x + 0.5) / width, 1 - (y + 0.5) / height, 1);
        const auto texel = [](double t, int size) {
            return std::clamp(int((t - std::floor(t)) * size), 0, size - 1);
        };
        return image->at<uint8_t>(texel(uv.x(), image->width()),
                                  image->height() - 1 - texel(uv.y(), image->height()))[channel];
    }
};

Plane plane_of(const Texture& texture, int channel) {
    return {.image = texture.image, .channel = std::min(channel, texture.image->channels() - 1)};
}

/// A texture with its texels as u8.
Texture encoded(const Texture& texture, TexelUse use = TexelUse::number) {
    Texture out = texture;
    if (texture.image->type() != PixelType::u8)
        out.image = std::make_shared<const Image>(texels_to_u8(*texture.image, use == TexelUse::color));
    return out;
}

/// A channel that is put together with those of other textures.
struct Part {
    const Texture* texture;
    const char* name;  ///< of the material's texture
};

/// Largest width and height of what is resampled.
constexpr double largest_resampled_side = 8192;

bool is_repeated(const Texture& texture) {
    return texture.wrap_u == Wrap::repeat && texture.wrap_v == Wrap::repeat;
}

/// From the texture coordinates that one texture has to those of another, where a texture that is mapped as
/// `like` can show `other`: both have the same mapping, or a tile of `like` spans whole periods of `other`.
std::optional<Mat3d> resampling(const Texture& like, const Texture& other) {
    const bool same_wraps = like.wrap_u == other.wrap_u && like.wrap_v == other.wrap_v;
    if (same_wraps && like.uv_transform == other.uv_transform) return Mat3d::Identity();
    const Mat3d to = like.uv_transform.cast<double>(), from = other.uv_transform.cast<double>();
    if (!is_repeated(like) || !is_repeated(other) || to.determinant() == 0) return {};
    Mat3d M = from * to.inverse();
    if (!M.allFinite()) return {};
    const Eigen::Matrix2d periods = M.topLeftCorner<2, 2>().array().round();
    // Factors of files have about six digits.
    if ((M.topLeftCorner<2, 2>() - periods).cwiseAbs().maxCoeff() > 1e-5) return {};
    M.topLeftCorner<2, 2>() = periods;
    const Eigen::Vector2d texels =
        periods.cwiseAbs().transpose() * Eigen::Vector2d(other.image->width(), other.image->height());
    if (texels.maxCoeff() > largest_resampled_side) return {};
    return M;
}

/// Which part's mapping the merged texture has, and how the others are resampled into it.
struct Merge {
    const Texture* like = nullptr;
    std::map<const Texture*, Mat3d> transforms;
    std::vector<const char*> left_out;  ///< parts that get the mapping of `like` in place of theirs
};

/// The first part under which all others keep their mappings; else the first of all.
Merge merge_of(const std::vector<Part>& parts) {
    Merge first;
    for (const Part& like : parts) {
        Merge merge{like.texture, {}, {}};
        for (const Part& other : parts) {
            const std::optional<Mat3d> transform = resampling(*like.texture, *other.texture);
            if (transform)
                merge.transforms[other.texture] = *transform;
            else
                merge.left_out.push_back(other.name);
        }
        if (merge.left_out.empty()) return merge;
        if (!first.like) first = std::move(merge);
    }
    return first;
}

/// The parts that become one texture with others that may have another mapping.
std::vector<Part> parts_of_surface(const Material& material) {
    std::vector<Part> parts;
    if (material.metallic_texture) parts.push_back({&material.metallic_texture, "metallic_texture"});
    if (material.roughness_texture) parts.push_back({&material.roughness_texture, "roughness_texture"});
    return parts;
}

std::vector<Part> parts_of_color(const Material& material) {
    std::vector<Part> parts;
    if (!material.opacity_texture) return parts;
    if (material.base_color_texture) parts.push_back({&material.base_color_texture, "base_color_texture"});
    parts.push_back({&material.opacity_texture, "opacity_texture"});
    return parts;
}

/// Texels of a plane along each axis of the merged texture.
Eigen::Vector2i size_of_plane(const Plane& plane) {
    const Eigen::Vector2i size(plane.image->width(), plane.image->height());
    if (!plane.transform) return size;
    return plane.transform->topLeftCorner<2, 2>().cast<int>().cwiseAbs().transpose() * size;
}

/// A texture like `like`, of the larger of its planes' sizes; a channel without an image is 255.
Texture merged_texture(const Texture& like, const std::vector<Plane>& planes) {
    Eigen::Vector2i size(1, 1);
    for (const Plane& plane : planes)
        if (plane.image) size = size.cwiseMax(size_of_plane(plane));
    const int width = size.x(), height = size.y();
    auto image = std::make_shared<Image>(width, height, int(planes.size()), PixelType::u8);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (size_t c = 0; c < planes.size(); ++c)
                image->at<uint8_t>(x, y)[c] = planes[c].image ? planes[c].at(x, y, width, height) : 255;
    Texture out = like;
    out.image = std::move(image);
    out.channel = 0;
    return out;
}

/// A plane as the merge has it.
Plane placed(const Merge& merge, const Texture& texture, Plane plane) {
    const auto found = merge.transforms.find(&texture);
    if (found != merge.transforms.end() && !found->second.isIdentity(0)) plane.transform = found->second;
    return plane;
}

/// glTF's one texture for both: roughness in green, metallic in blue.
Texture metallic_roughness(const Material& material) {
    const Texture& metallic = material.metallic_texture;
    const Texture& roughness = material.roughness_texture;
    if (!metallic && !roughness) return {};
    const Merge merge = merge_of(parts_of_surface(material));
    const bool is_one = metallic.image == roughness.image && merge.left_out.empty() &&
                        metallic.uv_transform == roughness.uv_transform;
    if (is_one && metallic.channel == 2 && roughness.channel == 1) return metallic;
    std::vector<Plane> planes(3);
    if (roughness) planes[1] = placed(merge, roughness, plane_of(encoded(roughness), roughness.channel));
    if (metallic) planes[2] = placed(merge, metallic, plane_of(encoded(metallic), metallic.channel));
    return merged_texture(*merge.like, planes);
}

/// A texture whose values stand in the given channel.
Texture in_channel(const Texture& texture, int channel) {
    if (!texture || texture.channel == channel) return texture;
    std::vector<Plane> planes(size_t(channel) + 1);
    planes.back() = plane_of(encoded(texture), texture.channel);
    return merged_texture(texture, planes);
}

int wrap_code(Wrap wrap) {
    return wrap == Wrap::clamp ? 33071 : wrap == Wrap::mirror ? 33648 : 10497;
}

/// KHR_texture_transform of a transform, which can only be scaling, then turning, then shifting; v goes down
/// in glTF.
OrderedJson transform_json(const Mat3& ours) {
    Mat3d flip = Mat3d::Identity();
    flip.row(1) << 0, -1, 1;
    const Mat3d T = flip * ours.cast<double>() * flip;
    const double angle = std::atan2(-T(1, 0), T(0, 0));
    const double scale_x = std::hypot(T(0, 0), T(1, 0));
    const double scale_y = T(0, 1) * std::sin(angle) + T(1, 1) * std::cos(angle);
    return {{"offset", {T(0, 2), T(1, 2)}}, {"rotation", angle}, {"scale", {scale_x, scale_y}}};
}

OrderedJson color_json(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

}  // namespace

std::vector<std::string> mappings_left_out_of_gltf(const MeshData& mesh) {
    std::vector<std::string> names;
    for (const Material& material : mesh.materials)
        for (const auto& parts : {parts_of_surface(material), parts_of_color(material)})
            for (const char* const name : merge_of(parts).left_out)
                names.push_back(fmt::format("transform and wraps of {} of material '{}' beside those of {}",
                                            name, material.name, parts.front().name));
    return names;
}

size_t GlbContent::add_view(const void* data, size_t size, int target) {
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    OrderedJson view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}};
    if (target) view["target"] = target;
    binary.append(static_cast<const char*>(data), size);
    json["bufferViews"].push_back(std::move(view));
    return json["bufferViews"].size() - 1;
}

OrderedJson& GlbContent::extend(OrderedJson& object, const char* extension) {
    OrderedJson& used = json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
    return object["extensions"][extension];
}

Texture GlbMaterials::base_color(const Material& material) {
    const Texture& color = material.base_color_texture;
    const Texture& opacity = material.opacity_texture;
    if (!opacity) return color;
    const Merge merge = merge_of(parts_of_color(material));
    std::vector<Plane> planes(4);
    if (color) {
        Texture texels = color;
        texels.image = texels_.of(color, TexelUse::color, "base_color");
        texels = encoded(texels, TexelUse::color);
        for (int c = 0; c < 3; ++c) {
            const int channel = color.image->channels() < 3 ? 0 : c;
            planes[size_t(c)] = placed(merge, color, plane_of(texels, channel));
        }
    }
    planes[3] = placed(merge, opacity, plane_of(encoded(opacity), opacity.channel));
    return merged_texture(*merge.like, planes);
}

size_t GlbMaterials::image_index(const std::shared_ptr<const Image>& image) {
    const auto [found, is_new] = images_.try_emplace(image, images_.size());
    if (is_new) {
        const auto png = encode_png(*image);
        const size_t view = content_.add_view(png.data(), png.size());
        content_.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    }
    return found->second;
}

size_t GlbMaterials::texture_index(const Texture& texture, TexelUse use, std::string_view name) {
    const bool nearest = texture.filter == Filter::nearest;
    const OrderedJson sampler = {{"magFilter", nearest ? 9728 : 9729},
                                 {"minFilter", nearest ? 9728 : 9987},
                                 {"wrapS", wrap_code(texture.wrap_u)},
                                 {"wrapT", wrap_code(texture.wrap_v)}};
    const auto index_in = [&](const char* array, const OrderedJson& value) {
        OrderedJson& values = content_.json[array];
        for (size_t i = 0; i < values.size(); ++i)
            if (values[i] == value) return i;
        values.push_back(value);
        return values.size() - 1;
    };
    const size_t source = image_index(texels_.of(texture, use, name));
    return index_in("textures", {{"sampler", index_in("samplers", sampler)}, {"source", source}});
}

OrderedJson GlbMaterials::texture_info(const Texture& texture, TexelUse use, std::string_view name) {
    OrderedJson info = {{"index", texture_index(texture, use, name)}};
    if (texture.uv_transform != Mat3::Identity())
        content_.extend(info, "KHR_texture_transform") = transform_json(texture.uv_transform);
    return info;
}

void GlbMaterials::add_surface(const Material& material, OrderedJson& json) {
    OrderedJson& surface = json["pbrMetallicRoughness"];
    surface["baseColorFactor"] = {material.base_color[0], material.base_color[1], material.base_color[2],
                                  material.opacity};
    surface["metallicFactor"] = material.metallic;
    surface["roughnessFactor"] = material.roughness;
    if (const Texture texture = base_color(material))
        surface["baseColorTexture"] = texture_info(texture, TexelUse::color, "base_color");
    if (const Texture texture = metallic_roughness(material))
        surface["metallicRoughnessTexture"] = texture_info(texture, TexelUse::number);
    if (const Texture& texture = material.normal_texture) {
        json["normalTexture"] = texture_info(texture, TexelUse::vector);
        json["normalTexture"]["scale"] = material.normal_scale;
    }
    if (const Texture texture = in_channel(material.occlusion_texture, 0)) {
        json["occlusionTexture"] = texture_info(texture, TexelUse::number);
        json["occlusionTexture"]["strength"] = material.occlusion_strength;
    }
}

void GlbMaterials::add_emission(const Material& material, OrderedJson& json) {
    if (const Texture& texture = material.emissive_texture)
        json["emissiveTexture"] = texture_info(texture, TexelUse::color, "emissive");
    // The factor ends at 1; what is brighter goes into the strength.
    const float strength = std::max(1.0f, material.emissive.maxCoeff());
    json["emissiveFactor"] = color_json(material.emissive / strength);
    if (strength > 1) content_.extend(json, khr_emissive_strength)["emissiveStrength"] = strength;
}

void GlbMaterials::add_colors(OrderedJson& extension, const char* key, const Texture& texture,
                              std::string_view name) {
    if (texture) extension[key] = texture_info(texture, TexelUse::color, name);
}

void GlbMaterials::add_vectors(OrderedJson& extension, const char* key, const Texture& texture) {
    if (texture) extension[key] = texture_info(texture, TexelUse::vector);
}

void GlbMaterials::add_channel(OrderedJson& extension, const char* key, const Texture& texture, int channel) {
    if (const Texture numbers = in_channel(texture, channel))
        extension[key] = texture_info(numbers, TexelUse::number);
}

void GlbMaterials::add_layers(const Material& material, OrderedJson& json) {
    if (material.clearcoat > 0) {
        OrderedJson e = {{"clearcoatFactor", material.clearcoat},
                         {"clearcoatRoughnessFactor", material.clearcoat_roughness}};
        add_channel(e, "clearcoatTexture", material.clearcoat_texture, 0);
        add_channel(e, "clearcoatRoughnessTexture", material.clearcoat_roughness_texture, 1);
        add_vectors(e, "clearcoatNormalTexture", material.clearcoat_normal_texture);
        if (material.clearcoat_normal_texture)
            e["clearcoatNormalTexture"]["scale"] = material.clearcoat_normal_scale;
        content_.extend(json, khr_clearcoat) = std::move(e);
    }
    if (!is_black(material.sheen_color)) {
        OrderedJson e = {{"sheenColorFactor", color_json(material.sheen_color)},
                         {"sheenRoughnessFactor", material.sheen_roughness}};
        add_colors(e, "sheenColorTexture", material.sheen_color_texture, "sheen_color");
        add_channel(e, "sheenRoughnessTexture", material.sheen_roughness_texture, 3);
        content_.extend(json, khr_sheen) = std::move(e);
    }
    if (material.iridescence > 0) {
        OrderedJson e = {{"iridescenceFactor", material.iridescence},
                         {"iridescenceIor", material.iridescence_ior},
                         {"iridescenceThicknessMinimum", material.iridescence_thickness_min},
                         {"iridescenceThicknessMaximum", material.iridescence_thickness_max}};
        add_channel(e, "iridescenceTexture", material.iridescence_texture, 0);
        add_channel(e, "iridescenceThicknessTexture", material.iridescence_thickness_texture, 1);
        content_.extend(json, khr_iridescence) = std::move(e);
    }
    if (material.anisotropy > 0) {
        OrderedJson e = {{"anisotropyStrength", material.anisotropy},
                         {"anisotropyRotation", radians(double(material.anisotropy_rotation_deg))}};
        add_vectors(e, "anisotropyTexture", material.anisotropy_texture);
        content_.extend(json, khr_anisotropy) = std::move(e);
    }
}

void GlbMaterials::add_dielectric(const Material& material, OrderedJson& json) {
    if (material.names_ior()) content_.extend(json, khr_ior) = {{"ior", material.ior}};
    if (material.specular != 1 || material.specular_color != Vec3::Ones() || material.specular_texture ||
        material.specular_color_texture) {
        OrderedJson e = {{"specularFactor", material.specular},
                         {"specularColorFactor", color_json(material.specular_color)}};
        add_channel(e, "specularTexture", material.specular_texture, 3);
        add_colors(e, "specularColorTexture", material.specular_color_texture, "specular_color");
        content_.extend(json, khr_specular) = std::move(e);
    }
    if (material.transmission > 0) {
        OrderedJson e = {{"transmissionFactor", material.transmission}};
        add_channel(e, "transmissionTexture", material.transmission_texture, 0);
        content_.extend(json, khr_transmission) = std::move(e);
    }
    if (material.thickness > 0) {
        OrderedJson e = {{"thicknessFactor", material.thickness},
                         {"attenuationColor", color_json(material.attenuation_color)}};
        if (std::isfinite(material.attenuation_distance))
            e["attenuationDistance"] = material.attenuation_distance;
        add_channel(e, "thicknessTexture", material.thickness_texture, 1);
        content_.extend(json, khr_volume) = std::move(e);
    }
    if (material.dispersion > 0)
        content_.extend(json, khr_dispersion) = {{"dispersion", material.dispersion}};
}

size_t GlbMaterials::add(const Material& material, bool transparent_vertices) {
    OrderedJson json;
    if (!material.name.empty()) json["name"] = material.name;
    add_surface(material, json);
    add_emission(material, json);
    add_layers(material, json);
    add_dielectric(material, json);
    if (material.unlit) content_.extend(json, khr_unlit) = OrderedJson::object();
    const char* modes[] = {"OPAQUE", "MASK", "BLEND"};
    const AlphaMode mode = material.alpha_mode_for(transparent_vertices);
    json["alphaMode"] = modes[int(mode)];
    if (mode == AlphaMode::mask) json["alphaCutoff"] = material.alpha_cutoff;
    json["doubleSided"] = material.double_sided;
    content_.json["materials"].push_back(std::move(json));
    return content_.json["materials"].size() - 1;
}

}  // namespace easypbr::io
