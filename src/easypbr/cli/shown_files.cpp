#include "easypbr/cli/shown_files.h"

#include "easypbr/app/scene_files.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {

void declare_shown_files(CLI::App& command, ShownFiles& options) {
    command.add_option("FILE", options.files,
                       "Meshes: PLY, OBJ, STL, OFF, glTF, GLB and more; - is standard input");
    declare_format(command, options.format);
    command.add_option("--variant", options.variant, field("load.variant").doc)->option_text("NAME");
    command.add_option("--env,--hdri-file", options.environment, field("environment.file").doc)
        ->option_text("FILE");
    declare_settings(command, options.start, options.values);
}

RenderOptions shown_look(const ShownFiles& options) {
    RenderOptions look;
    look.values = options.values;
    if (!options.environment.empty())
        look.shorthands.push_back({"--env", "environment.file", options.environment});
    if (!options.variant.empty()) look.shorthands.push_back({"--variant", "load.variant", options.variant});
    return look;
}

void show_files(const ShownFiles& options, app::Session& session,
                const std::function<void(size_t, const std::string&, const io::LoadedScene&)>& shown) {
    const std::vector<std::string> names = unique_names(options.files);
    for (size_t i = 0; i < names.size(); ++i) {
        const io::LoadedScene loaded =
            load_drawable(options.files[i], app::load_options(session.settings(), options.format));
        show(session.scene(), loaded, names[i]);
        shown(i, names[i], loaded);
    }
}

}  // namespace easypbr::cli
