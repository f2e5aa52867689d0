// The tool that opens files beneath the folder that is served.
#include <fmt/format.h>

#include <algorithm>

#include "easypbr/app/scene_files.h"
#include "easypbr/core/ascii.h"
#include "easypbr/core/interrupt.h"
#include "easypbr/remote/served_files.h"
#include "easypbr/remote/tool_panels.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {
namespace {

/// More entries are found by a part of their names.
constexpr size_t most_entries = 200;

std::string size_text(uint64_t bytes) {
    constexpr double kb = 1e3, mb = 1e6, gb = 1e9;
    const double size = double(bytes);
    if (size < kb) return fmt::format("{} B", bytes);
    if (size < mb) return fmt::format("{:.0f} kB", size / kb);
    return size < gb ? fmt::format("{:.1f} MB", size / mb) : fmt::format("{:.1f} GB", size / gb);
}

/// Whether a name has a part, small letters or large.
bool has_part(const std::string& name, const std::string& part) {
    const auto same = [](char a, char b) { return ascii::to_lower(a) == ascii::to_lower(b); };
    return std::search(name.begin(), name.end(), part.begin(), part.end(), same) != name.end() ||
           part.empty();
}

/// Removes what clients have had shown before, with its lights and animations.
void clear_shown(ServedFiles& files, app::LiveDrawing& live) {
    for (const std::string& name : std::exchange(files.shown, {})) live.files().close(name);
    // What the settings inferred was inferred from it.
    live.session().refit();
}

void show(ServedFiles& files, app::LiveDrawing& live, ServedFiles::Opened opened) {
    if (auto* environment = std::get_if<Environment>(&opened.content)) {
        live.session().settings().environment.file.clear();
        live.session().scene().set_environment(*environment);
        return live.notifications().add("Environment: " + opened.path.filename().string());
    }
    const bool replaces = !files.adds && !files.shown.empty();
    if (replaces) clear_shown(files, live);
    files.shown.push_back(live.files().add(std::get<io::LoadedScene>(opened.content), opened.path));
    if (replaces) live.navigation().ask_fit();
}

void take_opened(ServedFiles& files, app::LiveDrawing& live) try {
    if (auto opened = files.take()) show(files, live, std::move(*opened));
} catch (const Interrupted&) {
    // Nobody waits for it any more.
}

/// Returns whether it goes elsewhere: the list is another one then.
bool entry_row(RecordedWidgets& ui, ServedFiles& files, app::LiveDrawing& live, const FolderEntry& entry) {
    const std::string name = entry.name;
    if (entry.is_folder) {
        if (!ui.button(name + "/")) return false;
        files.enter(name);
        return true;
    }
    if (ui.button(name)) files.open(name, app::load_options(live.session().settings()));
    ui.same_line();
    ui.text(size_text(entry.bytes));
    return false;
}

void list_rows(RecordedWidgets& ui, ServedFiles& files, app::LiveDrawing& live) {
    size_t shown = 0, more = 0;
    for (const FolderEntry& entry : std::vector<FolderEntry>(files.entries())) {
        if (!has_part(entry.name, files.search)) continue;
        if (shown >= most_entries)
            ++more;
        else if (++shown; entry_row(ui, files, live, entry))
            return;
    }
    if (more > 0) ui.text(fmt::format("and {} more: find them by a part of their names", more));
    if (shown == 0) ui.text("There is nothing here that can be opened.");
}

}  // namespace

void files_tool(RecordedWidgets& ui, ToolState& state) {
    ServedFiles& files = *state.files;
    take_opened(files, state.live);
    if (const std::string name = files.reading(); !name.empty()) {
        ui.text(fmt::format("Reading {} ...", name));
        ui.same_line();
        if (ui.button("Stop")) files.stop();
    }
    if (!ui.section("Browse", true)) return;
    ui.checkbox("Add to what is shown", files.adds);
    ui.text_field("Find", files.search);
    ui.text("/" + files.place().string());
    if (!files.place().empty() && ui.button("..")) return files.leave();
    list_rows(ui, files, state.live);
}

}  // namespace easypbr::remote
