#include "easypbr/viewer/viewer.h"

namespace easypbr {

Scene& default_scene() {
    static Scene scene;
    return scene;
}

Viewer::Viewer(const Scene& scene)
    : session_(std::make_unique<app::Session>(scene)),
      clock_(std::make_unique<app::Clock>()),
      recorder(*session_, *clock_) {}

Viewer::Viewer(Vec2i size, const std::filesystem::path& settings) : Viewer(default_scene()) {
    if (!settings.empty()) app::load_settings(*session_, settings);
    session_->settings().image.size = size;
}

void Viewer::load_environment_map(const std::filesystem::path& path) {
    session_->load_environment(path);
}

}  // namespace easypbr
