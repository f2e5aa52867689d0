// ToolPanels: the page's own panels, recorded as those of programs are.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "easypbr/remote/recorded_widgets.h"
#include "easypbr/remote/video_downloads.h"

namespace easypbr::remote {

class ServedFiles;

/// What a tool changes.
struct ToolState {
    app::LiveDrawing& live;
    VideoDownloads& videos;
    bool wants_video = false;      ///< the last recording shall be sent again
    ServedFiles* files = nullptr;  ///< null: clients may open none
};

/// Material and style of the selected object.
void object_tool(RecordedWidgets& ui, ToolState& state);
/// The three lights of the settings and the scene's own.
void lights_tool(RecordedWidgets& ui, ToolState& state);
/// Keys of a camera path, its shape; playing and scrubbing.
void path_tool(RecordedWidgets& ui, ToolState& state);
/// What is recorded, and how far it is.
void recording_tool(RecordedWidgets& ui, ToolState& state);
/// Files beneath the folder that is served; the state has some.
void files_tool(RecordedWidgets& ui, ToolState& state);

/// A message to the clients of the view.
struct ToolText {
    std::string text;
    bool for_watchers = true;  ///< those who may watch only are told too
};

class ToolPanels {
  public:
    /// All of the state must outlive it. `whole`: with those that change the scene.
    ToolPanels(ToolState& state, bool whole) : state_(state), whole_(whole) {}

    /// Throws ArgumentError when there is no such panel.
    void edit(const SetWidget& message);
    /// Has each panel do what was done to it. Returns messages for what looks different than before; errors
    /// become notifications.
    std::vector<ToolText> news();
    /// What has been told of all of them.
    std::vector<ToolText> told() const;

  private:
    bool has(const std::string& name) const;
    std::string recorded(const std::string& name);

    ToolState& state_;
    const bool whole_;
    std::map<std::string, PanelMemory> memories_;
    std::map<std::string, std::string> told_;
};

}  // namespace easypbr::remote
