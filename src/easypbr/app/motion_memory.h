// Where things were in the picture before, for motion blur.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "easypbr/scene/motion.h"

namespace easypbr::app {

class MotionMemory {
  public:
    /// Nothing is known of before.
    void forget() {
        motion_.reset();
        jumps_ = {};
    }
    /// The next picture's motion begins with this scene, as if it had been drawn from this camera; none: from
    /// the picture's own.
    void begin(const SceneSnapshot& scene, const std::optional<Camera>& from) {
        begin_.emplace(scene, from);
        jumps_ = {};
    }
    /// In the next picture these meshes, and the camera, moved so, whatever they did since the one before. Of
    /// several calls for a mesh the last one counts.
    void replace(const MovedMeshes& moved, const std::optional<Camera>& from) {
        for (const auto& [mesh, pose] : moved)
            jumps_.poses.insert_or_assign(mesh.identity(), std::pair(mesh, pose));
        if (from) jumps_.camera = from;
    }
    /// What the next picture, of this scene and camera, begins from; null: nothing is known.
    const std::shared_ptr<const Motion>& before(const SceneSnapshot& scene, const Camera& camera) {
        if (const auto begin = std::exchange(begin_, std::nullopt))
            keep(begin->first, begin->second.value_or(camera));
        const Jumps jumps = std::exchange(jumps_, {});
        if (motion_ && !jumps.empty())
            motion_ = std::make_shared<const Motion>(jumps.out_of(*motion_, scene));
        return motion_;
    }
    /// What was drawn.
    void keep(const SceneSnapshot& scene, const Camera& camera) {
        motion_ = std::make_shared<const Motion>(scene, camera);
    }

  private:
    struct Jumps {
        std::map<uint64_t, std::pair<Mesh, Eigen::Affine3d>> poses;  ///< by the meshes' identity
        std::optional<Camera> camera;

        bool empty() const { return poses.empty() && !camera; }
        Motion out_of(Motion motion, const SceneSnapshot& scene) const {
            MovedMeshes moved;
            for (const auto& [identity, mesh] : poses) moved.push_back(mesh);
            motion.replace(scene, moved);
            if (camera) motion.camera = *camera;
            return motion;
        }
    };

    std::shared_ptr<const Motion> motion_;
    std::optional<std::pair<SceneSnapshot, std::optional<Camera>>> begin_;
    Jumps jumps_;
};

}  // namespace easypbr::app
