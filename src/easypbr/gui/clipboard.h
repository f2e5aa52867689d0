// Reading the clipboard of X11 with a limit on how long it takes.
#pragma once

#include <functional>
#include <string>

namespace easypbr::gui {

/// The clipboard's text (UTF-8), empty when nobody holds any, or more than fits into one answer of the X
/// server. Over a connection of its own; `serve` is called meanwhile, for the owner may be this program.
/// Throws ContextError when libxcb or the display is missing, or when the owner does not answer in time.
std::string read_clipboard(const char* display, double seconds, const std::function<void()>& serve);

}  // namespace easypbr::gui
