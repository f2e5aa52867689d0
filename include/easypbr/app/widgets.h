// Widgets: what a program's own panels are made of. A window draws them with Dear ImGui; another front end
// draws them in its own way.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "easypbr/core/math.h"

namespace easypbr::app {

/// A panel from top to bottom, called again for every frame of it. A widget that a person has changed since
/// the last frame returns true and has the new value put into `value`. Names need not be different from each
/// other. All throw ArgumentError for values that cannot be shown: numbers that are not finite, empty ranges,
/// no choices.
class Widgets {
  public:
    virtual ~Widgets() = default;
    Widgets(const Widgets&) = delete;
    Widgets& operator=(const Widgets&) = delete;

    /// A paragraph.
    virtual void text(const std::string& text) = 0;
    virtual void separator() = 0;
    /// The next widget stands beside the last one, where both are buttons or texts.
    virtual void same_line() = 0;
    /// A heading that folds what follows: draw it only when this returns true. `open` is how it begins.
    virtual bool section(const std::string& title, bool open = true) = 0;

    /// True when it was clicked.
    virtual bool button(const std::string& name) = 0;
    virtual bool checkbox(const std::string& name, bool& value) = 0;
    virtual bool text_field(const std::string& name, std::string& value) = 0;

    /// A number in a range; what lies outside is brought inside once a person moves it. Limits within 1e300.
    bool slider(const std::string& name, double& value, double low, double high);
    /// Limits within 2^30.
    bool slider(const std::string& name, int& value, int low, int high);
    /// A number without a range.
    bool number(const std::string& name, double& value);
    /// One of `choices`; a value that is none of them is shown all the same.
    bool combo(const std::string& name, std::string& value, const std::vector<std::string>& choices);
    /// sRGB, 0 to 1.
    bool color(const std::string& name, Vec3& value);

    /// A curve through values; those that are not finite leave gaps. `range` is what the height shows, within
    /// 1e30: by default all of them.
    void plot(const std::string& name, std::span<const float> values,
              const std::optional<Vec2>& range = std::nullopt);
    /// A bar, `fraction` of it filled: 0 to 1, what lies outside is brought inside.
    void progress(double fraction, const std::string& text = {});

  protected:
    Widgets() = default;

  private:
    // What a front end draws, with values that have been checked.
    virtual bool draw_slider(const std::string& name, double& value, double low, double high) = 0;
    virtual bool draw_slider(const std::string& name, int& value, int low, int high) = 0;
    virtual bool draw_number(const std::string& name, double& value) = 0;
    virtual bool draw_combo(const std::string& name, std::string& value,
                            const std::vector<std::string>& choices) = 0;
    virtual bool draw_color(const std::string& name, Vec3& value) = 0;
    /// `range` is never empty.
    virtual void draw_plot(const std::string& name, std::span<const float> values, const Vec2& range) = 0;
    virtual void draw_progress(double fraction, const std::string& text) = 0;
};

}  // namespace easypbr::app
