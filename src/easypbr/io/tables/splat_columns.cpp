#include "easypbr/io/tables/splat_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/splat_names.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr::io {
namespace {

constexpr size_t splat_rows_grain = 1 << 14;
/// Numbers of f_rest fields for degree 0 to 3.
constexpr std::array<size_t, 4> rest_counts{0, 9, 24, 45};

const VertexField* find(const std::vector<VertexField>& fields, std::string_view name) {
    const auto found =
        std::ranges::find_if(fields, [&](const VertexField& field) { return field.property.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

const VertexField& require(const Source& source, const std::vector<VertexField>& fields,
                           std::string_view name) {
    if (const VertexField* field = find(fields, name)) return *field;
    fail(source, fmt::format("splats have the properties f_dc_0 to 2, opacity, scale_0 to 2 and rot_0 to 3; "
                             "'{}' is missing",
                             name));
}

size_t count_rest(const Source& source, const std::vector<VertexField>& fields) {
    const auto count = size_t(std::ranges::count_if(
        fields, [](const VertexField& field) { return field.property.name.starts_with(harmonic_prefix); }));
    if (std::ranges::find(rest_counts, count) == rest_counts.end())
        fail(source, fmt::format("splats have 0, 9, 24 or 45 properties f_rest_N, for spherical harmonics of "
                                 "degree 0 to 3; found {}",
                                 count));
    return count;
}

template <class Matrix>
void set_column(const VertexField& field, Matrix& matrix, Eigen::Index column) {
    field.column->floats = matrix.data() + column;
    field.column->stride = size_t(matrix.cols());
    field.column->scale = field.property.scale;
    field.column->shift = field.property.shift;
}

}  // namespace

Eigen::Index harmonic_column(size_t k, size_t channel) {
    return Eigen::Index(3 * (k + 1) + channel);
}

SplatColumns::SplatColumns(const Source& source, const std::vector<VertexField>& fields, size_t count) {
    if (count == 0 || !find(fields, splat_color_names[0]) ||
        !(find(fields, splat_scale_names[0]) || find(fields, splat_rotation_names[0])))
        return;
    const size_t rest = count_rest(source, fields), rows = rest / 3;
    is_flat_ = !find(fields, splat_scale_names[2]);
    charge_memory(uint64_t(count) * (11 + rest) * sizeof(float), "its splats");
    scales_.setZero(Eigen::Index(count), 3);
    rotations_.resize(Eigen::Index(count), 4);
    opacities_.resize(Eigen::Index(count));
    sh_.resize(Eigen::Index(count), Eigen::Index(3 + rest));
    const auto set = [&](std::string_view name, auto& matrix, Eigen::Index column) {
        set_column(require(source, fields, name), matrix, column);
    };
    set(splat_opacity_name, opacities_, 0);
    for (size_t i = 0; i < (is_flat_ ? 2 : 3); ++i) set(splat_scale_names[i], scales_, Eigen::Index(i));
    for (size_t i = 0; i < 4; ++i) set(splat_rotation_names[i], rotations_, Eigen::Index(i));
    for (size_t i = 0; i < 3; ++i) set(splat_color_names[i], sh_, Eigen::Index(i));
    for (size_t channel = 0; channel < 3; ++channel)
        for (size_t k = 0; k < rows; ++k)
            set(harmonic_name(channel * rows + k), sh_, harmonic_column(k, channel));
}

SplatArrays SplatColumns::finish(const Source& source) {
    const auto count = size_t(scales_.rows());
    std::atomic<size_t> first_bad{count};
    parallel_chunks(count, splat_rows_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const auto row = Eigen::Index(i);
            for (int k = 0; k < (is_flat_ ? 2 : 3); ++k) scales_(row, k) = std::exp(scales_(row, k));
            opacities_(row) = 1 / (1 + std::exp(-opacities_(row)));
            const bool is_good = scales_.row(row).allFinite() && std::isfinite(opacities_(row)) &&
                                 rotations_.row(row).allFinite() && !rotations_.row(row).isZero(0) &&
                                 sh_.row(row).allFinite();
            for (size_t known = first_bad;
                 !is_good && i < known && !first_bad.compare_exchange_weak(known, i);) {
            }
        }
    });
    if (first_bad < count)
        fail(source, fmt::format("splat {} of {} has a value that is not finite, or a rotation of length 0",
                                 first_bad.load(), count));
    SplatArrays splats{std::move(scales_), std::move(rotations_), std::move(opacities_), std::move(sh_)};
    *this = {};
    return splats;
}

float constant_of_color(float encoded) {
    return (encoded - 0.5f) / splat_constant;
}

}  // namespace easypbr::io
