// Which options of `easypbr render` go together.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/app/output.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/object_styles.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/cli/truth_layers.h"
#include "easypbr/core/file.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/io/video/video.h"

namespace easypbr::cli {
namespace {

void check_page_usage(const RenderOptions& options) {
    if (!options.is_page()) {
        const bool is_asked = !options.orbit.empty() || options.page_limit || !options.page_format.empty() ||
                              !options.page_title.empty();
        if (is_asked) throw UsageError("render: --orbit and --page-... need an HTML file: -o FILE.html");
        return;
    }
    if (options.records()) throw UsageError("render: an HTML page is no recording: give --orbit alone");
    if (!options.layers.empty()) throw UsageError("render: --layers are of one picture, not of an HTML page");
    remote::check_orbit_options(page_options_of(options));
}

void check_line_drawing_usage(const RenderOptions& options) {
    if (!options.is_line_drawing()) {
        if (!options.hidden_lines.empty())
            throw UsageError("render: --hidden-lines needs an SVG file: -o FILE.svg");
        return;
    }
    if (options.records()) throw UsageError("render: a line drawing is no recording");
    if (!options.layers.empty()) throw UsageError("render: --layers are of an image, not of a line drawing");
}

void check_recording_usage(const RenderOptions& options) {
    if (options.fps && !(*options.fps > 0 && std::isfinite(*options.fps)))
        throw UsageError(fmt::format("--fps: expected a number above 0, got {}", *options.fps));
    if (options.animation_time && options.animation.empty())
        throw UsageError("render: --animation-time needs --animation");
    if (!options.records()) {
        const bool fps_is_idle = options.fps && options.animation.empty();
        if (fps_is_idle || !options.codec.empty())
            throw UsageError(fmt::format("render: {} needs --turntable, --camera-path or --animation",
                                         fps_is_idle ? "--fps" : "--codec"));
        if (io::is_video(options.output))
            throw UsageError("render: a video needs --turntable, --camera-path or --animation");
        return;
    }
    if (options.turntable && !options.camera_path.empty())
        throw UsageError("render: --turntable and --camera-path exclude each other");
    if (options.turntable && *options.turntable < 1)
        throw UsageError(fmt::format("--turntable: expected at least one frame, got {}", *options.turntable));
    if (options.output == "-") throw UsageError("render: a recording cannot go to standard output");
    if (!options.layers.empty()) throw UsageError("render: --layers are of one picture, not of a recording");
}

}  // namespace

void check_usage(const RenderOptions& options) {
    require(!options.files.empty(), "render", "at least one FILE");
    require(!options.output.empty() || options.shows_in_terminal(), "render", "-o OUT.png");
    check_input("render", options.files);
    check_recording_usage(options);
    check_page_usage(options);
    check_line_drawing_usage(options);
    parse_styles(options.styles, unique_names(options.files));
    check_start(options.start);
    if (!options.label_map.empty()) io::check_label_map(options.label_map);
    if (options.smooth && options.flat) throw UsageError("render: --smooth and --flat exclude each other");
    if (!options.camera_pose.empty())
        for (const RenderOptions::Shorthand& shorthand : options.shorthands)
            if (shorthand.setting == "camera.position" || shorthand.setting == "camera.target")
                throw UsageError("render: --camera-pose and " + shorthand.option + " exclude each other");
    if (!options.camera_axes.empty() && options.camera_pose.empty())
        throw UsageError("render: --camera-axes needs --camera-pose");
    if (!options.camera.empty() && !options.camera_pose.empty())
        throw UsageError("render: --camera and --camera-pose exclude each other");
    const bool is_picture = !options.records() && !options.is_page() && !options.is_line_drawing();
    if (is_picture && !options.output.empty() && options.output != "-") app::encoding_for(options.output);
    if (options.records()) app::check_recording_name(options.output);
    if (options.bit_depth == 16 && options.output != "-" && extension_of(options.output) != "png")
        throw UsageError("render: --bit-depth 16 needs a PNG file as output");
    if (options.output == "-" && (options.batch || !options.layers.empty()))
        throw UsageError("render: standard output takes one picture, neither --batch nor --layers");
    for (const std::string& file : {options.output, options.save_settings})
        if (options.batch && !file.empty() && file.find("{name}") == file.npos)
            throw UsageError(fmt::format("render: with --batch, '{}' must contain '{{name}}'", file));
    for (const std::string& layer : options.layers) check_layer(layer);
}

}  // namespace easypbr::cli
