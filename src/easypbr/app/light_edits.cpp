#include "easypbr/app/light_edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/color.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

std::string free_light_name(const Scene& scene) {
    const std::vector<std::string> names = scene.light_names();
    std::string name = "light";
    for (int number = 2; std::ranges::find(names, name) != names.end(); ++number)
        name = fmt::format("light-{}", number);
    return name;
}

Light light_beside(const ViewPoint& view) {
    Light light;
    const Vec3d offset = view.camera.T_world_cam.linear() * Vec3d(0.5, 0.5, 0.5) * view.distance();
    light.position = view.target + offset;
    light.intensity = float(3 * offset.squaredNorm());
    return light;
}

Vec3 color_of(const Value& value) {
    const auto& channels = std::get<std::vector<double>>(value.data);
    return Vec3(float(channels[0]), float(channels[1]), float(channels[2]));
}

Value value_of(const Vec3& color) {
    return {std::vector<double>{color[0], color[1], color[2]}};
}

}  // namespace

void add_light(LiveDrawing& live) {
    const std::string name = free_light_name(live.session().scene());
    change_light(live, name, light_beside(live.session().view_point(live.size())));
    live.selection().light = name;
    live.selection().object.clear();
}

void change_light(LiveDrawing& live, const std::string& name, const Light& light) {
    live.edits().will_change_light(name);
    live.session().scene().set_light(name, light);
}

void remove_light(LiveDrawing& live, const std::string& name) {
    live.edits().will_change_light(name);
    live.session().scene().remove_light(name);
    if (live.selection().light == name) live.selection().light.clear();
}

FieldInfo shown_field(const LightField& field) {
    FieldInfo info = field;
    if (field.is_color) info.type = FieldType::color;
    return info;
}

Value shown_value(const LightField& field, const Light& light) {
    return field.is_color ? value_of(srgb_from_linear(light.color)) : field.get(light);
}

void put_shown(const LightField& field, Light& light, const Value& shown) {
    const Light before = light;
    field.put(light, field.is_color ? value_of(linear_from_srgb(color_of(shown))) : shown);
    // One on its way through zero would be none.
    if (!(light.direction.norm() > 1e-6f)) light.direction = before.direction;
}

std::optional<Value> inferred_value(const LiveDrawing& live, const std::string& light,
                                    const LightField& field) {
    const ResolvedSettings* resolved = live.picture().resolved();
    if (!field.can_be_automatic || !resolved || !resolved->light_radii.contains(light)) return {};
    return Value{double(resolved->light_radii.at(light))};
}

}  // namespace easypbr::app
