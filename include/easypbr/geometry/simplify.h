// Meshes of fewer faces that look like the original.
#pragma once

#include <optional>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// When to stop; at least one must be given.
struct DecimateOptions {
    std::optional<int> faces;     ///< as soon as there are no more faces than this
    std::optional<double> error;  ///< before the surface would move by more than this, in the mesh's unit
};

/// Collapses edges in the order of their quadric error (Garland and Heckbert 1997, by meshoptimizer). The
/// vertices that are left keep their place and all that they have; borders and seams of texture coordinates
/// stay closed. Parts are simplified each by itself, with borders that do not move, so that no crack opens
/// between them. It may stop early where the shape allows no more. Edges, and labels and scalars of faces,
/// are left out. A mesh whose faces do not share vertices cannot be simplified: weld it with
/// remove_duplicate_vertices() first. Throws ArgumentError when there are no faces, nothing is given, faces <
/// 0 or error is not >= 0.
Mesh decimate(const Mesh& mesh, const DecimateOptions& options);

}  // namespace easypbr
