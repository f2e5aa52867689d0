#include "easypbr/gui/imgui_widgets.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "easypbr/gui/gui_scope.h"
#include "easypbr/gui/widgets.h"

namespace easypbr::gui {
namespace {

constexpr float plot_height = 72;

/// A curve in a frame. Where several values share a column of pixels it covers all of them.
void draw_curve(std::span<const float> values, const Vec2& range, ImVec2 from, ImVec2 to) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 color = ImGui::GetColorU32(ImGuiCol_PlotLines);
    const float width = to.x - from.x, count = float(std::max<size_t>(values.size(), 2) - 1);
    const auto place = [&](size_t i) {
        const float t = std::clamp((values[i] - range.x()) / (range.y() - range.x()), 0.0f, 1.0f);
        return ImVec2(from.x + width * float(i) / count, to.y - t * (to.y - from.y));
    };
    if (values.size() == 1 && std::isfinite(values[0])) list.AddCircleFilled(place(0), 2, color);
    if (float(values.size()) <= 2 * width) {
        for (size_t i = 0; i + 1 < values.size(); ++i)
            if (std::isfinite(values[i]) && std::isfinite(values[i + 1]))
                list.AddLine(place(i), place(i + 1), color, 1.5f);
        return;
    }
    const size_t columns = size_t(width);
    for (size_t column = 0; column < columns; ++column) {
        const size_t begin = column * values.size() / columns, end = (column + 1) * values.size() / columns;
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (size_t i = begin; i < std::min(end + 1, values.size()); ++i) {
            if (!std::isfinite(values[i])) continue;
            low = std::min(low, place(i).y);
            high = std::max(high, place(i).y);
        }
        const float x = from.x + float(column);
        if (low <= high) list.AddLine(ImVec2(x, low), ImVec2(x, high + 1), color);
    }
}

}  // namespace

/// The name on the left, the widget on the right, under an id of its own.
class ImGuiWidgets::Row {
  public:
    Row(ImGuiWidgets& widgets, const std::string& name)
        : scope_(widgets.context_), widgets_(widgets), name_(name) {
        ImGui::PushID(name.c_str());
        ImGui::PushID(widgets.used_[name]++);
    }
    ~Row() {
        if (in_table_) end_rows();
        ImGui::PopID();
        ImGui::PopID();
    }
    Row(const Row&) = delete;
    Row& operator=(const Row&) = delete;

    /// To the place of the value; false where it is not seen.
    bool begin() {
        in_table_ = begin_rows("row", false);
        if (in_table_) begin_row(name_);
        return in_table_;
    }
    bool changed(bool value) {
        note_place(widgets_.panel_ + "/" + name_);
        return value;
    }

  private:
    GuiScope scope_;
    ImGuiWidgets& widgets_;
    const std::string& name_;
    bool in_table_ = false;
};

void ImGuiWidgets::text(const std::string& text) {
    const GuiScope scope(context_);
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

void ImGuiWidgets::separator() {
    const GuiScope scope(context_);
    ImGui::Separator();
}

void ImGuiWidgets::same_line() {
    const GuiScope scope(context_);
    ImGui::SameLine();
}

bool ImGuiWidgets::section(const std::string& title, bool open) {
    Row row(*this, title);
    return row.changed(heading(title.c_str(), open));
}

bool ImGuiWidgets::button(const std::string& name) {
    Row row(*this, name);
    return row.changed(ImGui::Button(name.c_str()));
}

bool ImGuiWidgets::checkbox(const std::string& name, bool& value) {
    Row row(*this, name);
    return row.begin() && row.changed(ImGui::Checkbox("##value", &value));
}

bool ImGuiWidgets::draw_slider(const std::string& name, double& value, double low, double high) {
    Row row(*this, name);
    return row.begin() && row.changed(ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &low,
                                                          &high, "%.4g", ImGuiSliderFlags_AlwaysClamp));
}

bool ImGuiWidgets::draw_slider(const std::string& name, int& value, int low, int high) {
    Row row(*this, name);
    return row.begin() &&
           row.changed(ImGui::SliderInt("##value", &value, low, high, "%d", ImGuiSliderFlags_AlwaysClamp));
}

bool ImGuiWidgets::draw_number(const std::string& name, double& value) {
    Row row(*this, name);
    const float speed = float(std::max(std::abs(value), 1e-3) * 0.01);
    double typed = value;
    const bool changed = row.begin() &&
                         row.changed(ImGui::DragScalar("##value", ImGuiDataType_Double, &typed, speed,
                                                       nullptr, nullptr, "%.6g")) &&
                         std::isfinite(typed);
    if (changed) value = typed;
    return changed;
}

bool ImGuiWidgets::draw_combo(const std::string& name, std::string& value,
                              const std::vector<std::string>& choices) {
    Row row(*this, name);
    if (!row.begin()) return false;
    const bool open = ImGui::BeginCombo("##value", value.c_str());
    row.changed(false);
    if (!open) return false;
    bool changed = false;
    for (size_t i = 0; i < choices.size(); ++i) {
        ImGui::PushID(int(i));
        if (ImGui::Selectable(choices[i].c_str(), choices[i] == value)) {
            value = choices[i];
            changed = true;
        }
        note_place(panel_ + "/" + name + "/" + choices[i]);
        ImGui::PopID();
    }
    ImGui::EndCombo();
    return changed;
}

bool ImGuiWidgets::text_field(const std::string& name, std::string& value) {
    Row row(*this, name);
    return row.begin() && row.changed(ImGui::InputText("##value", &value));
}

bool ImGuiWidgets::draw_color(const std::string& name, Vec3& value) {
    Row row(*this, name);
    return row.begin() &&
           row.changed(ImGui::ColorEdit3("##value", value.data(),
                                         ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoInputs));
}

void ImGuiWidgets::draw_plot(const std::string& name, std::span<const float> values, const Vec2& range) {
    const Row row(*this, name);
    ImGui::TextUnformatted(name.c_str());
    if (!values.empty()) {
        const std::string last = fmt::format("{:.4g}", values.back());
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(last.c_str()).x);
        ImGui::TextUnformatted(last.c_str());
    }
    const ImVec2 size(std::max(ImGui::GetContentRegionAvail().x, 20.0f), plot_height * scale_);
    const ImVec2 from = ImGui::GetCursorScreenPos(), to(from.x + size.x, from.y + size.y);
    ImGui::Dummy(size);
    note_place(panel_ + "/" + name);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    const float pad = 3 * scale_;
    draw_curve(values, range, ImVec2(from.x + pad, from.y + pad), ImVec2(to.x - pad, to.y - pad));
    const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    list.AddText(ImVec2(from.x + pad, from.y), dim, fmt::format("{:.4g}", range.y()).c_str());
    list.AddText(ImVec2(from.x + pad, to.y - ImGui::GetTextLineHeight()), dim,
                 fmt::format("{:.4g}", range.x()).c_str());
}

void ImGuiWidgets::draw_progress(double fraction, const std::string& text) {
    const GuiScope scope(context_);
    ImGui::ProgressBar(float(fraction), ImVec2(-FLT_MIN, 0), text.empty() ? nullptr : text.c_str());
}

}  // namespace easypbr::gui
