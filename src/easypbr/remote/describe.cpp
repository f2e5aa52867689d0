#include "easypbr/remote/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "easypbr/app/channels.h"
#include "easypbr/app/edits.h"
#include "easypbr/core/error.h"
#include "easypbr/scene/element_colors.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

using nlohmann::json;

/// Nodes that a scene's tree shows at most: a page with more could not be used.
constexpr size_t most_nodes = 5000;

std::string written(const json& message) {
    return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

const char* type_name(FieldType type) {
    switch (type) {
        case FieldType::boolean:
            return "boolean";
        case FieldType::integer:
            return "integer";
        case FieldType::number:
            return "number";
        case FieldType::color:
            return "color";
        case FieldType::vector:
            return "vector";
        case FieldType::text:
            return "text";
        case FieldType::choice:
            return "choice";
        case FieldType::colormap:
            return "colormap";
    }
    return "text";
}

json node_of(const Mesh& mesh, const std::string& path, size_t& left) {
    const auto data = mesh.snapshot();
    json node = {{"path", path},
                 {"visible", data->style.visible.value_or(true)},
                 {"vertices", data->V.rows()},
                 {"faces", data->F.rows()}};
    json children = json::array();
    for (const Mesh& child : data->children) {
        if (left == 0) break;
        --left;
        children.push_back(node_of(child, path + "/" + child.name(), left));
    }
    if (!children.empty()) node["children"] = std::move(children);
    return node;
}

/// A place on the mesh: rows of its arrays, and how much each counts.
struct Place {
    std::vector<std::pair<Eigen::Index, double>> faces, vertices;

    const std::vector<std::pair<Eigen::Index, double>>& in(PerElement element) const {
        return element == PerElement::face ? faces : vertices;
    }
};

/// Barycentric coordinates of a point in, or above, a triangle; the first corner where it has no area.
Vec3d weights_in(const std::array<Vec3d, 3>& corners, const Vec3d& point) {
    const Vec3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!(normal.squaredNorm() > 0)) return {1, 0, 0};
    const auto part = [&](const Vec3d& from, const Vec3d& to) {
        return (to - from).cross(point - from).dot(normal) / normal.squaredNorm();
    };
    return {part(corners[1], corners[2]), part(corners[2], corners[0]), part(corners[0], corners[1])};
}

Place place_of(const MeshData& data, const Eigen::Affine3d& T_world_mesh, const app::Pick& pick) {
    const auto row = Eigen::Index(pick.element);
    Place place;
    if (!pick.is_face && row >= 0 && row < data.V.rows()) place.vertices.emplace_back(row, 1);
    if (!pick.is_face || row < 0 || row >= data.F.rows()) return place;
    place.faces.emplace_back(row, 1);
    const auto vertex = [&](Eigen::Index i) { return Vec3d(data.V(i, 0), data.V(i, 1), data.V(i, 2)); };
    std::array<Vec3d, 3> corners;
    for (int k = 0; k < 3; ++k) corners[size_t(k)] = T_world_mesh * vertex(data.F(row, k));
    const Vec3d weights = weights_in(corners, pick.position);
    for (int k = 0; k < 3; ++k) place.vertices.emplace_back(data.F(row, k), weights[k]);
    return place;
}

std::optional<int32_t> label_at(const MeshData& data, const Place& place) {
    const auto& rows = place.in(element_of(data, data.L.rows()));
    if (data.L.empty() || rows.empty()) return {};
    return place.faces.empty() ? data.L(rows.front().first) : face_label(data, place.faces.front().first);
}

/// What the arrays say there: scalars of vertices go over a face as they are drawn, its label is that which
/// it is drawn with.
json values_at(const MeshData& data, const Place& place) {
    const auto rows_of = [&](Eigen::Index count) {
        auto rows = place.in(element_of(data, count));
        std::erase_if(rows, [&](const auto& each) { return each.first >= count; });
        return rows;
    };
    json values = json::object();
    if (const auto label = label_at(data, place)) {
        values["label"] = *label;
        const LabelClass* known = data.label_map ? data.label_map->find(*label) : nullptr;
        if (known) values["class"] = known->name;
    }
    for (const ScalarArray& scalar : data.scalars) {
        const auto rows = rows_of(scalar.values.rows());
        double value = 0;
        for (const auto& [row, weight] : rows) value += weight * scalar.values(row);
        if (!rows.empty() && std::isfinite(value)) values["scalars"][scalar.name] = value;
    }
    return values;
}

}  // namespace

json description_of(const FieldInfo& field) {
    json row = {{"name", field.name}, {"doc", field.doc}, {"type", type_name(field.type)}};
    if (!field.unit.empty()) row["unit"] = field.unit;
    if (field.can_be_automatic) row["auto"] = true;
    if (std::isfinite(field.min)) row["min"] = field.min;
    if (std::isfinite(field.max)) row["max"] = field.max;
    if (!field.choices.empty()) row["choices"] = field.choices;
    if (!field.sizes.empty()) row["sizes"] = field.sizes;
    if (field.whole) row["whole"] = true;
    if (field.name == "image.samples") row["max"] = most_client_samples;
    return row;
}

