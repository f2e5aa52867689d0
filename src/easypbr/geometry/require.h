// Checks of arguments that the functions of this room share.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// Throws ArgumentError "WHAT: expected a number > 0, got VALUE".
template <class Number>
void require_positive(const char* what, Number value) {
    if (!(value > 0) || !std::isfinite(value))
        throw ArgumentError(fmt::format("{}: expected a number > 0, got {}", what, value));
}

/// Throws ArgumentError "WHAT: expected a number >= 0, got VALUE".
inline void require_not_negative(const char* what, double value) {
    if (!(value >= 0) || !std::isfinite(value))
        throw ArgumentError(fmt::format("{}: expected a number >= 0, got {}", what, value));
}

/// Throws ArgumentError "WHAT: expected a whole number from LEAST to MOST, got VALUE".
inline void require_between(const char* what, int64_t value, int64_t least, int64_t most) {
    if (value < least || value > most)
        throw ArgumentError(
            fmt::format("{}: expected a whole number from {} to {}, got {}", what, least, most, value));
}

/// A range of whole numbers, its ends included.
struct Range {
    int64_t least, most;
};
inline constexpr Range upsample_iterations{0, 12}, smooth_iterations{0, 100000}, neighbor_counts{3, 256},
    sample_counts{0, std::numeric_limits<int32_t>::max()}, splat_mesh_resolutions{8, 512};

inline void require_in(const char* what, int64_t value, Range range) {
    require_between(what, value, range.least, range.most);
}

inline void require_box(const char* what, const Box3d& box) {
    const Vec3d &a = box.min(), &b = box.max();
    if (!(a.array() <= b.array()).all())
        throw ArgumentError(
            fmt::format("{}: expected a box whose lowest corner is below its highest, got {},{},{},{},{},{}",
                        what, a.x(), a.y(), a.z(), b.x(), b.y(), b.z()));
}

inline void require_sphere(const char* what, const Vec3d& center, double radius) {
    if (!center.allFinite() || !std::isfinite(radius) || !(radius > 0))
        throw ArgumentError(fmt::format("{}: expected a finite centre and a radius > 0, got {},{},{},{}",
                                        what, center.x(), center.y(), center.z(), radius));
}

/// Throws ArgumentError "WHAT: expected finite CALLED, got (X, Y, Z) in row I of N"; rows are of three
/// numbers.
template <class Rows>
void require_finite(const char* what, const Rows& rows, const char* called = "points") {
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
        if (!rows.row(i).allFinite())
            throw ArgumentError(fmt::format("{}: expected finite {}, got ({}, {}, {}) in row {} of {}", what,
                                            called, rows(i, 0), rows(i, 1), rows(i, 2), i, rows.rows()));
}

}  // namespace easypbr::geometry
