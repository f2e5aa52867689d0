// Vertices split where their corners differ.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// One vertex per different pair of vertex and key.
struct CornerSplit {
    std::vector<int32_t> source_vertex;  ///< ascending
    std::vector<uint64_t> key;           ///< `no_key` for a vertex that no corner uses
};
inline constexpr uint64_t no_key = ~uint64_t(0);

/// Makes one vertex of each different (vertex, key) of the corners and lets `corner_vertices` point to them.
/// The new vertices are in the order of their source, then of their key.
CornerSplit split_corners(std::span<int32_t> corner_vertices, std::span<const uint64_t> keys,
                          size_t vertex_count);

/// Repeats the rows of all arrays of the vertices by the sources of the new vertices, and sets source_vertex,
/// which goes on from the one that there is.
void gather_vertices(const CornerSplit& split, MeshData& mesh);

/// Lets indices point to the first vertex that each file's vertex became.
void follow_split(const CornerSplit& split, std::span<int32_t> indices);

}  // namespace easypbr
