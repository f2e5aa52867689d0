#include "easypbr/cli/render_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "easypbr/app/custom_pass.h"
#include "easypbr/app/output.h"
#include "easypbr/app/recording_target.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/object_styles.h"
#include "easypbr/cli/pose_file.h"
#include "easypbr/cli/standard_output.h"
#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/named_colors.h"
#include "easypbr/core/suggest.h"
#include "easypbr/drawing/line_drawing.h"
#include "easypbr/io/settings/presets.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

struct ShorthandOption {
    const char *names, *setting, *placeholder;
};

/// Their help is the setting's documentation.
constexpr ShorthandOption shorthand_options[] = {{"--samples", "image.samples", "N"},
                                                 {"--noise", "image.noise", "X"},
                                                 {"--time-budget", "image.time_budget", "SECONDS"},
                                                 {"--env,--hdri-file", "environment.file", "FILE"},
                                                 {"--env-rotation", "environment.rotation_deg", "DEG"},
                                                 {"--env-intensity", "environment.intensity", "X"},
                                                 {"--tonemap", "tonemap.operator", "NAME"},
                                                 {"--exposure", "tonemap.exposure", "auto|X"},
                                                 {"--camera-position", "camera.position", "X,Y,Z"},
                                                 {"--camera-target", "camera.target", "X,Y,Z"},
                                                 {"--fov-y", "camera.fov_y_deg", "DEG"},
                                                 {"--up", "camera.up", "AXIS"},
                                                 {"--color", "material.color", "COLOR"},
                                                 {"--metallic", "material.metallic", "X"},
                                                 {"--roughness", "material.roughness", "X"},
                                                 {"--shader", "material.shader", "FILE"},
                                                 {"--crease", "load.crease_deg", "DEG"},
                                                 {"--variant", "load.variant", "NAME"}};

void declare_shorthands(CLI::App& command, RenderOptions& options) {
    for (const ShorthandOption& shorthand : shorthand_options) {
        const std::string names = shorthand.names, setting = shorthand.setting;
        const auto keep = [&options, option = names.substr(0, names.find(',')),
                           setting](const std::string& text) {
            options.shorthands.push_back({option, setting, text});
        };
        command.add_option_function<std::string>(names, keep, field(setting).doc)
            ->option_text(shorthand.placeholder);
    }
    const auto keep_mode = [&options](const std::string& mode) {
        options.shorthands.push_back({"--mode", "path.enabled", mode == "path" ? "true" : "false"});
    };
    command
        .add_option_function<std::string>(
            "--mode", keep_mode,
            "How images are lit: raster, as frames that move, or path tracing, the "
            "default of several samples")
        ->transform(CLI::IsMember({"raster", "path"}, CLI::ignore_case));
}

void declare_output(CLI::App& command, RenderOptions& options) {
    command
        .add_option("-o,--output", options.output,
                    "Image file to write: PNG, JPEG, HDR or EXR; '-': PNG to standard output; by default the "
                    "image is shown in the terminal. For several frames: MP4, WebM, GIF, or numbered images: "
                    "frame_%04d.png. HTML: a page to turn the content in. SVG: a line drawing")
        ->option_text("FILE");
    command.add_option("--size,--resolution", options.size, "Width and height in pixels")->option_text("WxH");
    command.add_option("--bit-depth", options.bit_depth, "Bits per channel of a PNG: 8 or 16")
        ->check(CLI::IsMember({8, 16}));
    command
        .add_option("--layers", options.layers,
                    "Also write OUT_LAYER.exr for each of albedo, normal_world, depth, instance_id, ..., and "
                    "OUT_instances.json for instances")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->option_text("A,B");
    command.add_flag("--batch", options.batch,
                     "Draw one image per file; '{name}' in the output is replaced by the file's stem");
    command.add_flag("--open", options.open, "Open the written file in the desktop's program for it");
    command.add_flag("--quiet", options.quiet, "Suppress warnings and progress");
    command.add_flag("--timing", options.timing, "Print the time of each stage to stderr");
}

