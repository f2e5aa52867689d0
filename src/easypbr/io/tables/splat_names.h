// What the properties of splats in PLY are called.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace easypbr::io {

/// Of one splat, beside those of spherical harmonics.
inline constexpr std::array<std::string_view, 11> splat_names{"f_dc_0",  "f_dc_1",  "f_dc_2",  "opacity",
                                                              "scale_0", "scale_1", "scale_2", "rot_0",
                                                              "rot_1",   "rot_2",   "rot_3"};

/// Spherical harmonics of degree 1 to 3: this and a number.
inline constexpr std::string_view harmonic_prefix = "f_rest_";

/// Of one splat whose numbers are packed into bits.
inline constexpr std::array<std::string_view, 4> packed_splat_names{"packed_position", "packed_rotation",
                                                                    "packed_scale", "packed_color"};

/// Whether a reader of splats takes a property of this name; their case counts.
inline bool is_splat_name(std::string_view name) {
    return name.starts_with(harmonic_prefix) || std::ranges::find(splat_names, name) != splat_names.end() ||
           std::ranges::find(packed_splat_names, name) != packed_splat_names.end();
}

}  // namespace easypbr::io
