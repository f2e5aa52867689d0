// The widgets of a program's panels, drawn with Dear ImGui.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "easypbr/app/widgets.h"

struct ImGuiContext;

namespace easypbr::gui {

/// Of one panel in one frame. Each widget holds ImGui's lock only while it draws.
class ImGuiWidgets final : public app::Widgets {
  public:
    /// `scale`: pixels of the screen for a plain one.
    ImGuiWidgets(ImGuiContext* context, float scale, std::string panel)
        : context_(context), scale_(scale), panel_(std::move(panel)) {}

    void text(const std::string& text) override;
    void separator() override;
    void same_line() override;
    bool section(const std::string& title, bool open) override;
    bool button(const std::string& name) override;
    bool checkbox(const std::string& name, bool& value) override;
    bool text_field(const std::string& name, std::string& value) override;

  private:
    class Row;
    bool draw_slider(const std::string& name, double& value, double low, double high) override;
    bool draw_slider(const std::string& name, int& value, int low, int high) override;
    /// Dragged, or typed after a double click.
    bool draw_number(const std::string& name, double& value) override;
    bool draw_combo(const std::string& name, std::string& value,
                    const std::vector<std::string>& choices) override;
    bool draw_color(const std::string& name, Vec3& value) override;
    void draw_plot(const std::string& name, std::span<const float> values, const Vec2& range) override;
    void draw_progress(double fraction, const std::string& text) override;

    ImGuiContext* context_;
    float scale_;
    std::string panel_;
    std::map<std::string, int> used_;  ///< how often each name came already
};

}  // namespace easypbr::gui
