#include "easypbr/app/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"

namespace easypbr::app {
namespace {

void require_finite(const char* widget, const std::string& name, double value) {
    if (!std::isfinite(value))
        throw ArgumentError(fmt::format("{} '{}': expected a finite number, got {}", widget, name, value));
}

void require_range(const char* widget, const std::string& name, double low, double high, double limit) {
    if (!(low < high) || std::abs(low) > limit || std::abs(high) > limit)
        throw ArgumentError(
            fmt::format("{} '{}': expected a range from low to high within +-{:g}, got {:g} to {:g}", widget,
                        name, limit, low, high));
}

/// The lowest and the highest finite value; 0 and 1 without any.
Vec2 finite_range(std::span<const float> values) {
    Vec2 range(HUGE_VALF, -HUGE_VALF);
    for (const float value : values)
        if (std::isfinite(value)) range = {std::min(range.x(), value), std::max(range.y(), value)};
    if (range.x() > range.y()) return {0, 1};
    if (range.x() == range.y()) return {range.x() - 0.5f, range.y() + 0.5f};
    return range;
}

}  // namespace

bool Widgets::slider(const std::string& name, double& value, double low, double high) {
    require_finite("slider", name, value);
    require_range("slider", name, low, high, 1e300);
    return draw_slider(name, value, low, high);
}

bool Widgets::slider(const std::string& name, int& value, int low, int high) {
    require_range("slider", name, low, high, double(1 << 30));
    return draw_slider(name, value, low, high);
}

bool Widgets::number(const std::string& name, double& value) {
    require_finite("number", name, value);
    return draw_number(name, value);
}

bool Widgets::combo(const std::string& name, std::string& value, const std::vector<std::string>& choices) {
    if (choices.empty()) throw ArgumentError(fmt::format("combo '{}': expected at least one choice", name));
    return draw_combo(name, value, choices);
}

bool Widgets::color(const std::string& name, Vec3& value) {
    if (!value.allFinite()) throw ArgumentError(fmt::format("color '{}': expected finite numbers", name));
    return draw_color(name, value);
}

void Widgets::plot(const std::string& name, std::span<const float> values, const std::optional<Vec2>& range) {
    if (range) require_range("plot", name, range->x(), range->y(), 1e30);
    draw_plot(name, values, range ? *range : finite_range(values));
}

void Widgets::progress(double fraction, const std::string& text) {
    require_finite("progress", text, fraction);
    draw_progress(std::clamp(fraction, 0.0, 1.0), text);
}

}  // namespace easypbr::app
