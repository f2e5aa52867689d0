// Where things were in the picture before, for motion blur.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "easypbr/scene/motion.h"

namespace easypbr::app {

class MotionMemory {
  public:
    /// Nothing is known of before.
    void forget() { motion_.reset(); }
    /// The next picture's motion begins with this scene, as if it had been drawn from this camera; none: from
    /// the picture's own.
    void begin(const SceneSnapshot& scene, const std::optional<Camera>& from) { begin_.emplace(scene, from); }
    /// What the next picture, of this camera, begins from; null: nothing is known.
    const std::shared_ptr<const Motion>& before(const Camera& camera) {
        if (const auto begin = std::exchange(begin_, std::nullopt))
            keep(begin->first, begin->second.value_or(camera));
        return motion_;
    }
    /// What was drawn.
    void keep(const SceneSnapshot& scene, const Camera& camera) {
        motion_ = std::make_shared<const Motion>(scene, camera);
    }

  private:
    std::shared_ptr<const Motion> motion_;
    std::optional<std::pair<SceneSnapshot, std::optional<Camera>>> begin_;
};

}  // namespace easypbr::app
