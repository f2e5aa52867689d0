#include "easypbr/gui/widgets.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/math.h"

namespace easypbr::gui {
namespace {

/// Ranges that a slider of one line can choose from; others are dragged.
constexpr double widest_slider = 1000;

std::string limit_text(double value) {
    return std::abs(value) > 1e29 ? std::string() : fmt::format("{:g}", value);
}

bool edit_number(const FieldInfo& field, double& value) {
    // In double precision: the float nearest to a limit may lie beyond it.
    const double low = std::max(field.min, -1e30), high = std::min(field.max, 1e30);
    const ImGuiDataType type = ImGuiDataType_Double;
    const ImGuiSliderFlags clamp = ImGuiSliderFlags_AlwaysClamp;
    const bool whole = field.whole || field.type == FieldType::integer;
    const char* format = whole ? "%.0f" : std::abs(value) >= 1000 ? "%.1f" : "%.3g";
    bool changed = false;
    if (high - low <= widest_slider) {
        changed = ImGui::SliderScalar("##value", type, &value, &low, &high, format, clamp);
    } else {
        const float speed = whole ? 1.0f : float(std::max(std::abs(value), 1e-4)) * 0.01f;
        changed = ImGui::DragScalar("##value", type, &value, speed, &low, &high, format, clamp);
    }
    if (changed && whole) value = std::round(value);
    return changed;
}

bool edit_choice(const FieldInfo& field, std::string& value) {
    bool changed = false;
    if (!ImGui::BeginCombo("##value", readable(value).c_str())) return false;
    for (const std::string& choice : field.choices)
        if (ImGui::Selectable(readable(choice).c_str(), choice == value)) {
            value = choice;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

/// A list of the names, and colours that are typed in.
bool edit_colormap(const FieldInfo& field, std::string& value) {
    bool changed = false;
    if (!ImGui::BeginCombo("##value", value.c_str(), ImGuiComboFlags_HeightLarge)) return false;
    std::string typed = value.starts_with('#') ? value : std::string();
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (ImGui::InputTextWithHint("##colors", "#000080,#ffffff,#800000", &typed,
                                 ImGuiInputTextFlags_EnterReturnsTrue)) {
        value = typed;
        changed = true;
        ImGui::CloseCurrentPopup();
    }
    for (const std::string& name : field.choices)
        if (ImGui::Selectable(name.c_str(), name == value)) {
            value = name;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

bool edit_color(std::vector<double>& value) {
    float rgb[3] = {0, 0, 0};
    for (size_t i = 0; i < 3 && i < value.size(); ++i) rgb[i] = float(value[i]);
    if (!ImGui::ColorEdit3("##value", rgb, ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoInputs))
        return false;
    value.assign(rgb, rgb + 3);
    return true;
}

/// As many decimals for all of a vector as its largest number leaves room for.
const char* format_for(double largest) {
    if (largest < 0.01 || largest >= 1000) return "%.3g";
    return largest < 10 ? "%.3f" : largest < 100 ? "%.2f" : "%.1f";
}

bool edit_list(const FieldInfo& field, std::vector<double>& value) {
    if (value.size() < 2 || value.size() > 4) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled(value.empty() ? "none" : "%d numbers", int(value.size()));
        return false;
    }
    double largest = 1e-4;
    for (const double v : value) largest = std::max(largest, std::abs(v));
    const bool whole = field.whole;
    // Three numbers side by side need the room.
    const ImGuiStyle& style = ImGui::GetStyle();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemInnerSpacing,
                        ImVec2(style.ItemInnerSpacing.x / 3, style.ItemInnerSpacing.y));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(style.FramePadding.x / 3, style.FramePadding.y));
    const bool changed =
        ImGui::DragScalarN("##value", ImGuiDataType_Double, value.data(), int(value.size()),
                           whole ? 1.0f : float(largest) * 0.005f, &field.min, &field.max,
                           whole ? "%.0f" : format_for(largest), ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopStyleVar(2);
    return changed;
}

/// The widget of a field's type. Returns whether the person changed the data.
bool edit(const FieldInfo& field, Value::Data& data) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (auto* flag = std::get_if<bool>(&data)) return ImGui::Checkbox("##value", flag);
    if (auto* number = std::get_if<double>(&data)) return edit_number(field, *number);
    if (auto* list = std::get_if<std::vector<double>>(&data))
        return field.type == FieldType::color ? edit_color(*list) : edit_list(field, *list);
    auto& text = std::get<std::string>(data);
    if (field.type == FieldType::colormap) return edit_colormap(field, text);
    if (!field.choices.empty()) return edit_choice(field, text);
    std::string typed = text;
    if (!ImGui::InputTextWithHint("##value", "none", &typed, ImGuiInputTextFlags_EnterReturnsTrue))
        return false;
    text = typed;
    return true;
}

void automatic_tick(const Value& value, const Value& shown, const std::function<void(const Value&)>& put) {
    const bool automatic = value.state != Value::State::given;
    ImGui::TableNextColumn();
    // A word instead of a box, which would look like a value beside boxes that are values.
    const ImVec4 color = ImGui::GetStyleColorVec4(automatic ? ImGuiCol_CheckMark : ImGuiCol_TextDisabled);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(2, ImGui::GetStyle().FramePadding.y));
    if (ImGui::Button("auto")) {
        if (!automatic)
            put({{}, Value::State::automatic});
        else
            put({shown.data});
    }
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(2);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", automatic ? "Automatic; click to choose the value yourself"
                                          : "Chosen; click to have it inferred again");
}

}  // namespace

