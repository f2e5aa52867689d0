// Which object of one snapshot is which of another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/scene/scene.h"

namespace easypbr {

/// What an object of a scene is recognised by in other snapshots.
struct ObjectKey {
    std::string root;   ///< the name under which its hierarchy is shown
    std::string name;   ///< its own ("car/wheel"), which siblings may share
    uint64_t node = 0;  ///< Mesh::identity()
};

/// Of the objects of a snapshot, in their order.
std::vector<ObjectKey> object_keys(const SceneSnapshot& scene);

/// For each of `objects` its place among those of another snapshot; none where it has no partner there. The
/// same node is the same object, first under the same root. What is left is paired by root and name, in the
/// order of the snapshots: a program may replace meshes from frame to frame. Nothing has two partners.
std::vector<std::optional<size_t>> partners(const std::vector<ObjectKey>& objects,
                                            const std::vector<ObjectKey>& others);

}  // namespace easypbr
