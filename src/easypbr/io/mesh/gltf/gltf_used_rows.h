// Which rows of accessors the primitives of a glTF mesh use: several meshes may share one accessor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"

namespace easypbr::io {

/// Accessors of positions that meshes index by different accessors: each of these meshes has a part of them.
/// Of other accessors a mesh has all rows, those that no primitive indexes too. What is malformed is left
/// out.
std::set<size_t> gltf_shared_positions(const GltfDocument& document);

class GltfUsedRows {
  public:
    /// Of `count` rows those that the lists of indices name; a list that is null uses all. Every index must
    /// be below `count`. Takes time by the number of indices, whatever `count` is.
    GltfUsedRows(size_t count, std::span<const std::vector<uint32_t>* const> lists);

    /// The rows in use, ascending; null where all are.
    const std::vector<int32_t>* rows() const { return uses_all_ ? nullptr : &rows_; }

    /// Makes indices of the rows indices of those in use.
    void renumber(std::vector<uint32_t>& indices) const;

  private:
    void list_named(std::span<const std::vector<uint32_t>* const> lists, size_t index_count);
    void mark_named(size_t count, std::span<const std::vector<uint32_t>* const> lists);

    bool uses_all_ = false;
    std::vector<int32_t> rows_;
    std::vector<uint32_t> places_;  ///< of each row among those in use; empty: to be searched for
};

}  // namespace easypbr::io
