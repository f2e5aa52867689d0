#include "easypbr/io/mesh/gltf/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "easypbr/core/log.h"
#include "easypbr/io/mesh/gltf/gltf_accessor.h"
#include "easypbr/io/mesh/gltf/gltf_placed.h"

namespace easypbr::io {
namespace {

/// What the sampler of a channel holds.
struct Sampler {
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;
    size_t output = 0;
};

/// Morph targets of a node's mesh.
int target_count(const GltfDocument& document, size_t node) {
    const auto mesh = document.optional_integer(document.item("nodes", node), "mesh");
    const Json* primitives = mesh ? member(document.item("meshes", *mesh), "primitives") : nullptr;
    size_t count = 0;
    if (primitives && primitives->is_array())
        for (const Json& primitive : *primitives)
            if (const Json* targets = member(primitive, "targets"); targets && targets->is_array())
                count = std::max(count, targets->size());
    return int(count);
}

class AnimationReader {
  public:
    AnimationReader(GltfDocument& document, GltfMaterialPointers& pointers, const Json& json, size_t index)
        : document_(document),
          pointers_(pointers),
          json_(json),
          name_(fmt::format("animations[{}]", index)) {}

    Animation read() {
        Animation animation;
        animation.name = document_.text(json_, "name", name_);
        const Json* channels = member(json_, "channels");
        if (!channels || !channels->is_array()) fail("has no channels");
        for (const Json& channel : *channels)
            if (auto read = read_channel(channel)) {
                animation.duration_s = std::max(animation.duration_s, double(read->times.back()));
                animation.channels.push_back(std::move(*read));
            }
        return animation;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { document_.fail(name_ + " " + what); }

    std::optional<AnimationChannel> read_channel(const Json& json) {
        const Json* target = member(json, "target");
        if (!target) fail("has a channel without a target");
        auto node = document_.optional_integer(*target, "node");
        std::string path = document_.text(*target, "path");
        if (path == "pointer") {
            const std::string pointer = pointer_of(*target);
            if (const auto material = pointers_.find(pointer)) return read_material(json, *material);
            if (const auto placed = find_gltf_placed(document_, pointer)) return read_placed(json, *placed);
            std::tie(node, path) = pointed_at(pointer);
            if (node && path == fmt::format("extensions/{}/visible", khr_node_visibility))
                return read_visibility(json, *node);
        }
        constexpr const char* properties[] = {"translation", "rotation", "scale", "weights"};
        const auto known = std::ranges::find(properties, path);
        if (known == std::end(properties))
            log_warning(fmt::format("{}: {} animates '{}', which cannot be animated; it is left out",
                                    document_.path().string(), name_, path));
        if (!node || known == std::end(properties)) return {};
        document_.item("nodes", *node);
        const auto property = AnimatedProperty(known - std::begin(properties));
        if (property == AnimatedProperty::weights) return read_weights(json, *node);
        return read_keys(json, int(*node), property, property == AnimatedProperty::rotation ? 4 : 3);
    }

    AnimationChannel read_material(const Json& json, const GltfMaterialTarget& target) {
        AnimationChannel channel = read_keys(json, target.material, AnimatedProperty::material, target.width);
        channel.parameter = target.parameter;
        return channel;
    }

    AnimationChannel read_placed(const Json& json, const GltfPlacedTarget& target) {
        AnimationChannel channel = read_keys(json, target.item, target.property, target.width);
        channel.parameter = target.parameter;
        return channel;
    }

    /// Truth values have nothing between them.
    AnimationChannel read_visibility(const Json& json, size_t node) {
        document_.item("nodes", node);
        AnimationChannel channel = read_keys(json, int(node), AnimatedProperty::visibility, 1);
        if (channel.interpolation != Interpolation::step)
            fail(fmt::format("animates the visibility of nodes[{}] by a sampler that is not STEP", node));
        return channel;
    }

    std::optional<AnimationChannel> read_weights(const Json& json, size_t node) {
        if (const int targets = target_count(document_, node))
            return read_keys(json, int(node), AnimatedProperty::weights, targets);
        log_warning(
            fmt::format("{}: {} animates the weights of nodes[{}], which has no morph targets; they "
                        "are left out",
                        document_.path().string(), name_, node));
        return {};
    }

    /// Keys with rows of `columns` values.
    AnimationChannel read_keys(const Json& json, int target, AnimatedProperty property, int columns) {
        AnimationChannel channel;
        channel.node = target;
        channel.property = property;
        Sampler sampler = read_sampler(document_.integer(json, "sampler"));
        channel.interpolation = sampler.interpolation;
        channel.times = std::move(sampler.times);
        channel.values = read_values(channel, sampler.output, columns);
        return channel;
    }

    std::string pointer_of(const Json& target) const {
        const Json* given = extension(target, khr_animation_pointer);
        if (!given) fail("has a channel of path 'pointer' without a pointer");
        return document_.text(*given, "pointer");
    }

    /// A property of a node; what is none is returned as a whole.
    static std::pair<std::optional<size_t>, std::string> pointed_at(const std::string& pointer) {
        constexpr std::string_view nodes = "/nodes/";
        const size_t end = pointer.find('/', nodes.size());
        if (!pointer.starts_with(nodes) || end == pointer.npos) return {std::nullopt, pointer};
        size_t node = 0;
        const auto read = std::from_chars(pointer.data() + nodes.size(), pointer.data() + end, node);
        if (read.ec != std::errc() || read.ptr != pointer.data() + end) return {std::nullopt, pointer};
        const std::string property = pointer.substr(end + 1);
        const bool known = property.find('/') == property.npos || property.starts_with("extensions/");
        return {node, known ? property : pointer};
    }

    Sampler read_sampler(size_t index) {
        const Json* samplers = member(json_, "samplers");
        if (!samplers || !samplers->is_array() || index >= samplers->size())
            fail(fmt::format("has no sampler {}", index));
        const Json& json = (*samplers)[index];
        Sampler sampler;
        const std::string kind = document_.text(json, "interpolation", "LINEAR");
        constexpr const char* kinds[] = {"LINEAR", "STEP", "CUBICSPLINE"};
        const auto known = std::ranges::find(kinds, kind);
        if (known == std::end(kinds)) fail(fmt::format("has a sampler of unknown interpolation '{}'", kind));
        sampler.interpolation = Interpolation(known - std::begin(kinds));
        const ArrayXf::Dense times = read_floats(document_, document_.integer(json, "input"), 1, 1);
        sampler.times.assign(times.data(), times.data() + times.size());
        const bool rising = std::adjacent_find(sampler.times.begin(), sampler.times.end(),
                                               std::greater_equal<>()) == sampler.times.end();
        if (sampler.times.empty() || !times.allFinite() || !rising)
            fail(fmt::format("has a sampler whose times are none, not finite or do not rise (sampler {})",
                             index));
        sampler.output = document_.integer(json, "output");
        return sampler;
    }

    /// One row for each key, or three. The file has weights one by one.
    ArrayXf::Dense read_values(const AnimationChannel& channel, size_t accessor, int columns) {
        const int width = channel.property == AnimatedProperty::weights ? 1 : columns;
        const ArrayXf::Dense values = read_floats(document_, accessor, width, width);
        const auto keys = Eigen::Index(channel.times.size()) *
                          (channel.interpolation == Interpolation::cubic_spline ? 3 : 1);
        if (values.size() != keys * columns || !values.allFinite())
            fail(fmt::format("has {} keys{}, but accessors[{}] has {} values, or some that are not finite",
                             keys, width == columns ? "" : fmt::format(" of {} weights", columns), accessor,
                             values.rows()));
        return Eigen::Map<const ArrayXf::Dense>(values.data(), keys, columns);
    }

    GltfDocument& document_;
    GltfMaterialPointers& pointers_;
    const Json& json_;
    std::string name_;
};

Skin read_skin(GltfDocument& document, size_t index) {
    const Json& json = document.item("skins", index);
    Skin skin;
    for (const size_t joint : document.integers(json, "joints")) {
        document.item("nodes", joint);
        skin.joints.push_back(int(joint));
    }
    skin.T_joint_at_rest.assign(skin.joints.size(), Eigen::Affine3d::Identity());
    const auto accessor = document.optional_integer(json, "inverseBindMatrices");
    if (!accessor) return skin;
    const ArrayXf::Dense rows = read_floats(document, *accessor, 16, 16);
    if (rows.rows() < Eigen::Index(skin.joints.size()) || !rows.allFinite())
        document.fail(fmt::format(
            "skins[{}] has {} joints, but accessors[{}] has {} matrices, or some that are not finite", index,
            skin.joints.size(), *accessor, rows.rows()));
    for (size_t i = 0; i < skin.joints.size(); ++i) {
        // Column by column.
        const Eigen::Map<const Eigen::Matrix4f> matrix(rows.data() + 16 * i);
        skin.T_joint_at_rest[i].matrix() = matrix.cast<double>();
        skin.T_joint_at_rest[i].makeAffine();
    }
    return skin;
}

/// Nodes whose visibility an animation changes have one at rest.
void set_visibility_at_rest(const GltfDocument& document, AnimationRig& rig) {
    for (const Animation& animation : rig.animations)
        for (const AnimationChannel& channel : animation.channels) {
            if (channel.property != AnimatedProperty::visibility) continue;
            const Json* given = extension(document.item("nodes", size_t(channel.node)), khr_node_visibility);
            rig.nodes[size_t(channel.node)].visible = !given || document.boolean(*given, "visible", true);
        }
}

/// Whether nodes may have other vertices at rest than their meshes: by skins or weights of morph targets.
bool deforms_at_rest(const GltfDocument& document) {
    if (document.count("skins") > 0) return true;
    // What no node uses may be malformed.
    const auto has_weights = [](const Json& item) { return item.is_object() && member(item, "weights"); };
    for (const char* array : {"meshes", "nodes"})
        if (document.count(array) > 0 && std::ranges::any_of(document.root().at(array), has_weights))
            return true;
    return false;
}

}  // namespace

AnimationNode read_gltf_pose(const GltfDocument& document, size_t index) {
    const Json& json = document.item("nodes", index);
    AnimationNode node;
    if (const auto m = document.numbers(json, "matrix", 16)) {
        node.matrix = Eigen::Affine3d(Mat4d(Eigen::Map<const Mat4d>(m->data())));
        if (node.matrix->matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
            document.fail(fmt::format("nodes[{}].matrix is not affine: its last row must be 0 0 0 1", index));
        return node;
    }
    if (const auto t = document.numbers(json, "translation", 3)) node.translation = Vec3d(t->data());
    if (const auto s = document.numbers(json, "scale", 3)) node.scale = Vec3d(s->data());
    if (const auto r = document.numbers(json, "rotation", 4)) {
        const Eigen::Quaterniond rotation(Eigen::Vector4d(r->data()));
        if (rotation.norm() > 0) node.rotation = rotation.normalized();
    }
    return node;
}

AnimationRig read_gltf_rig(GltfDocument& document, GltfMaterialPointers& pointers) {
    AnimationRig rig;
    const size_t animations = document.count("animations");
    if (animations == 0 && !deforms_at_rest(document)) return rig;
    for (size_t i = 0; i < document.count("nodes"); ++i) {
        rig.nodes.push_back(read_gltf_pose(document, i));
        if (const auto skin = document.optional_integer(document.item("nodes", i), "skin")) {
            document.item("skins", *skin);
            rig.nodes.back().skin = int(*skin);
        }
    }
    for (size_t i = 0; i < rig.nodes.size(); ++i)
        for (const size_t child : document.integers(document.item("nodes", i), "children"))
            if (child < rig.nodes.size()) rig.nodes[child].parent = int(i);
    for (size_t i = 0; i < document.count("skins"); ++i) rig.skins.push_back(read_skin(document, i));
    if (animations == 0) return rig;
    for (size_t i = 0; i < animations; ++i)
        rig.animations.push_back(
            AnimationReader(document, pointers, document.item("animations", i), i).read());
    set_visibility_at_rest(document, rig);
    rig.materials = pointers.materials();
    rig.lights = read_gltf_lights(document);
    rig.cameras = read_gltf_cameras(document);
    return rig;
}

}  // namespace easypbr::io