void declare_look(CLI::App& command, RenderOptions& options) {
    command
        .add_option("--background", options.background,
                    "Background: a colour, env, blur, transparent or an image file")
        ->option_text("COLOR|env|blur|transparent|FILE");
    command
        .add_option("--texture", options.textures, "Texture of every material, for example base_color=FILE")
        ->allow_extra_args(false)
        ->option_text("NAME=FILE");
    declare_passes(command, options.passes);
    command.add_flag("--smooth", options.smooth, "Smooth shading, one normal per vertex");
    command.add_flag("--flat", options.flat, "Flat shading, one normal per face");
    command
        .add_option("--style", options.styles,
                    "Style of all objects, for example color_by=height; NAME.KEY=VALUE for one object")
        ->allow_extra_args(false)
        ->option_text("[NAME.]KEY=VALUE");
    command
        .add_option("--label-map", options.label_map,
                    "Names and colours of labels: semantic_kitti, cityscapes, scannet or a file")
        ->option_text("NAME|FILE");
    command.add_flag("--legend", options.legend, "Draw a legend of the labels into the image");
    command.add_flag("--colorbar", options.colorbar, "Draw a colour bar of the values into the image");
    declare_settings(command, options.start, options.values);
    command
        .add_option("--save-settings", options.save_settings,
                    "Write all settings to a JSON file, given and inferred")
        ->option_text("FILE");
}

void declare_camera(CLI::App& command, RenderOptions& options) {
    command
        .add_option("--camera-pose", options.camera_pose,
                    "Text file with the camera-to-world matrix, 16 numbers in row-major order")
        ->option_text("FILE");
    command.add_option("--camera", options.camera, "Camera of the file (glTF) by name, or by number from 0")
        ->option_text("NAME|NUMBER");
    command
        .add_option("--camera-axes", options.camera_axes,
                    "Camera axes of --camera-pose: opengl (default) or opencv")
        ->transform(CLI::IsMember({"opengl", "opencv"}, CLI::ignore_case));
    command.add_option("--turntable", options.turntable, "Record a turntable of N frames")->option_text("N");
    command.add_option("--camera-path", options.camera_path, "Record along a camera path from a JSON file")
        ->option_text("FILE");
    command
        .add_option("--orbit", options.orbit,
                    "Pictures of an HTML page: directions around the content by elevations (36x3)")
        ->option_text("COLUMNSxROWS");
    command.add_option("--page-limit", options.page_limit, "Size of an HTML page at most (20)")
        ->option_text("MB");
    command.add_option("--page-format", options.page_format, "Pictures of an HTML page: webp or jpeg")
        ->transform(CLI::IsMember({"webp", "jpeg"}, CLI::ignore_case));
    command.add_option("--page-title", options.page_title, "Title of an HTML page")->option_text("TEXT");
    command
        .add_option("--hidden-lines", options.hidden_lines,
                    "Lines of an SVG file that faces hide: none, dashed (default) or solid")
        ->transform(CLI::IsMember({"none", "dashed", "solid"}, CLI::ignore_case));
    command.add_option("--fps", options.fps, "Frames per second of a recording (30)")->option_text("X");
    command.add_option("--codec", options.codec, "Video encoder by its FFmpeg name")->option_text("NAME");
    command
        .add_option("--animation", options.animation,
                    "Animation of the file (glTF) by name, or by number from 0; a recording plays it, a "
                    "video or numbered pictures the whole of it")
        ->option_text("NAME|NUMBER");
    command
        .add_option("--animation-time", options.animation_time,
                    "Time in the animation, or at the start of a recording")
        ->option_text("SECONDS");
    command
        .add_option("--focus", options.focus,
                    "Enable depth of field, focused on the surface at this pixel; 0,0 is the upper left one")
        ->option_text("X,Y");
    command
        .add_option("--ortho", options.ortho,
                    "Orthographic camera with a view volume of this height, in world units")
        ->option_text("HEIGHT|auto");
}

void set_value(Settings& settings, const std::string& option, const std::string& name,
               const std::string& text) {
    try {
        set_from_text(settings, name, text);
    } catch (const Error& error) {
        throw UsageError(fmt::format("{}: {}", option, error.what()));
    }
}

/// "a=b" as its two sides.
std::pair<std::string, std::string> name_and_value(const std::string& option, const std::string& text) {
    const size_t at = text.find('=');
    if (at == text.npos || at == 0)
        throw UsageError(fmt::format("{}: expected NAME=VALUE, got '{}'", option, text));
    return {text.substr(0, at), text.substr(at + 1)};
}

void apply_background(const std::string& text, BackgroundSettings& background) {
    static const std::map<std::string, BackgroundMode> modes{{"env", BackgroundMode::environment},
                                                             {"environment", BackgroundMode::environment},
                                                             {"blur", BackgroundMode::blur},
                                                             {"transparent", BackgroundMode::transparent}};
    if (const auto mode = modes.find(text); mode != modes.end()) {
        background.mode = mode->second;
    } else if (is_image_file(text)) {
        background.mode = BackgroundMode::image;
        background.image = text;
    } else {
        const auto color = find_color(text);
        if (!color)
            throw UsageError(fmt::format(
                "--background: expected env, blur, transparent, an image file or a colour: {}, got '{}'{}",
                color_forms, text, did_you_mean(text, color_names())));
        background.color = *color;
        background.mode = BackgroundMode::color;
    }
}

