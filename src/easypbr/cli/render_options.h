// The options of `easypbr render` and what they mean as settings.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "easypbr/app/session.h"
#include "easypbr/core/file.h"
#include "easypbr/core/math.h"
#include "easypbr/remote/orbit_page.h"

namespace easypbr::cli {

/// Which settings a command starts from.
struct StartSettings {
    std::string preset;    ///< a built-in one's name or a file
    std::string settings;  ///< file
};

struct RenderOptions {
    std::vector<std::string> files;
    std::string output, format;
    bool batch = false, quiet = false, timing = false;
    bool smooth = false, flat = false;
    bool legend = false, colorbar = false, open = false;
    int bit_depth = 8;
    std::string size, background, ortho;
    std::string camera;  ///< name or number of a camera in the files
    std::string focus;   ///< "X,Y"
    std::string camera_pose, camera_axes;
    std::optional<int> turntable;      ///< frames of one turn
    std::string camera_path;           ///< file
    std::string orbit;                 ///< "36x3": columns and rows of a page
    std::optional<double> page_limit;  ///< megabytes
    std::string page_format, page_title;
    std::string hidden_lines;  ///< of a line drawing
    std::optional<double> fps;
    std::string codec;
    std::string animation;                 ///< name or number of one in the files
    std::optional<double> animation_time;  ///< seconds
    StartSettings start;
    std::string save_settings;
    std::vector<std::string> layers;
    std::vector<std::string> textures;  ///< "base_color=FILE"
    std::vector<std::string> values;    ///< --set: "group.name=value"
    std::vector<std::string> passes;    ///< "FILE" or "stage=FILE"
    std::vector<std::string> styles;    ///< "key=value" or "object.key=value"
    std::string label_map;              ///< a built-in one's name or a file

    /// An option whose value is a setting's, as it was written.
    struct Shorthand {
        std::string option, setting, text;
    };
    std::vector<Shorthand> shorthands;

    /// Many frames instead of one picture.
    bool records() const;
    /// One image and nothing else, where no file is named for it.
    bool shows_in_terminal() const {
        return output.empty() && !records() && !batch && !open && layers.empty() && bit_depth == 8;
    }
    /// Pictures from all around in one HTML file.
    bool is_page() const { return extension_of(output) == "html"; }
    /// Edges as vector graphics.
    bool is_line_drawing() const { return extension_of(output) == "svg"; }
};

/// The option of `render` whose value is this setting's, "--color" of material.color; empty: there is none.
std::string shorthand_option(std::string_view setting);

/// The setting that an option of `render` stands for, material.color for "--color"; empty: none.
std::string setting_of_shorthand(std::string_view option);

/// Ties the command's options to `options`, which must outlive the parsing.
void declare_render_options(CLI::App& command, RenderOptions& options);

/// The options --preset, --settings and --set.
void declare_settings(CLI::App& command, StartSettings& start, std::vector<std::string>& values);

/// Throws NameError for a preset that is neither built in nor a file's name.
void check_start(const StartSettings& start);

/// Sets what --preset says, then what --settings says. Throws as app::load_settings() and
/// app::apply_preset().
void apply(const StartSettings& start, app::Session& session);

/// Looks at the options alone. Throws UsageError for those that contradict each other or lack another,
/// ArgumentError or NameError for values that the library refuses.
void check_usage(const RenderOptions& options);

/// Sets what the options say, --set last; the rest stays as it is. Throws UsageError for a value that cannot
/// be understood, FileError or FormatError for a pose file.
void apply(const RenderOptions& options, Settings& settings);

/// What a page is written with. Throws UsageError.
app::OrbitPageOptions page_options_of(const RenderOptions& options);

/// What a line drawing is written with.
app::LineDrawingOptions line_drawing_options_of(const RenderOptions& options);

/// The pixel that --focus names; nothing without it. Throws UsageError when it is not X,Y.
std::optional<Vec2i> parse_focus(const std::string& text);

/// The option --pass.
void declare_passes(CLI::App& command, std::vector<std::string>& passes);
/// What --pass names, "FILE" or "STAGE=FILE". Throws UsageError for an unknown stage, FileError.
void add_passes(const std::vector<std::string>& passes, app::Session& session);

/// Width and height from "800x600" or "800,600". Throws UsageError when it is not of this form, or out of
/// range.
Vec2i parse_size(const std::string& text);

}  // namespace easypbr::cli
