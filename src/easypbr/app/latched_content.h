// The content that automatic settings were inferred from and are kept for.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app {

/// Follows what changes after settings were latched.
class LatchedContent {
  public:
    /// Releases all latched settings, and returns true, where an object of a new name makes the content
    /// larger.
    bool release_outgrown(const SceneSnapshot& scene, Settings& settings);
    /// Releases an automatic camera that frames the content beside another annotation than is asked for now.
    void release_camera(Settings& settings) const;
    /// What one image has in place of latched values where the content or the camera has moved: a lower
    /// ground below what has sunk, a nearer near plane before what has come near.
    void follow(const SceneSnapshot& scene, const Settings& settings, ResolvedSettings& resolved);
    /// The settings were latched for this content, beside this annotation.
    void keep(const SceneSnapshot& scene, const BasicAnnotationSettings<Inferred>& annotation);

  private:
    struct Placed {
        uint64_t revision;  ///< of the vertices
        Eigen::Matrix4d T_world_mesh;
        double half_voxel, point_radius;
        bool operator==(const Placed&) const = default;
    };
    static std::vector<Placed> placed(const SceneSnapshot& scene);
    void lower_ground(const Settings& settings, ResolvedSettings& resolved) const;
    void bring_near_plane(const Settings& settings, ResolvedSettings& resolved);
    bool has_new_names(const SceneSnapshot& scene) const;

    /// Nothing: there is no annotation.
    using AnnotationAsked = std::optional<BasicAnnotationSettings<Inferred>>;
    static AnnotationAsked asked(const BasicAnnotationSettings<Inferred>& annotation);

    std::set<std::string> names_;
    AnnotationAsked annotation_;
    Box3d bounds_;                     ///< of the content of these names, when it was kept
    std::vector<Placed> placed_;       ///< content of the image before
    Box3d placed_bounds_;              ///< likewise
    std::vector<Placed> near_placed_;  ///< content that the near plane was inferred for
    Eigen::Matrix4d near_T_world_cam_ = Eigen::Matrix4d::Identity();  ///< camera that it was inferred for
};

}  // namespace easypbr::app