void apply_texture(const std::string& text, Settings& settings) {
    auto [name, file] = name_and_value("--texture", text);
    if (name == "ao") name = "occlusion";
    std::vector<std::string> names;
    for (const MaterialTexture& row : replaceable_textures()) names.emplace_back(row.name);
    if (std::ranges::find(names, name) == names.end())
        throw UsageError(fmt::format("--texture: there is no texture '{}'{}; expected one of {}", name,
                                     did_you_mean(name, names), fmt::join(names, ", ")));
    set_value(settings, "--texture", "material." + name + "_texture", file);
}

void apply_camera(const RenderOptions& options, CameraSettings& camera) {
    if (options.camera_pose.empty()) return;
    const PoseAxes axes = options.camera_axes == "opencv" ? PoseAxes::opencv : PoseAxes::opengl;
    camera.pose = load_pose(options.camera_pose, axes);
}

/// What a settings file says in another way must give way to the command line.
void drop_replaced(const RenderOptions& options, CameraSettings& camera) {
    for (const RenderOptions::Shorthand& shorthand : options.shorthands) {
        if (shorthand.setting == "camera.position" || shorthand.setting == "camera.target")
            camera.pose.clear();
        if (shorthand.setting != "camera.fov_y_deg") continue;
        camera.intrinsics.clear();
        camera.projection = Projection::perspective;
    }
}

int parse_side(std::string_view text, const std::string& whole) {
    long long side = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (text.empty() || end != text.data() + text.size() || error == std::errc::invalid_argument)
        throw UsageError(fmt::format("--size: expected WIDTHxHEIGHT, got '{}'", whole));
    if (error != std::errc() || side < 1 || side > max_image_side)
        throw UsageError(
            fmt::format("--size {}: expected width and height from 1 to {}", whole, max_image_side));
    return int(side);
}

}  // namespace

std::optional<Vec2i> parse_focus(const std::string& text) {
    if (text.empty()) return std::nullopt;
    Vec2i pixel;
    const char *at = text.data(), *const end = at + text.size();
    const auto [comma, first_error] = std::from_chars(at, end, pixel.x());
    if (first_error == std::errc() && comma != end && *comma == ',') {
        const auto [last, error] = std::from_chars(comma + 1, end, pixel.y());
        if (error == std::errc() && last == end) return pixel;
    }
    throw UsageError(fmt::format("--focus: expected the pixel X,Y, got '{}'", text));
}

void declare_settings(CLI::App& command, StartSettings& start, std::vector<std::string>& values) {
    command.add_option("--set", values, "Any setting, for example tonemap.exposure=2")
        ->allow_extra_args(false)
        ->option_text("KEY=VALUE");
    command
        .add_option("--preset", start.preset,
                    fmt::format("Look of the image: {}, or a settings file; other options win over it",
                                fmt::join(io::preset_names(), ", ")))
        ->option_text("NAME|FILE");
    command.add_option("--settings", start.settings, "Start from a file that --save-settings wrote")
        ->option_text("FILE");
}

void check_start(const StartSettings& start) {
    if (!start.preset.empty()) io::check_preset(start.preset);
}

void apply(const StartSettings& start, app::Session& session) {
    if (!start.preset.empty()) app::apply_preset(session, start.preset);
    if (start.settings.empty()) return;
    start.preset.empty() ? app::load_settings(session, start.settings)
                         : app::apply_settings(session, start.settings);
}

void declare_passes(CLI::App& command, std::vector<std::string>& passes) {
    command
        .add_option("--pass", passes,
                    "Fragment shader of a custom full-screen pass; stages: light (linear HDR, before tone "
                    "mapping), overlay (default, after tone mapping), picture (the final image)")
        ->allow_extra_args(false)
        ->option_text("[STAGE=]FILE");
}

void add_passes(const std::vector<std::string>& passes, app::Session& session) {
    for (const std::string& text : passes) {
        const size_t at = text.find('=');
        const std::string file = at == text.npos ? text : text.substr(at + 1);
        Stage stage = Stage::overlay;
        try {
            if (at != text.npos) stage = stage_named(text.substr(0, at));
        } catch (const NameError& error) {
            throw UsageError(fmt::format("--pass: {}", error.what()));
        }
        session.add_pass(file, stage, std::make_shared<app::ShaderPass>(std::filesystem::path(file)));
    }
}

