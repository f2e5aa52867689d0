// What commands that show files until they are ended, view and serve, have alike.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/cli/render_options.h"

namespace easypbr::io {
struct LoadedScene;
}

namespace easypbr::cli {

struct ShownFiles {
    std::vector<std::string> files, values;
    StartSettings start;
    std::string environment, format, variant;
};

/// Ties FILE, --format, --variant, --env, --preset, --settings and --set to `options`, which must outlive the
/// parsing.
void declare_shown_files(CLI::App& command, ShownFiles& options);

/// What --variant, --env and --set say.
RenderOptions shown_look(const ShownFiles& options);

/// Reads the files into the session's scene, in their order, and calls `shown` after each with its number,
/// its name in the scene and what it holds. Throws as load_drawable() does.
void show_files(const ShownFiles& options, app::Session& session,
                const std::function<void(size_t, const std::string&, const io::LoadedScene&)>& shown);

}  // namespace easypbr::cli
