// Which object of one snapshot is which of another.
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "easypbr/scene/scene.h"

namespace easypbr {

/// An object of a scene across its snapshots: the name of what the scene shows, the node's own ("car/wheel"),
/// and its number among those of both names, for siblings may share a name.
struct ObjectKey {
    std::string root, name;
    int number = 0;

    bool operator<(const ObjectKey& other) const {
        return std::tie(root, name, number) < std::tie(other.root, other.name, other.number);
    }
};

/// Of the objects of a snapshot, in their order.
std::vector<ObjectKey> object_keys(const SceneSnapshot& scene);

}  // namespace easypbr
