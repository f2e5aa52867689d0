// The line segments that an object is drawn with: its edges, its wireframe, its normals.
#pragma once

#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include "easypbr/gpu/packing.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::gpu {

enum class LineKind { edges, wireframe, normals };

/// Where a table of values has its colours, from the top, and the colour of what is no number.
inline constexpr float row_of_values = 0.25f, row_of_nothing = 0.75f;

/// One instance of shaders/overlay_lines.vert.
struct Segment {
    float a[3];
    Rgba8 color_a{255, 255, 255, 255};  ///< sRGB-encoded
    float b[3];
    Rgba8 color_b{255, 255, 255, 255};
    float places[2] = {};       ///< of the ends' values in their table
    float row = row_of_values;  ///< of the table
};

/// The rows of E with the colours of C, white without C, and with the first coordinates of UV as places of
/// values. A segment with an end that has no value (NaN) has none.
std::vector<Segment> edge_segments(const MeshData& mesh);

/// A step along a chain of edges.
struct ChainStep {
    uint32_t segment = 0;   ///< row of E
    bool reversed = false;  ///< from its second vertex to its first
    bool first = false;     ///< of its chain
};

/// All rows of E as chains from end to end. They begin where one edge or more than two meet, at the first
/// such vertex, and go on up to the next one; rings begin with their first row.
std::vector<ChainStep> edge_chains(const MeshData& mesh);

/// Each edge between two faces once, likewise, in the colours of the first face. Vertices at one place that
/// were split from one (source_vertex) count as one. Edges inside of a polygon of the file (source_face) are
/// left out.
std::vector<Segment> wireframe_segments(const MeshData& mesh);

/// How lines along normals stand in a pose, whose rotation and place do not matter.
struct NormalLines {
    std::optional<float> length;  ///< world units; nothing: 2 % of the diagonal of V's box, in the pose
    /// L^T L of the linear part L of the pose, row by row: its products with differences of places are those
    /// of the world.
    std::array<float, 9> metric = {1, 0, 0, 0, 1, 0, 0, 0, 1};

    bool operator==(const NormalLines&) const = default;
    bool operator<(const NormalLines& other) const {
        return std::tie(length, metric) < std::tie(other.length, other.metric);
    }
};

/// The same for all poses of one scale.
NormalLines normal_lines(std::optional<float> length, const Mat3d& pose);

/// From each vertex along the normal of the surface in its pose, computed where the mesh has none; white.
/// In a pose without an inverse they are as in none.
std::vector<Segment> normal_segments(const MeshData& mesh, const NormalLines& lines);

}  // namespace easypbr::gpu
