// Splats as rows of a table, for writing.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/splat_names.h"

namespace easypbr::io {
namespace {

/// The logarithms of what is written are kept finite.
constexpr float least_scale = 1e-30f, least_opacity = 1e-30f, most_opacity = 1 - 6e-8f;

}  // namespace

std::vector<RowPart> splat_row_parts(const SplatArrays& splats) {
    if (splats.empty()) return {};
    using Names = std::vector<std::string>;
    const auto part = [](Names names, auto&& value_of) {
        const size_t count = names.size();
        return RowPart{std::move(names), ScalarType::float32, [count, value_of](Eigen::Index row, char* out) {
                           for (size_t i = 0; i < count; ++i, out += sizeof(float)) {
                               const float value = value_of(row, Eigen::Index(i));
                               std::memcpy(out, &value, sizeof value);
                           }
                       }};
    };
    const auto names = [](const auto& all) { return Names(all.begin(), all.end()); };
    const auto rows = size_t(splats.sh.cols() / 3 - 1);
    Names rest;
    for (size_t i = 0; i < 3 * rows; ++i) rest.push_back(harmonic_name(i));
    std::vector<RowPart> parts;
    parts.push_back(part(names(splat_color_names),
                         [sh = splats.sh](Eigen::Index row, Eigen::Index i) { return sh(row, i); }));
    if (rows > 0)
        parts.push_back(part(std::move(rest), [sh = splats.sh, rows](Eigen::Index row, Eigen::Index i) {
            return sh(row, harmonic_column(size_t(i) % rows, size_t(i) / rows));
        }));
    parts.push_back(
        part({std::string(splat_opacity_name)}, [o = splats.opacities](Eigen::Index row, Eigen::Index) {
            const float opacity = std::clamp(o(row), least_opacity, most_opacity);
            return std::log(opacity / (1 - opacity));
        }));
    parts.push_back(part(names(splat_scale_names), [s = splats.scales](Eigen::Index row, Eigen::Index i) {
        return std::log(std::max(s(row, i), least_scale));
    }));
    parts.push_back(part(names(splat_rotation_names),
                         [q = splats.rotations](Eigen::Index row, Eigen::Index i) { return q(row, i); }));
    return parts;
}

}  // namespace easypbr::io
