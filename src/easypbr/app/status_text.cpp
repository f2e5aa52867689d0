#include "easypbr/app/status_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace easypbr::app {

std::string coordinates_text(const Vec3d& place, double step) {
    constexpr int most_decimals = 9, most_digits = 17;  // of which a double has meaning
    constexpr double largest_fixed = 1e15;
    const double largest = place.cwiseAbs().maxCoeff();
    const int decimals = int(std::ceil(-std::log10(step)));
    // What rounds to 0 has no sign.
    const Vec3d shown = (place.array().abs() < std::pow(10.0, -decimals) / 2).select(0, place);
    if (decimals <= most_decimals && largest < largest_fixed) {
        const int fixed = std::max(decimals, 0);
        return fmt::format("({:.{}f}, {:.{}f}, {:.{}f})", shown.x(), fixed, shown.y(), fixed, shown.z(),
                           fixed);
    }
    const int digits = largest > 0 ? int(std::floor(std::log10(largest))) + 1 + decimals : 1;
    const int behind = std::clamp(digits, 1, most_digits) - 1;
    return fmt::format("({:.{}e}, {:.{}e}, {:.{}e})", shown.x(), behind, shown.y(), behind, shown.z(),
                       behind);
}

std::string status_text(const Pick& pick, const Vec3d& origin, double step) {
    const std::string part = pick.part.empty() ? "" : " / " + pick.part;
    return fmt::format("{}{}   {} {}   {}", pick.object, part, pick.is_face ? "face" : "point", pick.element,
                       coordinates_text(pick.position + origin, step));
}

}  // namespace easypbr::app
