// The tools that change what is in the scene: an object's look, the lights.
#include <fmt/format.h>

#include "easypbr/app/light_edits.h"
#include "easypbr/app/vertex_edits.h"
#include "easypbr/core/color.h"
#include "easypbr/remote/describe.h"
#include "easypbr/remote/tool_panels.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

/// A field's name as it is read: "exposure compensation".
std::string readable(std::string name) {
    for (char& letter : name)
        if (letter == '_') letter = ' ';
    return name;
}

// ---- object

void change_materials(app::LiveDrawing& live, const std::string& name, const Value& value) {
    live.edits().change_look(live.selection().object, "material." + name, value);
}

/// Colours that were chosen as codes of 8 bits are shown as these: the curve and back rounds them by up to
/// 1e-6.
Vec3 shown_color(const Vec3& linear) {
    const Vec3 srgb = srgb_from_linear(linear.cwiseMin(1.0f));
    const Rgb8 codes = to_rgb8(srgb);
    const Vec3 code = Vec3(codes[0], codes[1], codes[2]) / 255.0f;
    return (srgb - code).cwiseAbs().maxCoeff() < 1e-5f ? code : srgb;
}

void color_row(RecordedWidgets& ui, app::LiveDrawing& live, const Material& material,
               const MaterialColor& color) {
    FieldInfo info;
    info.name = std::string("material.") + color.name;
    info.doc = color.doc;
    info.type = FieldType::color;
    info.min = 0;
    info.max = 1;
    info.sizes = {3};
    const Vec3 shown = shown_color(material.*color.value);
    const auto chosen =
        ui.field(readable(color.name), info, {std::vector<double>{shown[0], shown[1], shown[2]}});
    if (!chosen) return;
    const auto& srgb = std::get<std::vector<double>>(chosen->data);
    const Vec3 linear = linear_from_srgb(Vec3(float(srgb[0]), float(srgb[1]), float(srgb[2])));
    change_materials(live, color.name, {std::vector<double>{linear[0], linear[1], linear[2]}});
}

void number_row(RecordedWidgets& ui, app::LiveDrawing& live, const Material& material,
                const MaterialNumber& number) {
    FieldInfo info;
    info.name = std::string("material.") + number.name;
    info.doc = number.doc;
    info.min = number.min;
    info.max = number.max;
    const auto chosen = ui.field(readable(number.name), info, {double(material.*number.value)});
    if (!chosen) return;
    change_materials(live, number.name, *chosen);
}

void material_rows(RecordedWidgets& ui, app::LiveDrawing& live, const Material& material) {
    for (const MaterialColor& color : material_colors()) color_row(ui, live, material, color);
    for (const MaterialNumber& number : material_numbers()) number_row(ui, live, material, number);
}

/// What an object's own style follows.
std::optional<Value> followed(const Field& field, const Settings& settings) {
    Value value = field.get(settings);
    if (value.state != Value::State::given && !value.latched) return {};
    value.state = Value::State::given;
    return value;
}

void style_rows(RecordedWidgets& ui, app::LiveDrawing& live, const Style& style) {
    const std::string prefix = "style.";
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix) || !is_open(field)) continue;
        const std::string name = field.name.substr(prefix.size());
        const auto chosen =
            ui.field(readable(name), field, get(style, name), followed(field, live.session().settings()));
        if (!chosen) continue;
        live.edits().change_look(live.selection().object, field.name, *chosen);
    }
}

// ---- lights

void settings_rows(RecordedWidgets& ui, app::LiveDrawing& live, const std::string& prefix) {
    Settings& settings = live.session().settings();
    for (const Field& field : fields()) {
        if (!field.name.starts_with(prefix) || !is_open(field)) continue;
        const std::string name = readable(field.name.substr(prefix.size()));
        if (const auto chosen = ui.field(name, field, field.get(settings)))
            set(settings, field.name, *chosen);
    }
}

void light_rows(RecordedWidgets& ui, app::LiveDrawing& live, const std::string& name) {
    const Light before = live.session().scene().light(name);
    Light light = before;
    for (const LightField& field : light_fields()) {
        if (!field.concerns(light.type)) continue;
        const auto chosen = ui.field(readable(field.name), app::shown_field(field),
                                     app::shown_value(field, light), app::inferred_value(live, name, field));
        if (chosen) app::put_shown(field, light, *chosen);
    }
    if (!(light == before)) app::change_light(live, name, light);
    if (ui.button("Remove " + name)) app::remove_light(live, name);
}

}  // namespace

void object_tool(RecordedWidgets& ui, ToolState& state) {
    app::LiveDrawing& live = state.live;
    const auto mesh = app::node_named(live.session().scene(), live.selection().object);
    if (!mesh) return ui.text("Click an object to select it.");
    ui.text(live.selection().object);
    const auto data = mesh->snapshot();
    if (data->materials.size() > 1)
        ui.text(fmt::format("{} materials: the first is shown, all are changed", data->materials.size()));
    app::vertex_tool(ui, live);
    if (ui.section("Material", true)) material_rows(ui, live, mesh->material());
    if (ui.section("Style", false)) style_rows(ui, live, mesh->style());
}

void lights_tool(RecordedWidgets& ui, ToolState& state) {
    app::LiveDrawing& live = state.live;
    for (const auto& [title, name] : {std::pair("Key", "key"), {"Fill", "fill"}, {"Rim", "rim"}})
        if (ui.section(title, false)) settings_rows(ui, live, fmt::format("lights.{}.", name));
    for (const std::string& name : live.session().scene().light_names())
        if (ui.section(name, true)) light_rows(ui, live, name);
    if (live.session().scene().names().empty()) return;
    if (ui.button("Add a light")) app::add_light(live);
}

}  // namespace easypbr::remote