FieldText text_of(const FieldInfo& field, const Value& value) {
    if (value.state == Value::State::given) return {to_text(field, value), {}};
    FieldText text{value.state == Value::State::follow ? "follow" : "auto", {}};
    if (value.latched) {
        Value latched = value;
        latched.state = Value::State::given;
        text.latched = to_text(field, latched);
    }
    return text;
}

bool is_open(const FieldInfo& field) {
    static const std::set<std::string> texts = {"style.scalar", "annotation.title"};
    if (field.name.starts_with("limits.") || field.name.starts_with("load.") || field.name == "image.size")
        return false;
    return field.type != FieldType::text || !field.choices.empty() || texts.contains(field.name);
}

void check_client_value(const FieldInfo& field, const Value& value) {
    const auto* number = std::get_if<double>(&value.data);
    if (field.name == "image.samples" && number && *number > most_client_samples)
        throw ArgumentError(fmt::format("image.samples: a server draws at most {}", most_client_samples));
}

FieldTexts texts_of(const Settings& settings) {
    FieldTexts texts;
    for (const Field& field : fields())
        if (is_open(field)) texts[field.name] = text_of(field, field.get(settings));
    return texts;
}

FieldTexts changed(const FieldTexts& before, const FieldTexts& now) {
    FieldTexts changed;
    for (const auto& [name, text] : now) {
        const auto known = before.find(name);
        if (known == before.end() || known->second != text) changed[name] = text;
    }
    return changed;
}

std::string welcome_text(const std::string& session, bool watches_only) {
    json rows = json::array();
    for (const Field& field : fields())
        if (is_open(field)) rows.push_back(description_of(field));
    return written({{"kind", "welcome"},
                    {"session", session},
                    {"watches", watches_only},
                    {"channels", app::channel_names()},
                    {"fields", rows}});
}

std::string settings_text(const FieldTexts& changed) {
    json values = json::object();
    for (const auto& [name, text] : changed) {
        values[name] = {{"value", text.given}};
        if (!text.latched.empty()) values[name]["latched"] = text.latched;
    }
    return written({{"kind", "settings"}, {"values", values}});
}

std::string camera_message(const std::string& camera) {
    return written({{"kind", "camera"}, {"text", camera}});
}

std::string scene_text(const Scene& scene, const std::string& selected, const std::string& channel) {
    json nodes = json::array();
    size_t left = most_nodes;
    for (const std::string& name : scene.names()) {
        if (left == 0) break;
        --left;
        nodes.push_back(node_of(scene.get(name), name, left));
    }
    return written({{"kind", "scene"}, {"nodes", nodes}, {"selected", selected}, {"channel", channel}});
}

std::string control_text(const ControlReport& report) {
    return written({{"kind", "control"},
                    {"controls", report.controls},
                    {"taken", report.taken},
                    {"may", report.may_control},
                    {"clients", report.clients},
                    {"view", report.view},
                    {"own", report.may_have_own}});
}

std::string notice_text(const std::string& text, bool is_error) {
    return written({{"kind", "notice"}, {"text", text}, {"error", is_error}});
}

std::string pick_text(uint32_t id, const std::optional<app::Pick>& pick, const Scene& scene) {
    json message = {{"kind", "pick"}, {"id", id}, {"hit", pick.has_value()}};
    if (pick) {
        message["object"] = pick->object;
        message["part"] = pick->part;
        message["face"] = pick->is_face;
        message["element"] = pick->element;
        message["position"] = {pick->position.x(), pick->position.y(), pick->position.z()};
        message["depth"] = pick->depth;
        if (const auto node = app::node_named(scene, pick->object)) {
            const auto data = node->snapshot();
            message["values"] = values_at(*data, place_of(*data, node->T_world_mesh(), *pick));
        }
    }
    return written(message);
}

std::string animation_text(const std::vector<std::string>& names, size_t current, bool plays, double time_s,
                           double duration_s, double speed) {
    return written({{"kind", "animation"},
                    {"names", names},
                    {"current", current},
                    {"plays", plays},
                    {"time", time_s},
                    {"duration", duration_s},
                    {"speed", speed}});
}

std::string statistics_text(const StatisticsReport& report) {
    return written({{"kind", "statistics"},
                    {"frame_ms", report.drawing.frame_seconds * 1000},
                    {"frames", report.drawing.frames},
                    {"total", report.drawing.total},
                    {"width", report.drawing.size.x()},
                    {"height", report.drawing.size.y()},
                    {"pictures", report.drawing.pictures},
                    {"share", report.share},
                    {"latency_ms", report.latency_s * 1000},
                    {"software", report.software}});
}

}  // namespace easypbr::remote