Vec2i parse_size(const std::string& text) {
    const size_t at = text.find_first_of("x,");
    if (at == text.npos) throw UsageError(fmt::format("--size: expected WIDTHxHEIGHT, got '{}'", text));
    const Vec2i size(parse_side(std::string_view(text).substr(0, at), text),
                     parse_side(std::string_view(text).substr(at + 1), text));
    of_options([&] { app::check_picture_size(size); });
    return size;
}

app::OrbitPageOptions page_options_of(const RenderOptions& options) {
    app::OrbitPageOptions page;
    if (!options.orbit.empty()) {
        const size_t at = options.orbit.find('x');
        const auto count = [&](const std::string& text) {
            int value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (at == options.orbit.npos || text.empty() || error != std::errc() ||
                end != text.data() + text.size())
                throw UsageError(fmt::format("--orbit: expected COLUMNSxROWS, got '{}'", options.orbit));
            return value;
        };
        page.columns = count(options.orbit.substr(0, at));
        page.rows = count(options.orbit.substr(at + 1));
    }
    page.most_megabytes = options.page_limit.value_or(page.most_megabytes);
    if (!options.page_format.empty()) page.format = options.page_format;
    page.title = options.page_title;
    return page;
}

app::LineDrawingOptions line_drawing_options_of(const RenderOptions& options) {
    app::LineDrawingOptions drawing;
    if (!options.hidden_lines.empty()) drawing.hidden = drawing::hidden_lines_named(options.hidden_lines);
    return drawing;
}

std::string shorthand_option(std::string_view setting) {
    // These are read before they become settings.
    if (setting == "image.size") return "--size";
    if (setting == "camera.pose") return "--camera-pose";
    if (setting == "camera.projection" || setting == "camera.ortho_height") return "--ortho";
    if (setting.starts_with("background.") && setting != "background.blur") return "--background";
    if (setting.starts_with("material.") && setting.ends_with("_texture")) return "--texture";
    if (setting == "annotation.colorbar") return "--colorbar";
    if (setting == "annotation.legend") return "--legend";
    if (setting == "style.flat") return "--flat";
    for (const ShorthandOption& shorthand : shorthand_options)
        if (setting == shorthand.setting) {
            const std::string_view names = shorthand.names;
            return std::string(names.substr(0, names.find(',')));
        }
    return {};
}

std::string setting_of_shorthand(std::string_view option) {
    for (const ShorthandOption& shorthand : shorthand_options) {
        const std::string_view names = shorthand.names;
        if (names.substr(0, names.find(',')) == option) return shorthand.setting;
    }
    return {};
}

void declare_render_options(CLI::App& command, RenderOptions& options) {
    command.add_option("FILE", options.files,
                       "Meshes: PLY, OBJ, STL, OFF, glTF, GLB and more; - is standard input");
    declare_format(command, options.format);
    declare_output(command, options);
    declare_look(command, options);
    declare_camera(command, options);
    declare_shorthands(command, options);
}

bool RenderOptions::records() const {
    const bool is_named = output != standard_output && app::is_recording_name(output);
    return turntable || !camera_path.empty() || (!animation.empty() && is_named);
}

void apply(const RenderOptions& options, Settings& settings) {
    if (parse_focus(options.focus)) settings.depth_of_field.enabled = true;
    if (!options.size.empty()) settings.image.size = parse_size(options.size);
    if (!options.background.empty()) apply_background(options.background, settings.background);
    for (const std::string& text : options.textures) apply_texture(text, settings);
    if (options.smooth || options.flat) settings.style.flat = options.flat;
    if (options.legend) settings.annotation.legend = true;
    if (options.colorbar) settings.annotation.colorbar = true;
    drop_replaced(options, settings.camera);
    apply_camera(options, settings.camera);
    for (const RenderOptions::Shorthand& shorthand : options.shorthands)
        set_value(settings, shorthand.option, shorthand.setting, shorthand.text);
    if (!options.ortho.empty()) {
        settings.camera.projection = Projection::orthographic;
        set_value(settings, "--ortho", "camera.ortho_height", options.ortho);
    }
    for (const StyleOption& style : parse_styles(options.styles, unique_names(options.files)))
        if (style.object.empty()) set_value(settings, "--style", "style." + style.key, style.value);
    for (const std::string& text : options.values) {
        const auto [name, value] = name_and_value("--set", text);
        set_value(settings, "--set", name, value);
    }
}

}  // namespace easypbr::cli
