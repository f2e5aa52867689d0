#include "easypbr/scene/animation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>

#include "easypbr/core/error.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/animation_rig.h"
#include "easypbr/scene/deformation.h"

namespace easypbr {
namespace {

/// Times that differ by less than this, as a fraction of the duration, are the same: keys are floats, so that
/// 2.1 s is not exactly where the animation ends that lasts as long.
constexpr double same_time = 1e-6;

Eigen::Quaterniond quaternion(const Eigen::VectorXd& xyzw) {
    return Eigen::Quaterniond(Eigen::Vector4d(xyzw));
}

bool is_of_node(const AnimationChannel& channel) {
    return channel.property < AnimatedProperty::material;
}

/// Of a moment, at which channels of steps may have another time than the others.
struct ChannelTimes {
    double time_s, step_time_s;

    double of(const AnimationChannel& channel) const {
        return channel.interpolation == Interpolation::step ? step_time_s : time_s;
    }
};

/// The parameters of all items at a time of an animation.
template <class Item>
std::vector<std::vector<double>> parameters_at(const std::vector<Item>& items, AnimatedProperty property,
                                               const Animation& animation, const ChannelTimes& times) {
    std::vector<std::vector<double>> parameters;
    for (const Item& item : items) parameters.push_back(item.parameters);
    for (const AnimationChannel& channel : animation.channels) {
        if (channel.property != property) continue;
        const Eigen::VectorXd value = sample(channel, times.of(channel));
        std::copy(value.begin(), value.end(), parameters[size_t(channel.node)].begin() + channel.parameter);
    }
    return parameters;
}

/// Scaled to nothing along an axis at least: it has no inverse.
bool is_flat(const Eigen::Affine3d& T) {
    return !(std::abs(T.linear().determinant()) >= 1e-30);
}

bool follows_joints(const AnimationNode& node) {
    return node.skin >= 0 && !node.deformation.joints.empty();
}

/// The node that all joints of a skin are or hang from, the nearest to them; -1: there is none.
int common_node(const Skin& skin, const std::vector<AnimationNode>& nodes) {
    int common = skin.joints.empty() ? -1 : skin.joints[0];
    for (const int joint : skin.joints) {
        std::vector<int> path;
        for (int node = joint; node >= 0; node = nodes[size_t(node)].parent) path.push_back(node);
        while (common >= 0 && std::ranges::find(path, common) == path.end())
            common = nodes[size_t(common)].parent;
    }
    return common;
}

/// The nearest matrix of unit axes at right angles, mirrored where M is.
Mat3d without_stretch(const Mat3d& M) {
    if (!M.allFinite()) return Mat3d::Identity();  // of a file with scales beyond all numbers
    const Eigen::JacobiSVD<Mat3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
}

void show(Mesh& mesh, bool visible) {
    Style style = mesh.style();
    if (style.visible.value() == visible) return;
    style.visible = visible;
    mesh.set_style(style);
}

}  // namespace

/// Parameters of materials as they were put last.
struct Animations::PutMaterials {
    std::mutex mutex;
    std::vector<std::vector<double>> parameters;
};

struct Animations::Moment : ChannelTimes {
    explicit Moment(double time_s) : Moment(time_s, time_s) {}
    Moment(double time_s, double step_time_s) : ChannelTimes{time_s, step_time_s} {}
};

struct Animations::Places {
    std::vector<Eigen::Affine3d> T_world_nodes, T_parent_meshes, T_world_meshes;
};

/// A node's properties at a moment.
struct Animations::Pose {
    Vec3d translation, scale;
    Eigen::Quaterniond rotation;
    std::vector<float> weights;
    std::optional<bool> visible;
    std::optional<Eigen::Affine3d> fixed;  ///< in place of the three

    Eigen::Affine3d matrix() const {
        if (fixed) return *fixed;
        return Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale);
    }
};

