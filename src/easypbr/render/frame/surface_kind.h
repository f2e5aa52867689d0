// What becomes of a pixel of the G-buffer after the geometry is drawn.
#pragma once

#include <cstdint>

namespace easypbr::render {

/// Stored in the fourth channel of GBuffer::material; the same numbers stand in
/// shaders/common_surface_kind.glsl.
enum class SurfaceKind : uint8_t {
    lit = 0,
    ground_plane = 10,     ///< lit, fading into the background
    lit_point = 15,        ///< lit, at one depth in all of its pixels: they do not tell its face
    extended = 20,         ///< lit, with values in GBuffer::extension
    display = 51,          ///< the albedo is the picture's colour: neither light nor tone curve touch it
    eye_dome = 102,        ///< the same, shaded by eye-dome lighting
    exact = 153,           ///< the same, and not smoothed either: tables of labels and scalars
    ground_catcher = 204,  ///< shows the shadows on it and nothing else
    unlit = 255            ///< the emission is the radiance (KHR_materials_unlit)
};

constexpr float code_of(SurfaceKind kind) {
    return float(kind) / 255.0f;
}

/// Of points, which lit surfaces of other kinds are not.
constexpr SurfaceKind kind_of_point(SurfaceKind kind) {
    return kind == SurfaceKind::lit ? SurfaceKind::lit_point : kind;
}

/// Whether light of the scene falls on a pixel with this code and is what it shows.
constexpr bool is_lit_by_scene(uint8_t code) {
    return code < uint8_t(SurfaceKind::display);
}

/// Whether the colour is shown past light and tone curve.
constexpr bool is_display(SurfaceKind kind) {
    return kind == SurfaceKind::display || kind == SurfaceKind::eye_dome || kind == SurfaceKind::exact;
}

}  // namespace easypbr::render
