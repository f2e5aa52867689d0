// Animations of a file: poses of nodes, skins, morph targets, materials, lights and cameras over time
// (glTF 2.0, sections 3.7.2.2, 3.7.3 and 3.11; KHR_animation_pointer).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/scene/camera.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/mesh.h"

namespace easypbr {

/// How values between two keys come about.
enum class Interpolation {
    linear,       ///< rotations: spherical, the shorter way
    step,         ///< the last key's
    cubic_spline  ///< Hermite; each key has an in-tangent, a value and an out-tangent
};

enum class AnimatedProperty {
    translation,
    rotation,
    scale,
    weights,
    visibility,  ///< of the node with all that hangs below it; above 0.5: visible
    material,    ///< parameters of a material, as many as there are values in a row
    light,       ///< the same of a light
    camera       ///< the same of a camera
};

/// One property of one node, material, light or camera over time.
struct AnimationChannel {
    /// Index into AnimationRig::nodes; for a material, light or camera into AnimationRig::materials, lights
    /// or cameras.
    int node = 0;
    AnimatedProperty property = AnimatedProperty::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;  ///< seconds, finite and rising; at least one
    /// One row for each time, three for cubic splines, finite; rotations are x, y, z, w.
    ArrayXf values;
    int parameter = 0;  ///< of a material, light or camera: the first one
};

struct Animation {
    std::string name;
    double duration_s = 0;  ///< the last key's time; 0 or more
    std::vector<AnimationChannel> channels;
};

/// The value of a channel at a time; before the first key that of the first, after the last that of the last.
/// Rotations have unit length. Throws ArgumentError when there are no times, when values have not as many
/// rows and columns as times, interpolation and property need, and for NaN.
Array1d sample(const AnimationChannel& channel, double time_s);

/// How a mesh's vertices follow joints and morph targets.
struct Deformation {
    Array3f V, N;         ///< at rest; N may be empty
    Array4f uv_tangents;  ///< at rest, as MeshData has them, or empty
    /// n x 4 k, or empty: places in Skin::joints, and how much each joint counts.
    ArrayXf joints, weights;
    /// For each target what is added to V and N at weight 1; N may be empty.
    std::vector<Array3f> targets_V, targets_N;
    /// Faces with vertices of their own, whose normals are those of the face in every pose; or empty.
    Array3i flat_F;

    bool empty() const { return joints.empty() && targets_V.empty(); }
};

struct Skin {
    std::vector<int> joints;                       ///< nodes
    std::vector<Eigen::Affine3d> T_joint_at_rest;  ///< inverse bind matrices, one for each joint
};

struct AnimationNode {
    int parent = -1;
    Vec3d translation{0, 0, 0}, scale{1, 1, 1};
    Eigen::Quaterniond rotation{1, 0, 0, 0};
    std::optional<Eigen::Affine3d> matrix;  ///< in place of the three; such a node is not animated
    std::vector<float> weights;             ///< of the morph targets at rest
    std::optional<bool> visible;            ///< at rest; none where no animation changes it
    std::optional<Mesh> mesh;               ///< whose pose follows; none for nodes that only move others
    int skin = -1;
    Deformation deformation;
};

/// A material whose values change over time (KHR_animation_pointer).
struct AnimatedMaterial {
    std::vector<double> parameters;  ///< at rest
    std::function<Material(const std::vector<double>& parameters)> material;
    std::vector<std::pair<Mesh, size_t>> users;  ///< with the place in each mesh's materials
};

/// A light or camera that nodes of a file place, with values that may change over time.
template <class Value>
struct AnimatedItem {
    std::vector<double> parameters;  ///< at rest
    std::function<Value(const std::vector<double>& parameters, const Eigen::Affine3d& T_world_node)> value;
    std::vector<std::pair<std::string, int>> users;  ///< its name in the loaded scene, and the node
};

/// All nodes, materials, lights and cameras of a file with what moves and changes them.
struct AnimationRig {
    std::vector<AnimationNode> nodes;
    std::vector<AnimatedMaterial> materials;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<AnimatedItem<Light>> lights = {};
    std::vector<AnimatedItem<Camera>> cameras = {};
};

/// How meshes moved, each as a pose in its own frame: where it is at T_parent_mesh, it was at
/// T_parent_mesh * pose.
using MovedMeshes = std::vector<std::pair<Mesh, Eigen::Affine3d>>;

/// The animations of a file that was loaded, which move its meshes. Copies share the meshes.
class Animations {
  public:
    Animations() = default;
    /// Throws ArgumentError for indices out of range, for arrays and poses of a skin that do not fit
    /// together, for channels and durations that are not as they are described, and for functions that are
    /// not set.
    explicit Animations(AnimationRig rig);

