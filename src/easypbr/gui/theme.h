// How the GUI looks: font, sizes, colours.
#pragma once

struct ImFontAtlas;

namespace easypbr::gui {

enum class Theme { dark, light };

/// Colours and sizes of the current ImGui context's style; `scale` is pixels per plain pixel.
void apply_theme(Theme theme, float scale);

/// Adds the embedded DejaVu Sans, with Greek, arrows and other signs that the panels use.
void add_font(ImFontAtlas& atlas, float scale);

/// Width of the column of panels at the left and the right, plain pixels.
inline constexpr float left_width = 270, right_width = 360;

}  // namespace easypbr::gui
