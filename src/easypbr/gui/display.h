// The display that windows are on. Xlib ends the process when the connection to it breaks, unless it is told
// not to.
#pragma once

namespace easypbr::gui {

/// From now on a display that goes away is noted instead of ending the process; needs libX11 1.7, and does
/// nothing with an older one, or where windows are not X11's. Called once, after glfwInit().
void watch_display();

/// The connection has broken. No window of this process can be used any more, nor can new ones be opened.
bool display_is_lost();

/// Throws ContextError when the display is lost.
void require_display();

/// Waits until the display has something to tell or the time is over. False where it cannot: windows are not
/// X11's. Needs no lock, unlike GLFW's own wait, which never ends when the connection is broken.
bool wait_for_display(double seconds);

/// The name of the X display that windows are on, for a separate connection; null where they are not
/// X11's.
const char* display_name();

}  // namespace easypbr::gui
