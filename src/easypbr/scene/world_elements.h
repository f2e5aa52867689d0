// Faces and vertices of an object of a scene, in world space.
#pragma once

#include <algorithm>
#include <array>

#include "easypbr/scene/scene.h"

namespace easypbr::detail {

/// The faces of an object; of what has none its vertices, as faces without area. The object outlives it.
class WorldElements {
  public:
    using Corners = std::array<Vec3d, 3>;

    explicit WorldElements(const SceneSnapshot::Object& object)
        : mesh_(*object.mesh), T_world_mesh_(object.T_world_mesh) {}

    size_t count() const { return size_t(has_faces() ? mesh_.F.rows() : mesh_.V.rows()); }
    Corners corners(size_t i) const {
        const auto at = Eigen::Index(i);
        if (!has_faces()) return {vertex(at), vertex(at), vertex(at)};
        return {vertex(mesh_.F(at, 0)), vertex(mesh_.F(at, 1)), vertex(mesh_.F(at, 2))};
    }

  private:
    bool has_faces() const { return !mesh_.F.empty(); }
    Vec3d vertex(Eigen::Index i) const {
        return T_world_mesh_ * Vec3d(mesh_.V.row(i).transpose().cast<double>());
    }

    const MeshData& mesh_;
    const Eigen::Affine3d& T_world_mesh_;
};

inline bool are_finite(const WorldElements::Corners& corners) {
    return std::ranges::all_of(corners, [](const Vec3d& corner) { return corner.allFinite(); });
}

}  // namespace easypbr::detail
