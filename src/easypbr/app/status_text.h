// What lies under the pointer, in words.
#pragma once

#include <string>

#include "easypbr/app/picture.h"

namespace easypbr::app {

/// "(691074.83, 5335038.48, 533.69)": with as many decimals as tell places apart that are `step` from each
/// other, above 0; very large and very small coordinates in exponential notation.
std::string coordinates_text(const Vec3d& place, double step);

/// "car / wheel   face 12   (1.25, 0.31, 2.00)": object, part, element, and the position in the coordinates
/// that meshes were given, for the origin of the scene (Scene::origin()).
std::string status_text(const Pick& pick, const Vec3d& origin, double step);

}  // namespace easypbr::app
