// What the handles of one mesh share.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// While one lives, this thread is within a function that edits a mesh. Throws ArgumentError when it is
/// within one of the same mesh already, whose data would never be the newest.
class EditScope {
  public:
    EditScope(uint64_t mesh, const std::string& name);
    ~EditScope();
    EditScope(const EditScope&) = delete;
    EditScope& operator=(const EditScope&) = delete;
};

struct Mesh::Shared {
    const uint64_t identity = next_revision();
    mutable std::mutex mutex;
    std::shared_ptr<const MeshData> data;
    std::vector<std::weak_ptr<Shared>> parents;  ///< guarded by the one mutex of all hierarchies
};

}  // namespace easypbr
