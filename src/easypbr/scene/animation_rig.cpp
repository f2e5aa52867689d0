#include "easypbr/scene/animation_rig.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/scene/animation_keys.h"
#include "easypbr/scene/deformation.h"

namespace easypbr {
namespace {

/// `place` begins the message.
void check_index(const char* what, int index, size_t count, bool may_lack,
                 const char* place = "animation rig: ") {
    if ((index < 0 && !(may_lack && index == -1)) || index >= int(count))
        throw ArgumentError(fmt::format("{}{} {} does not exist, there are {}", place, what, index, count));
}

/// check_index() of a channel, whose place check_animation() adds.
void check_target(const char* what, int index, size_t count) {
    check_index(what, index, count, false, "");
}

/// A channel of what has parameters: materials, lights, cameras.
template <class Item>
void check_parameters(const AnimationChannel& channel, const char* what, const std::vector<Item>& items) {
    check_target(what, channel.node, items.size());
    const size_t count = items[size_t(channel.node)].parameters.size();
    check_target("parameter", channel.parameter, count);
    check_target("parameter", channel.parameter + int(channel.values.cols()) - 1, count);
}

void check_channel(const AnimationChannel& channel, const AnimationRig& rig) {
    require_keys(channel);
    switch (channel.property) {
        case AnimatedProperty::material:
            return check_parameters(channel, "material", rig.materials);
        case AnimatedProperty::light:
            return check_parameters(channel, "light", rig.lights);
        case AnimatedProperty::camera:
            return check_parameters(channel, "camera", rig.cameras);
        default:
            return check_target("node", channel.node, rig.nodes.size());
    }
}

void check_animation(const Animation& animation, const AnimationRig& rig) {
    if (!(animation.duration_s >= 0) || !std::isfinite(animation.duration_s))
        throw ArgumentError(
            fmt::format("animation rig: animation '{}': expected a finite duration of at least 0, got {}",
                        animation.name, animation.duration_s));
    for (size_t i = 0; i < animation.channels.size(); ++i) {
        try {
            check_channel(animation.channels[i], rig);
        } catch (const ArgumentError& error) {
            throw ArgumentError(fmt::format("animation rig: animation '{}', channel {}: {}", animation.name,
                                            i, error.what()));
        }
    }
}

void check_skin(const Skin& skin, size_t nodes) {
    for (const int joint : skin.joints) check_index("joint", joint, nodes, false);
    if (skin.T_joint_at_rest.size() != skin.joints.size())
        throw ArgumentError(
            fmt::format("animation rig: expected a pose at rest for each of {} joints of a skin, got {}",
                        skin.joints.size(), skin.T_joint_at_rest.size()));
}

/// Lights or cameras.
template <class Item>
void check_items(const char* what, const std::vector<Item>& items, size_t nodes) {
    for (size_t i = 0; i < items.size(); ++i) {
        if (!items[i].value)
            throw ArgumentError(
                fmt::format("animation rig: {} {}: expected a function of its values, got none", what, i));
        for (const auto& [name, node] : items[i].users) check_index("node", node, nodes, false);
    }
}

void check_materials(const std::vector<AnimatedMaterial>& materials) {
    for (size_t i = 0; i < materials.size(); ++i)
        if (!materials[i].material)
            throw ArgumentError(
                fmt::format("animation rig: material {}: expected a function of its values, got none", i));
}

}  // namespace

void check_rig(const AnimationRig& rig) {
    const size_t count = rig.nodes.size();
    for (const AnimationNode& node : rig.nodes) {
        check_index("node", node.parent, count, true);
        check_index("skin", node.skin, rig.skins.size(), true);
    }
    for (const AnimationNode& node : rig.nodes)
        check_deformation(node.deformation, node.skin < 0 ? 0 : rig.skins[size_t(node.skin)].joints.size(),
                          node.skin >= 0);
    for (const Skin& skin : rig.skins) check_skin(skin, count);
    check_materials(rig.materials);
    check_items("light", rig.lights, count);
    check_items("camera", rig.cameras, count);
    for (const Animation& animation : rig.animations) check_animation(animation, rig);
}

}  // namespace easypbr
