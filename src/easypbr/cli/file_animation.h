// The animation of a file that --animation names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/scene/animation.h"
#include "easypbr/scene/camera.h"

namespace easypbr::app {
class Session;
}
namespace easypbr::io {
struct LoadedScene;
}

namespace easypbr::cli {

class FileAnimation {
  public:
    /// Of the first of the files that has animations; `names` are those of their objects in the scene.
    /// `camera`: name or number of the files' camera that the session has, or empty. Throws NameError.
    FileAnimation(const std::vector<io::LoadedScene>& loaded, const std::vector<std::string>& names,
                  const std::string& animation, const std::string& camera);

    /// Puts meshes and lights where they are `time_s` seconds after its start, and the session's camera where
    /// the animation moves that.
    void apply(app::Session& session, double time_s);
    /// In the next picture, at `time_s`, nothing jumps that was put where it is at `before_s` for the one
    /// before: it moves as Animations::motion() says. `camera`: so does the camera that apply() has put.
    void replace_jumps(app::Session& session, double before_s, double time_s, bool camera) const;
    double duration_s() const { return animations_.duration_s(index_); }

    /// The named camera at a time; nothing where none is named or the animation leaves it alone.
    std::optional<Camera> camera(double time_s) const;

  private:
    std::optional<Camera> named(const std::map<std::string, Camera>& cameras) const;

    Animations animations_;
    size_t index_ = 0;
    std::string file_, camera_;
};

}  // namespace easypbr::cli
