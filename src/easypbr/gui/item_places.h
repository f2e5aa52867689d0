// Where what was laid out last lies on the screen, by name: for whoever points at panels from a program.
#pragma once

#include <Eigen/Geometry>

#include <map>
#include <string>

namespace easypbr::gui {

/// By "panel/item", pixels of the screen.
using ItemPlaces = std::map<std::string, Eigen::AlignedBox2d>;

/// Notes where the last item is, with the places of the Gui that lays out.
void note_place(const std::string& name);

}  // namespace easypbr::gui
