#include "easypbr/cli/file_animation.h"

#include <algorithm>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/session.h"
#include "easypbr/cli/drawable.h"
#include "easypbr/core/error.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::cli {

FileAnimation::FileAnimation(const std::vector<io::LoadedScene>& loaded,
                             const std::vector<std::string>& names, const std::string& animation,
                             const std::string& camera) {
    const auto animated =
        std::ranges::find_if(loaded, [](const io::LoadedScene& file) { return !file.animations.empty(); });
    if (animated == loaded.end()) throw NameError("--animation: the files hold no animations");
    const auto file = size_t(animated - loaded.begin());
    animations_ = animated->animations;
    index_ = animations_.find(animation);
    file_ = names[file];
    if (camera.empty()) return;
    const FileCamera named = find_camera(loaded, camera);
    if (named.file == file) camera_ = named.name;
}

void FileAnimation::apply(app::Session& session, double time_s) {
    animations_.apply(index_, time_s);
    app::put_lights(session.scene(), file_, animations_, index_, time_s);
    if (const auto moved = camera(time_s)) session.set_camera(*moved);
}

void FileAnimation::replace_jumps(app::Session& session, double before_s, double time_s, bool camera) const {
    std::optional<Camera> from;
    if (camera && !camera_.empty()) from = named(animations_.cameras_before(index_, before_s, time_s));
    session.replace_motion(animations_.jumps(index_, before_s, time_s), from);
}

std::optional<Camera> FileAnimation::camera(double time_s) const {
    return camera_.empty() ? std::nullopt : named(animations_.cameras(index_, time_s));
}

std::optional<Camera> FileAnimation::named(const std::map<std::string, Camera>& cameras) const {
    const auto camera = cameras.find(camera_);
    return camera == cameras.end() ? std::nullopt : std::optional(camera->second);
}

}  // namespace easypbr::cli
