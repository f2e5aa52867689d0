#include <fmt/format.h>

#include "easypbr/app/output.h"
#include "easypbr/app/scene_files.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/command.h"
#include "easypbr/cli/console.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/cli/standard_output.h"
#include "easypbr/cli/user_config.h"
#include "easypbr/cli/written_paths.h"
#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/settings.h"

namespace easypbr::cli {
namespace {

/// After which no further sample is taken. File managers wait for a few seconds.
constexpr float time_budget_s = 2;
constexpr int largest_size = 4096;

struct ThumbnailOptions {
    std::string file, output, format;
    int size = 256;
};

void declare_thumbnail(CLI::App& command, ThumbnailOptions& options) {
    command.add_option("file", options.file, "Mesh file to read; - is standard input")->option_text("FILE");
    command
        .add_option("-o,--output", options.output,
                    "PNG file to write, whatever its extension; '-': standard output")
        ->option_text("FILE");
    command.add_option("--size", options.size, "Width and height in pixels, 1 to 4096")
        ->option_text("N")
        ->capture_default_str();
    declare_format(command, options.format);
}

int run_thumbnail(const ThumbnailOptions& options) {
    require(!options.file.empty(), "thumbnail", "a mesh file");
    require(!options.output.empty(), "thumbnail", "an output file: -o FILE");
    if (options.size < 1 || options.size > largest_size)
        throw UsageError(
            fmt::format("thumbnail: --size: expected 1 to {}, got {}", largest_size, options.size));
    check_input("thumbnail", {options.file});
    const bool is_file = options.output != standard_output;
    if (!is_file) check_standard_output("thumbnail");
    if (is_file && options.file != standard_input)
        check_paths("thumbnail", {{"-o", options.output}}, {{"FILE", options.file}});
    be_quiet();
    if (is_file) check_writable(options.output);
    app::Session session;
    Settings& settings = session.settings();
    settings.background.mode = BackgroundMode::transparent;
    settings.image.samples = 4;
    settings.image.time_budget = time_budget_s;
    apply_user_config({options.file}, settings);
    show(session.scene(), load_drawable(options.file, app::load_options(settings, options.format)),
         unique_names({options.file}).front());
    const Vec2i size(options.size, options.size);
    const Image image = session.render({size, std::nullopt, app::encoding_for("-.png")});
    const std::vector<std::byte> png = io::encode_png(image);
    is_file ? write_file(options.output, png) : write_to_stdout(png);
    return 0;
}

}  // namespace

void add_thumbnail(CLI::App& app, Job& job) {
    set_job<ThumbnailOptions>(
        *app.add_subcommand("thumbnail", "Render a small picture of a mesh file, for file managers"), job,
        declare_thumbnail, run_thumbnail);
}

}  // namespace easypbr::cli
