// The line segments that an object is drawn with: its edges, its wireframe, its normals.
#pragma once

#include <vector>

#include "easypbr/gpu/packing.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::gpu {

enum class LineKind { edges, wireframe, normals };

/// One instance of shaders/overlay_lines.vert.
struct Segment {
    float a[3];
    Rgba8 color_a;  ///< sRGB-encoded
    float b[3];
    Rgba8 color_b;
};

/// The rows of E with the colours of C; white without C.
std::vector<Segment> edge_segments(const MeshData& mesh);

/// Each edge between two faces once, white. Edges inside of a polygon of the file (source_face) are left out.
std::vector<Segment> wireframe_segments(const MeshData& mesh);

/// From each vertex along its normal, computed where the mesh has none; white.
std::vector<Segment> normal_segments(const MeshData& mesh, float length);

}  // namespace easypbr::gpu
