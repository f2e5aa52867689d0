// Orbit pages: pictures from all around in one HTML file that is turned without a server.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "easypbr/core/math.h"

namespace easypbr {

namespace app {
class Session;
}
struct Settings;

namespace remote {

struct OrbitPageOptions {
    int columns = 36;                ///< pictures around the up axis, 1 to 360
    int rows = 3;                    ///< elevations, 1 to 60; the camera's own is one of them
    double row_step_deg = 20;        ///< between rows, above 0; all rows lie within 160 degrees
    std::optional<Vec2i> size = {};  ///< none: the settings'
    std::optional<int> samples = {};
    std::string format = "webp";  ///< of the pictures: "webp" or "jpeg"
    int quality = 85;             ///< of the pictures at most, 1 to 100
    double most_megabytes = 20;   ///< of the file, 10^6 bytes each
    std::string title = {};       ///< empty: the names of the objects
};

/// Throws, before anything is drawn, when the page cannot be written: FileError; ArgumentError for options
/// out of range, a limit too small for the pictures, and transparency in JPEG.
void check_orbit_page(const std::filesystem::path& path, const Settings& settings,
                      const OrbitPageOptions& options);

/// Draws the content from a grid of directions around its middle and writes the pictures with a script that
/// turns them: one file that asks nothing of anybody. While the camera is automatic it is far enough away for
/// the content to stay in the pictures. Where they do not fit into the limit, their quality goes down to 40,
/// then their size, with a warning. The camera is afterwards what it was. Progress is reported. Returns the
/// path. Throws as check_orbit_page() and Session::render() do.
std::filesystem::path save_orbit_page(app::Session& session, const std::filesystem::path& path,
                                      const OrbitPageOptions& options = {});

}  // namespace remote
}  // namespace easypbr
