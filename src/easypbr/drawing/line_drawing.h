// Line drawings: the visible and the hidden edges of a scene as vector graphics.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easypbr/app/picture.h"
#include "easypbr/drawing/polylines.h"

namespace easypbr {

namespace app {
class Session;
}
struct ResolvedSettings;

namespace drawing {

struct DrawnObject {
    std::string name;
    std::vector<Polyline> visible, hidden;  ///< pixels from the picture's top left corner
};

struct LineDrawing {
    Vec2i size{0, 0};
    std::vector<DrawnObject> objects;  ///< as the scene has them; those without lines are left out
};

/// Contours, borders and creases of what is drawn as faces, as settings.outline chooses them, and the lines
/// of what is drawn as lines. Faces hide what lies behind them, but for those whose material lets light pass;
/// textures count as opaque. What is drawn as neither faces nor lines has no edges: it is left out,
/// with a warning.
LineDrawing line_drawing(const SceneSnapshot& scene, const ResolvedSettings& resolved, const Vec2i& size,
                         bool with_hidden = true);

/// As Scalable Vector Graphics 1.1: a group for each object, its name as title. Visible lines have the
/// outline's width and colour. Hidden ones are half as wide, dashed as ISO 128-2 has it (line type 02: dashes
/// of 12 widths, gaps of 3).
std::string svg_text(const LineDrawing& drawing, const ResolvedSettings& resolved,
                     app::HiddenLines hidden = app::HiddenLines::dashed);

/// "none", "dashed", "solid". Throws NameError with the nearest name.
app::HiddenLines hidden_lines_named(const std::string& name);

/// Throws FileError when the file cannot be written, ArgumentError unless it is named .svg.
void check_line_drawing(const std::filesystem::path& path);

/// Writes the scene as the session's camera sees it. The file appears whole or not at all. Returns the path.
/// Throws as check_line_drawing() and Session::resolve() do.
std::filesystem::path save_line_drawing(app::Session& session, const std::filesystem::path& path,
                                        const app::LineDrawingOptions& options = {});

}  // namespace drawing
}  // namespace easypbr
