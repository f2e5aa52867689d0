#include "easypbr/app/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {
namespace {

constexpr const char *style_prefix = "style.", *material_prefix = "material.";

struct MaterialAccess {
    std::function<Value(const Material&)> get;
    std::function<void(Material&, const Value&)> put;
};

MaterialAccess access_to(float Material::*number) {
    return {[number](const Material& material) { return Value{double(material.*number)}; },
            [number](Material& material, const Value& value) {
                material.*number = float(std::get<double>(value.data));
            }};
}

MaterialAccess access_to(Vec3 Material::*color) {
    return {[color](const Material& material) {
                const Vec3d rgb = (material.*color).cast<double>();
                return Value{std::vector<double>{rgb[0], rgb[1], rgb[2]}};
            },
            [color](Material& material, const Value& value) {
                const auto& rgb = std::get<std::vector<double>>(value.data);
                material.*color = Vec3d(rgb[0], rgb[1], rgb[2]).cast<float>();
            }};
}

MaterialAccess material_access(const std::string& property) {
    if (property.starts_with(material_prefix)) {
        const std::string name = property.substr(std::strlen(material_prefix));
        for (const MaterialNumber& number : material_numbers())
            if (number.name == name) return access_to(number.value);
        for (const MaterialColor& color : material_colors())
            if (color.name == name) return access_to(color.value);
    }
    std::vector<std::string> names;
    for (const MaterialNumber& number : material_numbers())
        names.push_back(fmt::format("{}{}", material_prefix, number.name));
    for (const MaterialColor& color : material_colors())
        names.push_back(fmt::format("{}{}", material_prefix, color.name));
    throw NameError(fmt::format("a look has no '{}'{}", property, did_you_mean(property, names)));
}

}  // namespace

std::vector<Value> look_values(const MeshData& data, const std::string& property) {
    if (property.starts_with(style_prefix)) {
        Settings settings;
        settings.style = data.style;
        return {field(property).get(settings)};
    }
    const MaterialAccess access = material_access(property);
    if (data.materials.empty()) return {access.get(Material())};
    std::vector<Value> values;
    for (const Material& material : data.materials) values.push_back(access.get(material));
    return values;
}

void set_look(MeshData& data, const std::string& property, const std::vector<Value>& values) {
    if (values.empty()) return;
    if (property.starts_with(style_prefix)) {
        Settings settings;
        settings.style = data.style;
        field(property).put(settings, values.front());
        data.style = settings.style;
        return;
    }
    const MaterialAccess access = material_access(property);
    if (data.materials.empty()) data.materials.emplace_back();
    const size_t count = std::min(values.size(), data.materials.size());
    for (size_t i = 0; i < count; ++i) access.put(data.materials[i], values[i]);
}

void set_look(MeshData& data, const std::string& property, const Value& value) {
    if (property.starts_with(style_prefix))
        return set_look(data, property, std::vector{checked(field(property), value)});
    set_look(data, property, std::vector<Value>(std::max<size_t>(data.materials.size(), 1), value));
}

}  // namespace easypbr::app
