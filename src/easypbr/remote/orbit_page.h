// Orbit pages: pictures from all around in one HTML file that is turned without a server.
#pragma once

#include <filesystem>

#include "easypbr/app/picture.h"

namespace easypbr {

namespace app {
class Session;
}
struct Settings;

namespace remote {

/// Throws ArgumentError for options out of range, and a limit too small for the pictures.
void check_orbit_options(const app::OrbitPageOptions& options);

/// Throws, before anything is drawn, when the page cannot be written: FileError; ArgumentError for options
/// that check_orbit_options() refuses, a size out of range, and transparency in JPEG.
void check_orbit_page(const std::filesystem::path& path, const Settings& settings,
                      const app::OrbitPageOptions& options);

/// Draws the content from a grid of directions around its middle and writes the pictures with a script that
/// turns them: one file that asks nothing of anybody. While the camera is automatic it is far enough away for
/// the content to stay in the pictures. Where they do not fit into the limit, their quality goes down to 40,
/// then their size, with a warning. The camera is afterwards what it was. Progress is reported. Returns the
/// path. Throws as check_orbit_page() and Session::render() do.
std::filesystem::path save_orbit_page(app::Session& session, const std::filesystem::path& path,
                                      const app::OrbitPageOptions& options = {});

}  // namespace remote
}  // namespace easypbr