std::string readable(const std::string& name) {
    std::string text = name;
    std::replace(text.begin(), text.end(), '_', ' ');
    if (text.ends_with(" deg")) text.resize(text.size() - 4);
    return text;
}

std::string tooltip_of(const FieldInfo& field) {
    std::string text = field.doc;
    const std::string low = limit_text(field.min), high = limit_text(field.max);
    const bool is_number = field.type == FieldType::number || field.type == FieldType::integer;
    if (is_number && (!low.empty() || !high.empty()))
        text += low.empty()    ? fmt::format("\nat most {}", high)
                : high.empty() ? fmt::format("\nat least {}", low)
                               : fmt::format("\n{} to {}", low, high);
    if (!field.unit.empty()) text += "\nunit: " + field.unit;
    return text + "\n" + field.name;
}

bool begin_rows(const char* id, bool with_auto) {
    if (!ImGui::BeginTable(id, with_auto ? 3 : 2, ImGuiTableFlags_NoSavedSettings)) return false;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 0.55f);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.45f);
    if (with_auto)
        ImGui::TableSetupColumn("auto", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("auto").x + 5);
    return true;
}

void end_rows() {
    ImGui::EndTable();
}

void begin_row(const std::string& name, const std::string& tooltip) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name.c_str());
    if (!tooltip.empty() && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 22);
        ImGui::TextUnformatted(tooltip.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
}

void field_row(const FieldInfo& field, const Value& value, const std::optional<Value>& inferred,
               const std::function<void(const Value&)>& put) {
    ImGui::PushID(field.name.c_str());
    begin_row(readable(field.name.substr(field.name.rfind('.') + 1)), tooltip_of(field));
    const bool automatic = value.state != Value::State::given;
    Value shown = automatic && inferred ? *inferred : value;
    const bool known = !automatic || value.latched || (inferred && inferred->state == Value::State::given) ||
                       (inferred && inferred->latched);
    if (!known) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("own");
        if (!field.choices.empty()) shown.data = field.choices.front();
        if (field.type == FieldType::color) shown.data = std::vector<double>{0.8, 0.8, 0.8};
        if (field.type == FieldType::number || field.type == FieldType::integer)
            shown.data = std::clamp(0.5, field.min, field.max);
        if (field.type == FieldType::text) shown.data = std::string();
    } else {
        if (automatic) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.6f * ImGui::GetStyle().Alpha);
        const bool changed = edit(field, shown.data);
        note_place(field.name);
        if (changed) put({shown.data});
        if (automatic) ImGui::PopStyleVar();
    }
    if (field.can_be_automatic) automatic_tick(value, shown, put);
    ImGui::PopID();
}

bool heading(const char* text, bool open) {
    const ImVec4 color = ImGui::GetStyleColorVec4(ImGuiCol_Header);
    ImGui::PushStyleColor(ImGuiCol_Header, color);
    const bool result = ImGui::CollapsingHeader(text, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    ImGui::PopStyleColor();
    return result;
}

void note_place(const std::string& name) {
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    (*static_cast<ItemPlaces*>(ImGui::GetIO().UserData))[name] = {Vec2d(from.x, from.y), Vec2d(to.x, to.y)};
}

bool named_button(const char* panel, const char* name, float width, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    const bool clicked = ImGui::Button(name, ImVec2(width, 0));
    ImGui::EndDisabled();
    note_place(fmt::format("{}/{}", panel, name));
    return clicked;
}

void dim_text(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
}

}  // namespace easypbr::gui