    bool empty() const { return rig_.animations.empty(); }
    std::vector<std::string> names() const;
    /// The index of an animation by its name, or its number from 0. Throws NameError with the nearest name.
    size_t find(const std::string& name) const;
    double duration_s(size_t index) const;
    /// The time within an animation's duration that is shown at a time: with `loop` a whole number of
    /// durations after the beginning is the end. Throws as apply().
    double time_in(size_t index, double time_s, bool loop = true) const;

    /// Puts the meshes where they are at a time of an animation: poses and visibility of nodes, vertices and
    /// normals of what has skins or morph targets, and materials. A mesh that follows joints has the pose of
    /// the node that all of them hang from, without its scale, whatever its own node's is (glTF 2.0, section
    /// 3.7.3.3). With `loop` the time goes around, and a whole number of durations after the beginning is the
    /// end; else the animation rests at its ends. What the animation leaves alone is at rest. Throws
    /// NameError for an unknown index, ArgumentError for a time that is not finite.
    void apply(size_t index, double time_s, bool loop = true);

    /// Puts the vertices and normals where they are without an animation: by the weights at rest, and where
    /// the joints are at rest. Meshes without joints whose weights at rest are 0 keep their arrays. Meshes
    /// that follow joints take the pose of their skin, as in apply(); the others keep theirs, in the world.
    void put_at_rest();

    /// The lights that the animations of the file move, change or hide, at a time of one of them, by their
    /// names in io::LoadedScene::lights, in world space. A hidden one has no intensity. Throws as apply().
    std::map<std::string, Light> lights(size_t index, double time_s, bool loop = true) const;
    /// The same of the cameras.
    std::map<std::string, Camera> cameras(size_t index, double time_s, bool loop = true) const;

    /// How each node's mesh moved between two times of an animation. What jumps has no motion: an animation
    /// that went around moved since its beginning (played backwards: since its end), and channels of steps
    /// never move. Vertices apart. Throws as apply().
    MovedMeshes motion(size_t index, double from_s, double to_s, bool loop = true) const;
    /// Those of motion() that jumped too.
    MovedMeshes jumps(size_t index, double from_s, double to_s, bool loop = true) const;
    /// The cameras() where motion() to `to_s` begins.
    std::map<std::string, Camera> cameras_before(size_t index, double from_s, double to_s,
                                                 bool loop = true) const;

  private:
    struct Pose;
    struct PutMaterials;
    std::vector<Pose> pose_at_rest() const;
    struct Moment;
    std::vector<Pose> pose(const Animation& animation, const Moment& moment) const;
    /// A time, brought into the animation's duration with `loop`.
    Moment moment(size_t index, double time_s, bool loop) const;
    /// Where motion() begins.
    Moment moment_before(size_t index, double from_s, double to_s, bool loop) const;
    MovedMeshes moved_between(const std::vector<Pose>& from, const std::vector<Pose>& to) const;
    std::vector<Eigen::Affine3d> world_poses(const std::vector<Pose>& poses) const;
    /// Whether the node or one above it is hidden.
    bool is_hidden(int node, const std::vector<Pose>& poses) const;
    /// Whether an animation moves or hides the node or one above it.
    bool is_moved(int node) const;
    template <class Value>
    std::map<std::string, Value> placed(const std::vector<AnimatedItem<Value>>& items,
                                        AnimatedProperty property, size_t index, const Moment& moment) const;
    /// Where nodes and the meshes that are drawn for them are. They differ for what follows joints.
    struct Places;
    Places places(const std::vector<Pose>& poses) const;
    /// The pose in the world of the meshes that follow the joints of a skin.
    Eigen::Affine3d pose_of_skin(int skin, const std::vector<Eigen::Affine3d>& T_world_nodes) const;
    /// Whether the pose of a node's mesh depends on joints: it follows them, or hangs from what does.
    bool is_placed_by_joints(size_t node) const;
    void deform(AnimationNode& node, const Eigen::Affine3d& T_world_mesh, const std::vector<float>& weights,
                const std::vector<Eigen::Affine3d>& T_world_nodes);
    void put_materials(const Animation& animation, const Moment& moment);

    AnimationRig rig_;
    std::vector<size_t> order_;  ///< parents before children
    /// Copies share it, as they share the meshes.
    std::shared_ptr<PutMaterials> put_materials_;
    std::vector<bool> moved_;      ///< nodes that channels name
    std::vector<int> skin_nodes_;  ///< for each skin the node that all joints are or hang from; -1: none
};

}  // namespace easypbr
