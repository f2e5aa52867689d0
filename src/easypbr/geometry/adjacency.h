// Which positions of a mesh are joined by its edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/geometry/weld.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::geometry {

/// Neighbours of each position along the borders of faces. Vertices at the same place are one position, so
/// that seams of texture coordinates and hard edges are no borders.
class Adjacency {
  public:
    explicit Adjacency(const MeshData& mesh);

    const Weld& weld() const { return weld_; }
    size_t count() const { return weld_.count(); }
    /// Neighbours of a position, rising, each once.
    std::span<const int32_t> of(int32_t position) const {
        const auto i = size_t(position);
        return {neighbors_.data() + begin_[i], degree_[i]};
    }
    /// Whether an edge at the position belongs to one face only.
    bool is_border(int32_t position) const { return is_border_[size_t(position)] != 0; }
    /// Whether the edge between two neighbours belongs to one face only.
    bool is_border_edge(int32_t a, int32_t b) const;

  private:
    Weld weld_;
    std::vector<size_t> begin_, degree_;
    std::vector<int32_t> neighbors_;
    std::vector<char> faces_of_edge_;  ///< 1, 2, or 3 for more; beside neighbors_
    std::vector<char> is_border_;
};

}  // namespace easypbr::geometry