Animations::Animations(AnimationRig rig)
    : rig_(std::move(rig)), put_materials_(std::make_shared<PutMaterials>()) {
    const size_t count = rig_.nodes.size();
    check_rig(rig_);
    moved_.assign(count, false);
    for (const Animation& animation : rig_.animations)
        for (const AnimationChannel& channel : animation.channels)
            if (is_of_node(channel)) moved_[size_t(channel.node)] = true;
    for (const AnimatedMaterial& material : rig_.materials)
        put_materials_->parameters.push_back(material.parameters);
    std::vector<bool> placed(count, false);
    // As many rounds as the hierarchy is deep; a circle would never be placed.
    for (bool again = true; again;) {
        again = false;
        for (size_t i = 0; i < count; ++i) {
            const int parent = rig_.nodes[i].parent;
            if (placed[i] || (parent >= 0 && !placed[size_t(parent)])) continue;
            order_.push_back(i);
            placed[i] = again = true;
        }
    }
    if (order_.size() != count) throw ArgumentError("animation rig: a node is its own descendant");
    for (const Skin& skin : rig_.skins) skin_nodes_.push_back(common_node(skin, rig_.nodes));
}

std::vector<std::string> Animations::names() const {
    std::vector<std::string> names;
    for (const Animation& animation : rig_.animations) names.push_back(animation.name);
    return names;
}

size_t Animations::find(const std::string& name) const {
    const std::vector<std::string> known = names();
    if (const auto found = std::ranges::find(known, name); found != known.end())
        return size_t(found - known.begin());
    size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number < known.size()) return number;
    throw NameError(fmt::format("there is no animation '{}'{}; there {}", name, did_you_mean(name, known),
                                known.empty() ? "is none" : fmt::format("are {}", fmt::join(known, ", "))));
}

double Animations::duration_s(size_t index) const {
    if (index >= rig_.animations.size())
        throw NameError(fmt::format("there is no animation {}: there are {}", index, rig_.animations.size()));
    return rig_.animations[index].duration_s;
}

std::vector<Animations::Pose> Animations::pose_at_rest() const {
    std::vector<Pose> poses;
    for (const AnimationNode& node : rig_.nodes)
        poses.push_back(
            {node.translation, node.scale, node.rotation, node.weights, node.visible, node.matrix});
    return poses;
}

std::vector<Animations::Pose> Animations::pose(const Animation& animation, const Moment& moment) const {
    std::vector<Pose> poses = pose_at_rest();
    for (const AnimationChannel& channel : animation.channels) {
        if (!is_of_node(channel)) continue;
        Pose& pose = poses[size_t(channel.node)];
        const Eigen::VectorXd value = sample(channel, moment.of(channel));
        switch (channel.property) {
            case AnimatedProperty::translation:
                pose.translation = value;
                break;
            case AnimatedProperty::scale:
                pose.scale = value;
                break;
            case AnimatedProperty::rotation:
                pose.rotation = quaternion(value);
                break;
            case AnimatedProperty::weights: {
                const Eigen::VectorXf weights = value.cast<float>();
                pose.weights.assign(weights.begin(), weights.end());
                break;
            }
            case AnimatedProperty::visibility:
                pose.visible = value[0] > 0.5;
                break;
            default:
                break;
        }
    }
    return poses;
}

double Animations::time_in(size_t index, double time_s, bool loop) const {
    const double duration = duration_s(index);
    if (!std::isfinite(time_s))
        throw ArgumentError(fmt::format("animation: expected a finite time, got {}", time_s));
    if (!loop || !(duration > 0)) return time_s;
    const double turns = std::floor(time_s / duration), within = time_s - duration * turns;
    return turns >= 1 && within <= same_time * duration ? duration : within;
}

Animations::Moment Animations::moment(size_t index, double time_s, bool loop) const {
    return Moment(time_in(index, time_s, loop));
}

Animations::Moment Animations::moment_before(size_t index, double from_s, double to_s, bool loop) const {
    const double end = time_in(index, to_s, loop);
    if (!loop) return {time_in(index, from_s, loop), end};
    const double begin = end - (to_s - time_in(index, from_s, false));
    return {std::clamp(begin, 0.0, std::max(duration_s(index), 0.0)), end};
}

