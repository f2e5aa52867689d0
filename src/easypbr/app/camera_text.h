// A camera as text, for the clipboard and for the command line.
#pragma once

#include <string>
#include <string_view>

#include "easypbr/app/session.h"

namespace easypbr::app {

/// One "camera.NAME=VALUE" a line: what --set takes. The pose is written with all digits.
std::string camera_text(const Settings& settings);
/// The same of the session's next picture of this size, with its pose also where that is automatic.
std::string camera_text(Session& session, Vec2i size);

/// Takes over what camera_text() wrote; words "--set" between are skipped. The settings stay as they were
/// when it throws: FormatError when there is no camera in the text, NameError or ArgumentError for a value
/// that is wrong.
void apply_camera_text(std::string_view text, Settings& settings);

}  // namespace easypbr::app
