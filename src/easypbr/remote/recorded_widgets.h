// RecordedWidgets: a program's panel as data. What clients have changed goes in, what is to be shown comes
// out.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/app/user_panels.h"
#include "easypbr/remote/messages.h"
#include "easypbr/scene/fields.h"

namespace easypbr::remote {

/// Which widget of a panel: its name, and how many of that name come before it.
using WidgetPlace = std::pair<std::string, uint32_t>;

/// What is kept of a panel from one call to the next.
struct PanelMemory {
    std::map<WidgetPlace, std::string> edits;  ///< of clients, not yet seen by the panel's function
    std::map<WidgetPlace, bool> open;          ///< sections that a client has folded or unfolded
};

/// Values of edits that are none of the widget's kind are left out.
class RecordedWidgets final : public app::Widgets {
  public:
    /// The memory must outlive it.
    explicit RecordedWidgets(PanelMemory& memory);
    ~RecordedWidgets() override;

    void text(const std::string& text) override;
    void separator() override;
    void same_line() override;
    bool section(const std::string& title, bool open) override;
    bool button(const std::string& name) override;
    bool checkbox(const std::string& name, bool& value) override;
    bool text_field(const std::string& name, std::string& value) override;

    /// A row as the settings have them. Returns what a client has chosen, checked; what cannot be taken is
    /// left out, and one of problems(). `inferred` is shown while the value is automatic.
    std::optional<Value> field(const std::string& name, const FieldInfo& info, const Value& value,
                               const std::optional<Value>& inferred = std::nullopt);
    const std::vector<std::string>& problems() const { return problems_; }

    /// A list of widgets, from top to bottom.
    nlohmann::json take();

    /// More are not shown.
    static constexpr size_t most_widgets = 1000;
    /// Values of a curve; more of them become the lowest and the highest of each part.
    static constexpr size_t most_values = 512;

  private:
    bool draw_slider(const std::string& name, double& value, double low, double high) override;
    bool draw_slider(const std::string& name, int& value, int low, int high) override;
    bool draw_number(const std::string& name, double& value) override;
    bool draw_combo(const std::string& name, std::string& value,
                    const std::vector<std::string>& choices) override;
    bool draw_color(const std::string& name, Vec3& value) override;
    void draw_plot(const std::string& name, std::span<const float> values, const Vec2& range) override;
    void draw_progress(double fraction, const std::string& text) override;

    WidgetPlace place_of(const std::string& name);
    std::optional<std::string> edit_of(const WidgetPlace& place);
    void add(const char* kind, const WidgetPlace& place, nlohmann::json widget);

    struct Recorded;
    PanelMemory& memory_;
    std::unique_ptr<Recorded> recorded_;
    std::map<std::string, uint32_t> used_;
    std::vector<std::string> problems_;
};

/// What clients are told of a program's panels, each called once.
std::string panels_text(app::UserPanels& panels, std::map<std::string, PanelMemory>& memories);

}  // namespace easypbr::remote
