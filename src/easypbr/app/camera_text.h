// A camera as text, for the clipboard and for the command line.
#pragma once

#include <string>
#include <string_view>

#include "easypbr/app/session.h"

namespace easypbr::app {

/// One "camera.NAME=VALUE" a line: what --set takes. Pose and lens, those that are given, with all digits.
std::string camera_text(const Settings& settings);
/// The same of the session's next picture of this size: pose, and height of an orthographic view, also where
/// they are automatic.
std::string camera_text(Session& session, Vec2i size);

/// Takes over what camera_text() wrote; words "--set" between are skipped. A text replaces all of the pose
/// (pose, position, target), and all of the lens, of which it names anything: the rest of that is the
/// default. The settings stay as they were when it throws: FormatError when there is no camera in the text,
/// NameError or ArgumentError for a value that is wrong.
void apply_camera_text(std::string_view text, Settings& settings);

}  // namespace easypbr::app
