// Faces and vertices of an object of a scene, in world space; which faces have a material.
#pragma once

#include <algorithm>
#include <array>

#include "easypbr/scene/draw_style.h"
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

/// Calls body(material, begin, end) for ranges of faces that have a material in common, where an object is
/// drawn as faces.
template <class Body>
void for_each_material(const MeshData& mesh, const Style& overrides, const Body& body) {
    static const Material plain;
    if (mesh.F.empty() || resolve_style(mesh, overrides).mode != DrawMode::mesh) return;
    const auto material = [&](int i) -> const Material& {
        return size_t(i) < mesh.materials.size() ? mesh.materials[size_t(i)] : plain;
    };
    if (mesh.parts.empty()) body(material(0), 0, size_t(mesh.F.rows()));
    for (const MeshPart& part : mesh.parts)
        body(material(part.material), size_t(part.first_face),
             size_t(part.first_face) + size_t(part.face_count));
}

}  // namespace easypbr::detail