MovedMeshes Animations::moved_between(const std::vector<Pose>& from, const std::vector<Pose>& to) const {
    MovedMeshes moved;
    const std::vector<Eigen::Affine3d> begins = places(from).T_parent_meshes,
                                       ends = places(to).T_parent_meshes;
    for (size_t i = 0; i < rig_.nodes.size(); ++i) {
        const AnimationNode& node = rig_.nodes[i];
        if (!node.mesh || (node.matrix && !is_placed_by_joints(i))) continue;
        const Eigen::Affine3d &begin = begins[i], &end = ends[i];
        // What is scaled to nothing is nowhere.
        if (is_flat(end)) continue;
        // What rests does so exactly.
        moved.emplace_back(*node.mesh, begin.matrix() == end.matrix() ? Eigen::Affine3d::Identity()
                                                                      : end.inverse(Eigen::Affine) * begin);
    }
    return moved;
}

MovedMeshes Animations::motion(size_t index, double from_s, double to_s, bool loop) const {
    const Moment begin = moment_before(index, from_s, to_s, loop), end = moment(index, to_s, loop);
    const Animation& animation = rig_.animations[index];
    return moved_between(pose(animation, begin), pose(animation, end));
}

MovedMeshes Animations::jumps(size_t index, double from_s, double to_s, bool loop) const {
    const Moment begin = moment_before(index, from_s, to_s, loop);
    Moment was = moment(index, from_s, loop);
    // It did not go around.
    if (std::abs(was.time_s - begin.time_s) <= same_time * duration_s(index)) was.time_s = begin.time_s;
    const Animation& animation = rig_.animations[index];
    const std::vector<Pose> from = pose(animation, begin), before = pose(animation, was);
    const std::vector<Eigen::Affine3d> begins = places(from).T_parent_meshes,
                                       ends_before = places(before).T_parent_meshes;
    std::vector<uint64_t> jumped;
    for (size_t i = 0; i < rig_.nodes.size(); ++i)
        if (rig_.nodes[i].mesh && begins[i].matrix() != ends_before[i].matrix())
            jumped.push_back(rig_.nodes[i].mesh->identity());
    if (jumped.empty()) return {};
    MovedMeshes moved = moved_between(from, pose(animation, moment(index, to_s, loop)));
    std::erase_if(moved, [&](const auto& mesh) {
        return std::ranges::find(jumped, mesh.first.identity()) == jumped.end();
    });
    return moved;
}

std::vector<Eigen::Affine3d> Animations::world_poses(const std::vector<Pose>& poses) const {
    std::vector<Eigen::Affine3d> T_world_nodes(rig_.nodes.size());
    for (const size_t i : order_) {
        const int parent = rig_.nodes[i].parent;
        T_world_nodes[i] = parent < 0 ? poses[i].matrix() : T_world_nodes[size_t(parent)] * poses[i].matrix();
    }
    return T_world_nodes;
}

bool Animations::is_hidden(int node, const std::vector<Pose>& poses) const {
    for (; node >= 0; node = rig_.nodes[size_t(node)].parent)
        if (!poses[size_t(node)].visible.value_or(true)) return true;
    return false;
}

bool Animations::is_moved(int node) const {
    for (; node >= 0; node = rig_.nodes[size_t(node)].parent)
        if (moved_[size_t(node)]) return true;
    return false;
}

