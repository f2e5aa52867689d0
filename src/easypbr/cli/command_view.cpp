#include <fmt/format.h>

#include <optional>

#include "easypbr/app/output.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/shown_files.h"
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
    ShownFiles shown;
    std::vector<std::string> passes;
    std::string size = "1280x720", screenshot, shader, animation, path;
    bool watch = false, light = false;
    float panel_scale = 1;
};

void declare_view(CLI::App& command, ViewOptions& options) {
    declare_shown_files(command, options.shown);
    command.add_option("--size,--resolution", options.size, "Width and height of the window in pixels")
        ->option_text("WxH");
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
    RenderOptions look = shown_look(options.shown);
    look.size = options.size;
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

void check_view(const ViewOptions& options) {
    check_input("view", options.shown.files);
    check_start(options.shown.start);
    parse_size(options.size);
}

int run_view(const ViewOptions& options) {
    const ShownFiles& shown = options.shown;
    Viewer view{Scene()};
    apply_user_config(shown.files, view.settings());
    apply(shown.start, view.session());
    apply(look_of_view(options), view.settings());
    of_options([&] { view.live().set_panel_scale(options.panel_scale); });
    add_passes(options.passes, view.session());
    if (!options.screenshot.empty()) app::encoding_for(options.screenshot);
    show_files(shown, view.session(), [&](size_t i, const std::string& name, const io::LoadedScene& loaded) {
        if (!loaded.animations.empty()) view.player().add(name, loaded.animations, view.scene());
        if (options.watch && shown.files[i] != standard_input)
            view.live().drawing().files().watch(shown.files[i], name, loaded, shown.format);
    });
    if (!options.animation.empty()) play(view, unique_names(shown.files), options.animation);
    if (!options.path.empty()) view.live().drawing().path().editor.set(io::load_camera_path(options.path));
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
                         declare_view, run_view, check_view);
}

}  // namespace easypbr::cli
