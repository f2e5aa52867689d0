// Checks of arguments that the functions of this room share.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// Throws ArgumentError "WHAT: expected a number > 0, got VALUE".
template <class Number>
void require_positive(const char* what, Number value) {
    if (!(value > 0) || !std::isfinite(value))
        throw ArgumentError(fmt::format("{}: expected a number > 0, got {}", what, value));
}

/// Throws ArgumentError "WHAT: expected a whole number from LEAST to MOST, got VALUE".
inline void require_between(const char* what, int64_t value, int64_t least, int64_t most) {
    if (value < least || value > most)
        throw ArgumentError(
            fmt::format("{}: expected a whole number from {} to {}, got {}", what, least, most, value));
}

}  // namespace easypbr::geometry
