#include "easypbr/io/mesh/gltf/gltf_pointers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "easypbr/io/mesh/gltf/gltf_extensions.h"
#include "easypbr/scene/material_table.h"

namespace easypbr::io {
namespace {

template <class Value>
struct PointedProperty {
    const char* extension;  ///< or null
    const char* path;
    Value Material::*value;

    bool is_named(std::string_view property) const {
        return property == (extension ? fmt::format("extensions/{}/{}", extension, path) : path);
    }
};

constexpr PointedProperty<float> pointed_numbers[] = {
    {nullptr, "pbrMetallicRoughness/metallicFactor", &Material::metallic},
    {nullptr, "pbrMetallicRoughness/roughnessFactor", &Material::roughness},
    {nullptr, "alphaCutoff", &Material::alpha_cutoff},
    {nullptr, "normalTexture/scale", &Material::normal_scale},
    {nullptr, "occlusionTexture/strength", &Material::occlusion_strength},
    {khr_clearcoat, "clearcoatFactor", &Material::clearcoat},
    {khr_clearcoat, "clearcoatRoughnessFactor", &Material::clearcoat_roughness},
    {khr_clearcoat, "clearcoatNormalTexture/scale", &Material::clearcoat_normal_scale},
    {khr_sheen, "sheenRoughnessFactor", &Material::sheen_roughness},
    {khr_specular, "specularFactor", &Material::specular},
    {khr_ior, "ior", &Material::ior},
    {khr_transmission, "transmissionFactor", &Material::transmission},
    {khr_volume, "thicknessFactor", &Material::thickness},
    {khr_volume, "attenuationDistance", &Material::attenuation_distance},
    {khr_dispersion, "dispersion", &Material::dispersion},
    {khr_iridescence, "iridescenceFactor", &Material::iridescence},
    {khr_iridescence, "iridescenceIor", &Material::iridescence_ior},
    {khr_iridescence, "iridescenceThicknessMinimum", &Material::iridescence_thickness_min},
    {khr_iridescence, "iridescenceThicknessMaximum", &Material::iridescence_thickness_max},
    {khr_anisotropy, "anisotropyStrength", &Material::anisotropy},
    {khr_anisotropy, "anisotropyRotation", &Material::anisotropy_rotation_deg}};

constexpr PointedProperty<Vec3> pointed_colors[] = {
    {khr_sheen, "sheenColorFactor", &Material::sheen_color},
    {khr_specular, "specularColorFactor", &Material::specular_color},
    {khr_volume, "attenuationColor", &Material::attenuation_color}};

/// The material that "/materials/INDEX/PROPERTY" names, with the property.
std::optional<std::pair<size_t, std::string_view>> split_pointer(std::string_view pointer) {
    constexpr std::string_view start = "/materials/";
    if (!pointer.starts_with(start)) return {};
    pointer.remove_prefix(start.size());
    size_t index = 0;
    const char* end = pointer.data() + pointer.size();
    const auto read = std::from_chars(pointer.data(), end, index);
    if (read.ec != std::errc() || read.ptr == end || *read.ptr != '/') return {};
    return std::pair(index, std::string_view(read.ptr + 1, size_t(end - read.ptr - 1)));
}

Vec3 vec3_at(const double* v) {
    return Vec3d(v).cast<float>();
}

std::vector<double> three_of(const Vec3& v) {
    return {double(v[0]), double(v[1]), double(v[2])};
}

}  // namespace

std::optional<GltfMaterialPointers::Place> GltfMaterialPointers::number_or_color(
    const Material& material, std::string_view property) const {
    for (const auto& number : pointed_numbers) {
        if (!number.is_named(property)) continue;
        const bool turns = number.value == &Material::anisotropy_rotation_deg;
        const double unit = turns ? degrees(1.0) : 1.0;
        Group group{std::string(property), {double(material.*number.value) / unit}, {}};
        group.put = [value = number.value, unit](const double* v, Material& m) {
            m.*value = float(*v * unit);
        };
        return Place{std::move(group), 0, 1};
    }
    for (const auto& color : pointed_colors) {
        if (!color.is_named(property)) continue;
        Group group{std::string(property), three_of(material.*color.value), {}};
        group.put = [value = color.value](const double* v, Material& m) { m.*value = vec3_at(v); };
        return Place{std::move(group), 0, 3};
    }
    if (property != "pbrMetallicRoughness/baseColorFactor") return {};
    Group group{std::string(property), three_of(material.base_color), {}};
    group.at_rest.push_back(double(material.opacity));
    group.put = [](const double* v, Material& m) {
        m.base_color = vec3_at(v);
        m.base_color_given = true;
        m.opacity = float(v[3]);
    };
    return Place{std::move(group), 0, 4};
}

GltfMaterialPointers::Place GltfMaterialPointers::emission(const Json& json, bool strength) const {
    Group group{"emission", {0, 0, 0}, {}};
    if (const auto factor = document_.numbers(json, "emissiveFactor", 3)) group.at_rest = *factor;
    const Json* given = extension(json, khr_emissive_strength);
    group.at_rest.push_back(given ? document_.number(*given, "emissiveStrength", 1) : 1.0);
    group.put = [](const double* v, Material& m) { m.emissive = vec3_at(v) * float(v[3]); };
    return {std::move(group), strength ? 3 : 0, strength ? 1 : 3};
}

std::optional<GltfMaterialPointers::Place> GltfMaterialPointers::texture_transform(
    const Json& json, std::string_view property) const {
    constexpr std::string_view middle = "/extensions/KHR_texture_transform/";
    const size_t found = property.find(middle);
    if (found == property.npos) return {};
    const std::string texture(property.substr(0, found));
    const std::string_view part = property.substr(found + middle.size());
    std::vector<Texture Material::*> targets;
    for (const auto& [path, target] : gltf_texture_places())
        if (path == texture) targets.push_back(target);
    if (targets.empty() || (part != "offset" && part != "scale" && part != "rotation")) return {};
    const Json::json_pointer at("/" + texture + "/extensions/KHR_texture_transform");
    GltfTextureTransform rest;
    if (json.contains(at)) rest = read_texture_transform(document_, json.at(at));
    Group group{texture, {rest.offset[0], rest.offset[1], rest.scale[0], rest.scale[1], rest.rotation}, {}};
    group.put = [targets](const double* v, Material& m) {
        const GltfTextureTransform transform{Vec2d(v), Vec2d(v + 2), v[4]};
        for (Texture Material::*target : targets) (m.*target).uv_transform = transform.matrix();
    };
    const int first = part == "offset" ? 0 : part == "scale" ? 2 : 4;
    return Place{std::move(group), first, part == "rotation" ? 1 : 2};
}

std::optional<GltfMaterialPointers::Place> GltfMaterialPointers::place_of(size_t material,
                                                                          std::string_view property) const {
    const Json& json = document_.item("materials", material);
    if (property == "emissiveFactor") return emission(json, false);
    if (property == fmt::format("extensions/{}/emissiveStrength", khr_emissive_strength))
        return emission(json, true);
    if (auto place = number_or_color(materials_.material(material), property)) return place;
    return texture_transform(json, property);
}

GltfMaterialPointers::Animated& GltfMaterialPointers::entry(size_t material) {
    if (const auto known = animated(material)) return animated_[*known];
    animated_.push_back({material, {}});
    return animated_.back();
}

std::optional<GltfMaterialTarget> GltfMaterialPointers::find(std::string_view pointer) {
    const auto named = split_pointer(pointer);
    if (!named) return {};
    auto place = place_of(named->first, named->second);
    if (!place) return {};
    Animated& animated = entry(named->first);
    GltfMaterialTarget target{int(&animated - animated_.data()), place->first, place->width};
    for (const Group& group : animated.groups) {
        if (group.name == place->group.name) return target;
        target.parameter += int(group.at_rest.size());
    }
    animated.groups.push_back(std::move(place->group));
    return target;
}

std::optional<size_t> GltfMaterialPointers::animated(size_t material) const {
    const auto found = std::ranges::find(animated_, material, &Animated::material);
    if (found == animated_.end()) return {};
    return size_t(found - animated_.begin());
}

std::vector<AnimatedMaterial> GltfMaterialPointers::materials() const {
    std::vector<AnimatedMaterial> out;
    for (const Animated& animated : animated_) {
        AnimatedMaterial& to = out.emplace_back();
        for (const Group& group : animated.groups)
            to.parameters.insert(to.parameters.end(), group.at_rest.begin(), group.at_rest.end());
        to.material = [groups = animated.groups,
                       rest = materials_.material(animated.material)](const std::vector<double>& parameters) {
            Material material = rest;
            const double* values = parameters.data();
            for (const Group& group : groups) {
                group.put(values, material);
                values += group.at_rest.size();
            }
            // Splines may leave the range between two keys.
            clamp_to_ranges(material);
            return material;
        };
    }
    return out;
}

}  // namespace easypbr::io