template <class Value>
std::map<std::string, Value> Animations::placed(const std::vector<AnimatedItem<Value>>& items,
                                                AnimatedProperty property, size_t index,
                                                const Moment& moment) const {
    const std::vector<Pose> poses = pose(rig_.animations[index], moment);
    const std::vector<Eigen::Affine3d> T_world_nodes = world_poses(poses);
    const auto parameters = parameters_at(items, property, rig_.animations[index], moment);
    const auto changes = [&](size_t item) {
        return std::ranges::any_of(rig_.animations, [&](const Animation& animation) {
            return std::ranges::any_of(animation.channels, [&](const AnimationChannel& channel) {
                return channel.property == property && channel.node == int(item);
            });
        });
    };
    std::map<std::string, Value> out;
    for (size_t i = 0; i < items.size(); ++i)
        for (const auto& [name, node] : items[i].users) {
            if (!is_moved(node) && !changes(i)) continue;
            Value value = items[i].value(parameters[i], T_world_nodes[size_t(node)]);
            if constexpr (std::is_same_v<Value, Light>)
                if (is_hidden(node, poses)) value.intensity = 0;
            out.emplace(name, std::move(value));
        }
    return out;
}

std::map<std::string, Light> Animations::lights(size_t index, double time_s, bool loop) const {
    return placed(rig_.lights, AnimatedProperty::light, index, moment(index, time_s, loop));
}

std::map<std::string, Camera> Animations::cameras(size_t index, double time_s, bool loop) const {
    return placed(rig_.cameras, AnimatedProperty::camera, index, moment(index, time_s, loop));
}

std::map<std::string, Camera> Animations::cameras_before(size_t index, double from_s, double to_s,
                                                         bool loop) const {
    return placed(rig_.cameras, AnimatedProperty::camera, index, moment_before(index, from_s, to_s, loop));
}

Eigen::Affine3d Animations::pose_of_skin(int skin, const std::vector<Eigen::Affine3d>& T_world_nodes) const {
    const std::vector<int>& joints = rig_.skins[size_t(skin)].joints;
    const std::vector<Eigen::Affine3d>& T_joint_at_rest = rig_.skins[size_t(skin)].T_joint_at_rest;
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    if (const int node = skin_nodes_[size_t(skin)]; node >= 0) {
        pose.linear() = without_stretch(T_world_nodes[size_t(node)].linear());
        pose.translation() = T_world_nodes[size_t(node)].translation();
    }
    // The sign of a pose's determinant tells which side of a face is outside. It must be that of what joints
    // do to the vertices.
    size_t mirroring = 0;
    for (size_t k = 0; k < joints.size(); ++k) {
        const Eigen::Affine3d T = T_world_nodes[size_t(joints[k])] * T_joint_at_rest[k];
        if (T.linear().determinant() < 0) ++mirroring;
    }
    const bool is_mirrored = 2 * mirroring > joints.size();
    if ((pose.linear().determinant() < 0) != is_mirrored) pose.linear() *= -1;
    return pose;
}

Animations::Places Animations::places(const std::vector<Pose>& poses) const {
    const size_t count = rig_.nodes.size();
    const Eigen::Affine3d identity = Eigen::Affine3d::Identity();
    Places out{world_poses(poses), std::vector<Eigen::Affine3d>(count), std::vector<Eigen::Affine3d>(count)};
    std::vector<Eigen::Affine3d> T_mesh_nodes(count, identity);
    for (const size_t i : order_) {
        const AnimationNode& node = rig_.nodes[i];
        const bool has_parent = node.parent >= 0;
        const Eigen::Affine3d& T_world_parent =
            has_parent ? out.T_world_meshes[size_t(node.parent)] : identity;
        const Eigen::Affine3d T_parent_node =
            has_parent ? T_mesh_nodes[size_t(node.parent)] * poses[i].matrix() : poses[i].matrix();
        Eigen::Affine3d& T_parent_mesh = out.T_parent_meshes[i];
        if (!follows_joints(node)) {
            T_parent_mesh = T_parent_node;
        } else {
            // Below what is scaled to nothing it is a point or flat whatever its pose is.
            T_parent_mesh = is_flat(T_world_parent)
                                ? identity
                                : T_world_parent.inverse() * pose_of_skin(node.skin, out.T_world_nodes);
            // What hangs from it goes with the node.
            T_mesh_nodes[i] = T_parent_mesh.inverse() * T_parent_node;
        }
        // Products of a file's scales may overflow: such a mesh has no pose, and Mesh refuses it.
        if (!T_parent_mesh.matrix().allFinite()) T_parent_mesh.setIdentity();
        out.T_world_meshes[i] = T_world_parent * T_parent_mesh;
    }
    return out;
}

