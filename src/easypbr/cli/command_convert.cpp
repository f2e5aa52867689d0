#include <fmt/format.h>
#include <fmt/ranges.h>

#include "easypbr/app/output.h"
#include "easypbr/app/scene_files.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/mesh_steps.h"
#include "easypbr/cli/render_options.h"
#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/crease.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

struct ConvertOptions {
    std::string in, out, format, crease, variant, memory;
    std::vector<MeshStep> steps;
};

void declare_convert(CLI::App& command, ConvertOptions& options) {
    command.add_option("IN", options.in, "Mesh or image file; - is a mesh from standard input");
    declare_format(command, options.format);
    command.add_option(
        "OUT", options.out,
        fmt::format("Mesh file ({}) or image file ({})", fmt::join(io::writable_extensions(), ", "),
                    fmt::join(io::writable_image_extensions(), ", ")));
    command
        .add_option(
            "--crease", options.crease,
            "Crease angle of a mesh without normals: edges between faces at a larger angle are sharp; "
            "30 for STL files without it")
        ->option_text("DEG");
    command
        .add_option("--memory", options.memory,
                    "Most that the arrays and images of IN may take; 0: three quarters of what is available")
        ->option_text("GB");
    command.add_option("--variant", options.variant, field("load.variant").doc)->option_text("NAME");
    declare_mesh_steps(command, options.steps);
}

/// What options of reading say, as settings take it.
Settings settings_of(const ConvertOptions& options) {
    RenderOptions look;
    for (const RenderOptions::Shorthand& shorthand :
         {RenderOptions::Shorthand{"--crease", "load.crease_deg", options.crease},
          {"--memory", "limits.memory", options.memory},
          {"--variant", "load.variant", options.variant}})
        if (!shorthand.text.empty()) look.shorthands.push_back(shorthand);
    Settings settings;
    apply(look, settings);
    return settings;
}

/// Throws UsageError or ArgumentError for what the names of IN and OUT alone show.
void check_out(const ConvertOptions& options) {
    const bool is_image = is_image_file(options.in);
    if (options.out == "-")
        throw UsageError(fmt::format(
            "convert: OUT names a file, not standard output: expected one with extension {}",
            fmt::join(is_image ? io::writable_image_extensions() : io::writable_extensions(), ", ")));
    if (!is_image) {
        try {
            io::check_mesh_extension(options.out);
        } catch (const FormatError& error) {
            throw UsageError(error.what());
        }
        return;
    }
    if (!options.steps.empty())
        throw UsageError("convert: " + options.steps.front().option + " is for meshes, and " + options.in +
                         " is an image");
    app::encoding_for(options.out);
}

void check_convert(const ConvertOptions& options) {
    require(!options.out.empty(), "convert", "IN and OUT");
    check_input("convert", {options.in});
    settings_of(options);
    check_out(options);
    check_mesh_steps(options.steps);
}

int run_convert(const ConvertOptions& options) {
    check_writable(options.out);
    if (!is_image_file(options.in)) {
        const io::LoadOptions load = app::load_options(settings_of(options), options.format);
        io::LoadedScene scene = load_input(options.in, load);
        if (load.crease_angle_deg) split_creases(scene.mesh, *load.crease_angle_deg);
        Phases phases(options.steps.empty() ? 1 : int(options.steps.size()) + 2);
        scene.mesh = apply_mesh_steps(scene.mesh, options.steps, phases);
        phases.begin("writing " + options.out);
        io::save_scene(scene, options.out);
        return 0;
    }
    io::save_image(io::load_image(options.in), options.out);
    return 0;
}

}  // namespace

void add_convert(CLI::App& app, Job& job) {
    set_job<ConvertOptions>(
        *app.add_subcommand(
            "convert",
            "Convert a mesh or an image to another format; mesh operations run in the order given"),
        job, declare_convert, run_convert, check_convert);
}

}  // namespace easypbr::cli
