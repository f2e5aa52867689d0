// Scene: named meshes, lights, an environment.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/scene/environment.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// What a frame is drawn from: a consistent copy of a scene's content.
struct SceneSnapshot {
    struct Object {
        std::string name;
        std::shared_ptr<const MeshData> mesh;
        Eigen::Affine3d T_world_mesh;  ///< pose of V in the scene's frame: the mesh's offset is in it
        /// The name under which its hierarchy is shown. `name` does not tell: a child "b" of "car" and what
        /// is shown as "car/b" are both "car/b".
        std::string root = {};
        uint64_t node = 0;  ///< Mesh::identity()
        /// How far what is drawn reaches beyond the vertices by the object's own style: half a voxel along
        /// each axis of V, and the radius of points whose size is in world units.
        double half_voxel = 0, point_radius = 0;
    };
    /// All visible nodes in the order of their names, parents before children ("car", "car/wheel"). What is
    /// hidden, or invisible by its style, is left out with its descendants.
    std::vector<Object> objects;
    std::map<std::string, Light> lights;
    Environment environment;  ///< empty: none was given
    Vec3d origin{0, 0, 0};    ///< see Scene::origin()

    /// Bounding box in world space of all vertices with their voxels and points (exact under rotation); empty
    /// when there are none.
    Box3d bounds() const;

    /// The largest dot product of each of six world directions (rows) with world positions of vertices and
    /// their voxels and points: how far the content reaches along them. Computed in double in parallel; minus
    /// infinity when there are no vertices.
    using Directions = Eigen::Matrix<double, 6, 3>;
    using Support = Eigen::Matrix<double, 6, 1>;
    Support support(const Directions& directions) const;
};

/// Shared by handle: copies, moved ones too, are the same scene. All members may be called from any thread.
class Scene {
  public:
    Scene();
    // Moving copies: a handle always has its scene.
    Scene(const Scene& other) = default;
    Scene& operator=(const Scene& other) = default;

    /// Shows a mesh under a name; the same name again replaces it. A mesh that is the child of another one
    /// moves with its parent, and is drawn once when both are shown.
    void show(const Mesh& mesh, const std::string& name);
    /// Throws NameError with the nearest name when there is none.
    Mesh get(const std::string& name) const;
    /// Throws NameError.
    void remove(const std::string& name);
    /// Hides (or shows again) without removing. Throws NameError.
    void hide(const std::string& name, bool hidden = true);
    /// Removes all meshes and lights and the environment, and forgets the origin.
    void clear();
    std::vector<std::string> names() const;
    bool contains(const std::string& name) const;

    /// Adds or replaces a light.
    void set_light(const std::string& name, const Light& light);
    /// Throws NameError.
    Light light(const std::string& name) const;
    /// Throws NameError.
    void remove_light(const std::string& name);
    std::vector<std::string> light_names() const;
    /// Keeps an inferred radius in a light whose own is automatic; does nothing when there is no such light.
    void latch_light_radius(const std::string& name, float radius);
    /// Forgets all latched radii.
    void release_light_radii();

    void set_environment(const Environment& environment);
    Environment environment() const;

    /// Where the scene's frame has its origin, in the coordinates that meshes were given (offset + V):
    /// cameras, lights, poses and pictures are relative to it. It is the offset of the mesh that was shown
    /// first, taken when something is drawn for the first time; so it is zero unless that mesh lies far from
    /// zero.
    Vec3d origin() const;
    /// Throws ArgumentError when it is not finite.
    void set_origin(const Vec3d& origin);

    SceneSnapshot snapshot() const;

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

}  // namespace easypbr
