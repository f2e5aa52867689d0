#include <fmt/format.h>

#include <string_view>

#include "easypbr/core/color.h"
#include "easypbr/core/markup.h"
#include "easypbr/drawing/line_drawing.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::drawing {
namespace {

std::string path_data(const std::vector<Polyline>& lines) {
    std::string out;
    for (const Polyline& line : lines) {
        const bool is_closed = line.size() > 2 && line.front() == line.back();
        for (size_t i = 0; i + (is_closed ? 1 : 0) < line.size(); ++i)
            out += fmt::format("{}{:.2f} {:.2f}", i == 0 ? "M" : "L", line[i].x(), line[i].y());
        if (is_closed) out += "Z";
    }
    return out;
}

/// The lines of all objects, each with its name.
std::string group(const LineDrawing& drawing, std::vector<Polyline> DrawnObject::*lines,
                  std::string_view attributes) {
    std::string out = fmt::format("<g {}>\n", attributes);
    for (const DrawnObject& object : drawing.objects)
        if (!(object.*lines).empty())
            out += fmt::format("<g><title>{}</title><path d=\"{}\"/></g>\n",
                               markup_escaped(valid_utf8(object.name)), path_data(object.*lines));
    return out + "</g>\n";
}

}  // namespace

std::string svg_text(const LineDrawing& drawing, const ResolvedSettings& resolved, app::HiddenLines hidden) {
    const auto& outline = resolved.settings.outline;
    const int width = drawing.size.x(), height = drawing.size.y();
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" width=\"{0}\" height=\"{1}\" viewBox=\"0 "
        "0 {0} "
        "{1}\" fill=\"none\" stroke=\"{2}\" stroke-linejoin=\"round\">\n",
        width, height, to_hex(outline.color));
    const float narrow = outline.width / 2;
    if (hidden != app::HiddenLines::none)
        out += group(drawing, &DrawnObject::hidden,
                     fmt::format("class=\"hidden\" stroke-width=\"{:g}\"{}", narrow,
                                 hidden == app::HiddenLines::dashed
                                     ? fmt::format(" stroke-dasharray=\"{:g} {:g}\"", 12 * narrow, 3 * narrow)
                                     : ""));
    out +=
        group(drawing, &DrawnObject::visible,
              fmt::format("class=\"visible\" stroke-width=\"{:g}\" stroke-linecap=\"round\"", outline.width));
    return out + "</svg>\n";
}

}  // namespace easypbr::drawing
