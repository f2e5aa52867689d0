// Meshes of more faces, smoother ones, and of fewer faces that look like the original.
#pragma once

#include <optional>

#include "easypbr/scene/mesh.h"

namespace easypbr {

enum class Subdivision {
    midpoint,  ///< new vertices in the middle of the edges: the surface stays where it is
    loop,      ///< Loop 1987: the surface becomes smooth; borders become smooth curves
};

/// Every face cut in four, `iterations` times (0 to 12). What vertices have becomes the mean of both ends of
/// an edge at the new ones (of labels the first end's), what faces have is handed down, parts stay. Vertices
/// at the same place move together, so that seams of texture coordinates stay closed; with Loop's rules hard
/// edges are rounded, and normals are computed anew where there were some. Edges (E) stay. Throws
/// ArgumentError when there are no faces or iterations are out of range, or the faces would be too many for
/// 32-bit indices.
Mesh upsample(const Mesh& mesh, int iterations = 1, Subdivision subdivision = Subdivision::midpoint);

enum class Smoothing {
    taubin,     ///< Taubin 1995: steps of 0.5 and -0.53 in turn, which keep the size
    laplacian,  ///< steps of 0.5 towards the mean of the neighbours, which shrink
};

/// Vertices moved towards the mean of their neighbours, `iterations` times (0 to 100000), a Taubin iteration
/// being both steps. Vertices at the same place move together; those of borders stay. Normals are computed
/// anew where there were some. Throws ArgumentError when there are no faces or iterations are out of range.
Mesh smooth(const Mesh& mesh, int iterations = 10, Smoothing smoothing = Smoothing::taubin);

/// When to stop; at least one must be given.
struct DecimateOptions {
    std::optional<int> faces;     ///< as soon as there are no more faces than this
    std::optional<double> error;  ///< before the surface would move by more than this, in the mesh's unit
};

/// Collapses edges in the order of their quadric error (Garland and Heckbert 1997, by meshoptimizer). The
/// vertices that are left keep their place and all that they have; borders and seams of texture coordinates
/// stay closed. Parts are simplified each by itself, with borders that do not move, so that no crack opens
/// between them. It may stop early where the shape allows no more. Edges, and labels and scalars of faces,
/// are left out, the latter with a warning. A mesh whose faces do not share vertices cannot be simplified:
/// weld it with remove_duplicate_vertices() first. Throws ArgumentError when there are no faces, nothing is
/// given, faces < 0 or error is not >= 0.
Mesh decimate(const Mesh& mesh, const DecimateOptions& options);

}  // namespace easypbr
