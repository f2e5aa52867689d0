// What the properties of splats in PLY are called.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace easypbr::io {

/// Spherical harmonics of degree 0: red, green, blue.
inline constexpr std::array<std::string_view, 3> splat_color_names{"f_dc_0", "f_dc_1", "f_dc_2"};
inline constexpr std::string_view splat_opacity_name = "opacity";
/// Flat splats have the first two.
inline constexpr std::array<std::string_view, 3> splat_scale_names{"scale_0", "scale_1", "scale_2"};
/// w, x, y, z
inline constexpr std::array<std::string_view, 4> splat_rotation_names{"rot_0", "rot_1", "rot_2", "rot_3"};

/// Spherical harmonics of degree 1 to 3: this and a number.
inline constexpr std::string_view harmonic_prefix = "f_rest_";

inline std::string harmonic_name(size_t i) {
    return std::string(harmonic_prefix) + std::to_string(i);
}

/// Of one splat whose numbers are packed into bits.
inline constexpr std::array<std::string_view, 4> packed_splat_names{"packed_position", "packed_rotation",
                                                                    "packed_scale", "packed_color"};

/// Whether a reader of splats takes a property of this name; their case counts.
inline bool is_splat_name(std::string_view name) {
    const auto is_one_of = [&](const auto& names) { return std::ranges::find(names, name) != names.end(); };
    return name.starts_with(harmonic_prefix) || name == splat_opacity_name || is_one_of(splat_color_names) ||
           is_one_of(splat_scale_names) || is_one_of(splat_rotation_names) || is_one_of(packed_splat_names);
}

}  // namespace easypbr::io
