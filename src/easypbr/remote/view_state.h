// What a View keeps; see view.cpp and view_orders.cpp.
#pragma once

#include <string>

#include "easypbr/remote/moving_pictures.h"
#include "easypbr/remote/recorded_widgets.h"
#include "easypbr/remote/served_files.h"
#include "easypbr/remote/tool_panels.h"
#include "easypbr/remote/view.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote {

struct View::Own {
    Own(const Scene& scene, const Settings& settings, ViewClients clients,
        std::unique_ptr<ServedFiles> given_files);
    Own(Own& shared, ViewClients clients, const OwnViewOf& own);

    /// Keeps a change of the settings, which were `before`, unless nothing can be drawn by it. Throws why.
    void keep_drawable(const Settings& before);

    /// The last one that there was while the settings give no camera.
    std::string camera_message();
    std::string written_camera();
    std::string scene_message();
    std::string animation_message() const;
    std::string statistics_message(const ViewClients& clients);

    app::Session session;
    app::Clock clock;
    app::Recorder recorder{session, clock};
    app::AnimationPlayer player{clock};
    app::LiveDrawing live{session, recorder, player};
    const app::AnimationPlayer& scene_player;  ///< that moves the scene
    const Settings first;                      ///< what a reset returns to
    Settings given;                            ///< of the program, at its last take_settings()
    Vec2i size{1280, 720};

    uint32_t input = 0;
    double last_frame_s = now_seconds(), last_change_s = -1, last_still_s = -1, waits_since_s = 0;
    bool has_drawn = false;
    bool owes_still = false;  ///< what is shown at rest has not been sent exactly
    bool has_news = false;    ///< what is shown at rest has not been sent at all

    FieldTexts told;
    Settings told_settings;  ///< that `told` was written from
    /// What the camera's message was written from, and the message.
    struct WrittenCamera {
        uint64_t version = 0;  ///< Session::picture_version()
        Settings settings;
        std::string message;
    };
    WrittenCamera camera;
    std::map<std::string, PanelMemory> panel_memories;
    std::string told_camera, told_scene, told_animation, told_panels, told_statistics;
    double acted_s = 0;  ///< when a client asked for something last
    double told_s = -1;
    uint64_t notices = 0;

    VideoDownloads videos{live};
    std::unique_ptr<ServedFiles> files;  ///< null: none
    ToolState tool_state{live, videos, false, files.get()};
    ToolPanels tools;
    ClientId tool_user = 0;  ///< who used a tool last, and gets what is recorded

    MovingPictures moving_pictures;
    // Last, so that they end first.
    Encoder moving, stills;
};

}  // namespace easypbr::remote
