// The panels: each draws its part of the GUI and changes the session.
#pragma once

#include "easypbr/gui/state.h"

namespace easypbr::gui {

/// The objects, nested, with a box for each that hides it.
void scene_panel(GuiState& state);
/// Style and material of the selected object.
void object_panel(GuiState& state);
/// Every group of settings that has no panel of its own.
void effects_panel(GuiState& state);
/// Key, fill and rim and the scene's own lights.
void lights_panel(GuiState& state);
void environment_panel(GuiState& state);
void camera_panel(GuiState& state);
/// What is shown: the picture, a layer, or all of them in slices.
void channels_panel(GuiState& state);
void statistics_panel(GuiState& state);
/// Which animation plays, how fast, where it is.
void animations_panel(GuiState& state);
/// Keys of a camera path, its shape and file; playing and scrubbing.
void camera_path_panel(GuiState& state);
/// What is recorded, and how far it is.
void recorder_panel(GuiState& state);

/// The camera path over the picture.
void draw_path(GuiState& state);

/// The bar at the top.
void menu_bar(GuiState& state);
/// What the keys do.
void keys_window(GuiState& state);
/// Messages and the line at the bottom.
void status_line(GuiState& state);
void notifications(GuiState& state);

/// Rows for all settings whose names begin with `prefix`.
void settings_rows(GuiState& state, const std::string& prefix);

/// Handles to move, turn or scale the selected object, or to move the selected light.
void draw_handles(GuiState& state);
/// What the pointer does to them, while the panels are shown. Returns whether the event is theirs.
bool drag_handle(GuiState& state, const app::InputEvent& event);
/// What is dragged goes back to where it was, and stays until the button comes up. Returns whether there was
/// a drag.
bool cancel_drag(GuiState& state);

}  // namespace easypbr::gui
