// Cameras as settings.
#pragma once

#include "easypbr/app/view_point.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

/// Pins the settings to a pose and a lens. A near plane that was inferred is inferred anew; what position and
/// target were still says how far away the target is.
void pin_camera(CameraSettings& settings, const Camera& camera);

/// The same, keeping the target; an automatic near plane comes as near as the camera.
void pin_view_point(CameraSettings& settings, const ViewPoint& view);

}  // namespace easypbr::app
