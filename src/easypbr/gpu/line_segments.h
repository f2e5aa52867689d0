// The line segments that an object is drawn with: its edges, its wireframe, its normals.
#pragma once

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

/// Each edge between two faces once, likewise, in the colours of the first face. Vertices at one place that
/// were split from one (source_vertex) count as one. Edges inside of a polygon of the file (source_face) are
/// left out.
std::vector<Segment> wireframe_segments(const MeshData& mesh);

/// From each vertex along its normal, computed where the mesh has none; white.
std::vector<Segment> normal_segments(const MeshData& mesh, float length);

}  // namespace easypbr::gpu
