// Points on a surface, and fewer points: a random choice, one for each cell of a grid, or those within a
// shape; fewer 3D Gaussian splats.
#pragma once

#include <cstdint>
#include <limits>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// `count` points on the faces, uniformly by area: the faces' areas laid end to end are cut into `count`
/// equal stretches, and each gets one point at random, so that a face of n stretches gets n points, give or
/// take one. What vertices have is interpolated (normals of length 1; faces' normals where there are none;
/// labels of the nearest corner), labels and scalars of faces are handed on, source_face leads to the face
/// (of the file, or of the mesh when it has no such order). The same seed gives the same points on every
/// machine. Throws ArgumentError when count < 0 or no face has an area.
Mesh sample_surface(const Mesh& mesh, int64_t count, uint64_t seed = 0);

/// `count` vertices, each set of that size as likely as any other, in their order and with all that they
/// have; all of them when there are fewer. Faces and edges are left out. The same seed gives the same
/// vertices on every machine. Throws ArgumentError when count is negative.
Mesh subsample_random(const Mesh& mesh, int64_t count, uint64_t seed = 0);

/// One vertex for each cube of edge `cell_size` (on a grid through the origin of the mesh's frame) that has
/// some: at their mean position, with the mean of their normals (of length 1 again), colours, texture
/// coordinates, intensities and scalars (of those that are not NaN) and their most frequent label (of several
/// the least). Splats count as their cloud_from_splats(). In the order of the cells' first vertices. Faces,
/// edges, tangents and what belongs to faces are left out. Throws ArgumentError unless cell_size > 0 and
/// there are at most 2^21 cells along each axis.
Mesh subsample_voxels(const Mesh& mesh, double cell_size);

/// The same cubes as voxels: V are their centres, and MeshData::voxel_size is their edge, so that they are
/// drawn as cubes. Normals and texture coordinates are left out. Throws as subsample_voxels() does.
Mesh voxelize(const Mesh& mesh, double cell_size);

/// What stays of a cut: what lies inside of the shape, its rim included, or what lies outside.
enum class Keep { inside, outside };

/// The vertices within a box, or a ball, in the mesh's own frame (that of V, plus its offset), with all that
/// they have, and the faces and edges whose vertices all stay. Splats count by their means. Throws
/// ArgumentError for a box with a side below 0, a radius that is not above 0, and when no vertex stays.
Mesh crop_box(const Mesh& mesh, const Box3d& box, Keep keep = Keep::inside);
Mesh crop_sphere(const Mesh& mesh, const Vec3d& center, double radius, Keep keep = Keep::inside);

/// Which splats stay: those within all limits, which are included.
struct SplatLimits {
    double least_opacity = 0;
    /// Of the standard deviation along the longest axis, in the mesh's units.
    double least_size = 0;
    double most_size = std::numeric_limits<double>::infinity();
};

/// The splats within the limits, in their order. Throws ArgumentError when the mesh has no splats, a limit is
/// NaN, or no splat stays.
Mesh prune_splats(const Mesh& mesh, const SplatLimits& limits);

/// At most `count` splats: neighbours along a space-filling curve are merged in pairs, those first whose
/// union covers least that they do not cover themselves and whose colours differ least. The union of two has
/// the mean and covariance of both, weighed by what they cover, the mean of their colours, and an opacity
/// that covers as much as both. Labels, scalars and other values are those of the one that covers more. In
/// the order of the curve; the mesh itself when it has no more. Throws ArgumentError when it has no splats or
/// count < 1.
Mesh decimate_splats(const Mesh& mesh, int64_t count);

/// A cloud of the means, with the colour that all directions see and the opacity as alpha. Throws
/// ArgumentError when the mesh has no splats.
Mesh cloud_from_splats(const Mesh& mesh);

struct SplatMeshOptions {
    /// Cells along the longest side of the box of the splats, 8 to 512.
    int resolution = 128;
    /// The density on the surface, above 0 and below 1. One opaque splat becomes the ellipsoid of
    /// sqrt(-2 ln level) standard deviations: of 1.55 by default.
    double level = 0.3;
};

/// The surface of splats where their density, the sum of opacity exp(-d^T S^-1 d / 2) over all of them
/// (Guedon and Lepetit, "SuGaR", 2024), is the level: outside of it is less. Vertices have the colours that
/// all directions see, weighed by density, and the label of the splat that is densest there, where the mesh
/// has labels. Splats count within three standard deviations, and those thinner than a cell are as thick as
/// half of one. The grid covers the splats but for outliers, whose means lie far from the others. Takes 29
/// bytes a sample. In parallel; does not depend on the number of threads. Throws ArgumentError when the mesh
/// has no splats, an option is out of range, or the density is below the level everywhere,
/// and FormatError when the samples take more than the machine's memory.
Mesh mesh_from_splats(const Mesh& mesh, const SplatMeshOptions& options = {});

}  // namespace easypbr
