// Panels of users' own: what their functions draw with, and the windows that they are in.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/gui/state.h"

struct ImGuiContext;

namespace easypbr::gui {

/// What a panel is made of, from top to bottom. A widget that a person changes returns true and has the new
/// value put into `value`. Names need not be different from each other. All throw ArgumentError for values
/// that cannot be shown: numbers that are not finite, empty ranges, no choices.
class Widgets {
  public:
    Widgets(ImGuiContext* context, GuiState& state, std::string panel);

    /// A paragraph.
    void text(const std::string& text);
    void separator();
    /// The next widget stands beside the last one, where both are buttons or texts.
    void same_line();
    /// A heading that folds what follows: draw it only when this returns true.
    bool section(const std::string& title, bool open = true);

    /// True when it was clicked.
    bool button(const std::string& name);
    bool checkbox(const std::string& name, bool& value);
    /// A number in a range; what lies outside is brought inside once a person moves it.
    bool slider(const std::string& name, double& value, double low, double high);
    bool slider(const std::string& name, int& value, int low, int high);
    /// A number without a range: dragged, or typed after a double click.
    bool number(const std::string& name, double& value);
    bool combo(const std::string& name, std::string& value, const std::vector<std::string>& choices);
    bool text_field(const std::string& name, std::string& value);
    /// sRGB, 0 to 1.
    bool color(const std::string& name, Vec3& value);

    /// A curve through values; those that are not finite leave gaps. `range` is what the height shows: by
    /// default all of them.
    void plot(const std::string& name, std::span<const float> values,
              const std::optional<Vec2>& range = std::nullopt);
    /// A bar, `fraction` of it filled (0 to 1).
    void progress(double fraction, const std::string& text = {});

  private:
    class Row;

    ImGuiContext* context_;
    GuiState& state_;
    std::string panel_;
    std::map<std::string, int> used_;  ///< how often each name came already
};

using PanelFunction = std::function<void(Widgets&)>;

/// The panels and their windows, which a person may move, fold and close.
class UserPanels {
  public:
    /// A panel of the same name is replaced and shown again. Throws ArgumentError for a name without letters.
    void add(const std::string& name, PanelFunction function);
    /// Throws NameError when there is none.
    void remove(const std::string& name);
    bool empty() const { return panels_.empty(); }
    std::vector<std::string> names() const;
    /// What the function threw in the last frame; empty: nothing.
    std::map<std::string, std::string> errors() const;

    /// Draws all that are open, between ImGui's beginning and end of a frame. No lock of ImGui's is held
    /// while a function runs. What it throws is shown in its panel; the next frame calls it again.
    void draw(GuiState& state);
    /// A line for each in the menu of panels.
    void menu();

  private:
    struct Panel {
        std::string name;
        PanelFunction function;
        bool open = true;
        std::string error;  ///< of the last call
    };
    void draw_panel(GuiState& state, const std::string& name, float x, float y, bool rescaled);
    Panel* find(const std::string& name);

    std::vector<Panel> panels_;
    float scale_ = 0;  ///< of the last frame
};

}  // namespace easypbr::gui