bool Animations::is_placed_by_joints(size_t node) const {
    const int parent = rig_.nodes[node].parent;
    return follows_joints(rig_.nodes[node]) || (parent >= 0 && follows_joints(rig_.nodes[size_t(parent)]));
}

void Animations::apply(size_t index, double time_s, bool loop) {
    const Moment now = moment(index, time_s, loop);
    const std::vector<Pose> poses = pose(rig_.animations[index], now);
    const Places at = places(poses);
    for (const size_t i : order_) {
        AnimationNode& node = rig_.nodes[i];
        if (!node.mesh) continue;
        node.mesh->set_T_parent_mesh(at.T_parent_meshes[i]);
        if (poses[i].visible) show(*node.mesh, *poses[i].visible);
    }
    put_materials(rig_.animations[index], now);
    for (const size_t i : order_)
        if (rig_.nodes[i].mesh && !rig_.nodes[i].deformation.empty())
            deform(rig_.nodes[i], at.T_world_meshes[i], poses[i].weights, at.T_world_nodes);
}

void Animations::put_at_rest() {
    const std::vector<Pose> poses = pose_at_rest();
    const Places at = places(poses);
    for (const size_t i : order_) {
        AnimationNode& node = rig_.nodes[i];
        if (!node.mesh) continue;
        if (is_placed_by_joints(i)) node.mesh->set_T_parent_mesh(at.T_parent_meshes[i]);
        const bool morphs = !node.deformation.targets_V.empty() &&
                            std::ranges::any_of(node.weights, [](float weight) { return weight != 0; });
        if (follows_joints(node) || morphs)
            deform(node, at.T_world_meshes[i], poses[i].weights, at.T_world_nodes);
    }
}

void Animations::put_materials(const Animation& animation, const Moment& moment) {
    auto parameters = parameters_at(rig_.materials, AnimatedProperty::material, animation, moment);
    const std::scoped_lock lock(put_materials_->mutex);
    for (size_t i = 0; i < parameters.size(); ++i) {
        std::vector<double>& put = put_materials_->parameters[i];
        if (parameters[i] == put) continue;
        const Material material = rig_.materials[i].material(parameters[i]);
        for (auto& [mesh, place] : rig_.materials[i].users)
            mesh.edit([&, slot = place](MeshData& data) {
                if (slot < data.materials.size()) data.materials[slot] = material;
            });
        put = std::move(parameters[i]);
    }
}

void Animations::deform(AnimationNode& node, const Eigen::Affine3d& T_world_mesh,
                        const std::vector<float>& weights,
                        const std::vector<Eigen::Affine3d>& T_world_nodes) {
    std::vector<Eigen::Affine3d> T_mesh_joints;
    if (follows_joints(node)) {
        // The joints say where the vertices are in the world; the mesh is drawn with the skin's pose. Below
        // what is scaled to nothing it is a point or flat whatever its vertices are.
        if (is_flat(T_world_mesh)) return;
        const Skin& skin = rig_.skins[size_t(node.skin)];
        const Eigen::Affine3d T_mesh_world = T_world_mesh.inverse();
        for (size_t k = 0; k < skin.joints.size(); ++k)
            T_mesh_joints.push_back(T_mesh_world * T_world_nodes[size_t(skin.joints[k])] *
                                    skin.T_joint_at_rest[k]);
    }
    const Deformed out = deformed(node.deformation, weights, T_mesh_joints);
    node.mesh->edit([&](MeshData& data) {
        data.V = out.V;
        data.rest_shape = {node.deformation.V, data.F.revision()};
        if (out.N.rows()) data.N = out.N;
        if (out.uv_tangents.rows()) data.uv_tangents = out.uv_tangents;
    });
}

}  // namespace easypbr
