// What the handles of one mesh share.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "easypbr/scene/mesh.h"

namespace easypbr {

struct Mesh::Shared {
    const uint64_t identity = next_revision();
    mutable std::mutex mutex;
    std::shared_ptr<const MeshData> data;
    std::vector<std::weak_ptr<Shared>> parents;  ///< guarded by the one mutex of all hierarchies
};

}  // namespace easypbr
