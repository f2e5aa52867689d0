#include <fmt/format.h>

#include <optional>

#include "easypbr/app/output.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/cli/user_config.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/gui/live_view.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"
#include "easypbr/viewer/viewer.h"

namespace easypbr::cli {
namespace {

struct ViewOptions {
    std::vector<std::string> files, values, passes;
    std::string size = "1280x720", environment, settings, screenshot, shader, animation, path, format;
    bool watch = false, light = false;
    float panel_scale = 1;
};

void declare_view(CLI::App& command, ViewOptions& options) {
    command.add_option("FILE", options.files,
                       "Meshes: PLY, OBJ, STL, OFF, glTF, GLB and more; - is standard input");
    declare_format(command, options.format);
    command.add_option("--size,--resolution", options.size, "Width and height of the window in pixels")
        ->option_text("WxH");
    command.add_option("--env,--hdri-file", options.environment, field("environment.file").doc)
        ->option_text("FILE");
    command.add_option("--settings", options.settings, "Start from a file that --save-settings wrote")
        ->option_text("FILE");
    command.add_option("--set", options.values, "Any setting, for example tonemap.exposure=2")
        ->allow_extra_args(false)
        ->option_text("KEY=VALUE");
    command
        .add_option("--animation", options.animation,
                    "Play this animation of the file, by name, or by number from 0")
        ->option_text("NAME");
    command.add_option("--camera-path", options.path, "Camera path from a JSON file, as in easypbr render")
        ->option_text("FILE");
    command.add_option("--shader", options.shader, field("material.shader").doc)->option_text("FILE");
    declare_passes(command, options.passes);
    command.add_flag("--watch", options.watch, "Reload files when they change");
    command
        .add_option("--ui-scale", options.panel_scale,
                    "Scale of panels and text relative to the screen's own, 0.5 to 4")
        ->option_text("X");
    command.add_flag("--light", options.light, "Use light panels instead of dark ones");
    command
        .add_option(
            "--screenshot", options.screenshot,
            "Write the contents of the window to an image file instead of opening it; needs no display")
        ->option_text("FILE");
}

RenderOptions look_of_view(const ViewOptions& options) {
    RenderOptions look;
    look.size = options.size;
    look.values = options.values;
    if (!options.environment.empty())
        look.shorthands.push_back({"--env", "environment.file", options.environment});
    if (!options.shader.empty()) look.shorthands.push_back({"--shader", "material.shader", options.shader});
    return look;
}

/// Plays what the first file that has animations calls so.
void play(Viewer& view, const std::vector<std::string>& names, const std::string& animation) {
    if (view.player().empty())
        throw ArgumentError(fmt::format("--animation {}: none of the files has animations", animation));
    for (const std::string& name : names)
        if (view.player().has(name)) return view.player().play(name, animation);
}

int run_view(const ViewOptions& options) {
    check_input("view", options.files);
    Viewer view{Scene()};
    apply_user_config(options.files, view.settings());
    if (!options.settings.empty()) app::load_settings(view.session(), options.settings);
    apply(look_of_view(options), view.settings());
    add_passes(options.passes, view.session());
    if (!options.screenshot.empty()) app::encoding_for(options.screenshot);
    const std::vector<std::string> names = unique_names(options.files);
    for (size_t i = 0; i < names.size(); ++i) {
        const io::LoadOptions load{.crease_angle_deg = view.settings().load.crease_deg,
                                   .memory_gb = view.settings().limits.memory,
                                   .format = options.format};
        const io::LoadedScene loaded = load_drawable(options.files[i], load);
        show(view.scene(), loaded, names[i]);
        if (!loaded.animations.empty()) view.player().add(names[i], loaded.animations);
        if (options.watch && options.files[i] != standard_input)
            view.live().drawing().files().watch(options.files[i], names[i]);
    }
    if (!options.animation.empty()) play(view, names, options.animation);
    if (!options.path.empty()) view.live().drawing().path().editor.set(io::load_camera_path(options.path));
    view.live().set_panel_scale(options.panel_scale);
    if (options.light) view.live().state().screen.theme = gui::Theme::light;
    if (options.screenshot.empty())
        view.show();
    else
        io::save_image(view.screenshot(), options.screenshot);
    return 0;
}

}  // namespace

void add_view(CLI::App& app, Job& job) {
    set_job<ViewOptions>(*app.add_subcommand("view", "Show mesh files in an interactive window"), job,
                         declare_view, run_view);
}

}  // namespace easypbr::cli
