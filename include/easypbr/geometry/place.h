// Where a mesh is, and how large: moving, merging, splitting, boxes.
#pragma once

#include <span>
#include <vector>

#include "easypbr/scene/mesh.h"

namespace easypbr {

/// A new mesh whose vertices, offset included, are at T x, with normals, windings and surfels as
/// transformed(MeshData) has them; the descendants follow. Its own pose stays. Throws ArgumentError when T is
/// not finite or cannot be inverted.
Mesh transformed(const Mesh& mesh, const Eigen::Affine3d& T);

/// One mesh of all, descendants included, in the frame that the meshes are placed in: poses are applied. See
/// merged(span of MeshData) for what becomes of attributes, materials and parts. Throws ArgumentError when
/// there are no meshes.
Mesh merged(std::span<const Mesh> meshes);

/// Box of all vertices, descendants included, after T; exact under rotation, since it is the box of the
/// turned vertices and not that of a turned box. T acts on what is relative to the mesh's offset, as poses
/// do; the offset is added after: less Scene::origin() the box is in the scene's frame. Throws ArgumentError
/// when there are no vertices.
Box3d bounding_box(const Mesh& mesh, const Eigen::Affine3d& T_world_mesh);
/// The same after the mesh's own pose.
Box3d bounding_box(const Mesh& mesh);

/// The mesh moved so that the middle of its bounding box is its own origin.
Mesh centered(const Mesh& mesh);
/// The mesh scaled about its own origin so that the longest side of its bounding box is `size`. Throws
/// ArgumentError unless size > 0 and the mesh has some extent.
Mesh with_size(const Mesh& mesh, double size = 1);

/// A box that may stand at any angle.
struct OrientedBox {
    Eigen::Isometry3d T_world_box = Eigen::Isometry3d::Identity();  ///< its centre and axes
    Vec3d size{0, 0, 0};                                            ///< lengths along its axes, falling
};

/// A small box around all vertices after the mesh's pose, its offset added as bounding_box() does. Its axes
/// start as the principal ones of the vertices and as those of the frame; then, along each axis in turn, the
/// rectangle of least area around the vertices' projection (rotating calipers, Toussaint 1983) replaces the
/// other two as long as the volume falls. The least volume itself is not promised. Never larger than
/// bounding_box(). Throws ArgumentError when there are no vertices.
OrientedBox oriented_bounding_box(const Mesh& mesh);

/// For each vertex the number of its piece, from 0 by first vertex. Vertices are connected by faces, by edges
/// and by being at the same place, so that seams and hard edges do not cut; one that nothing uses is a piece
/// of its own.
Array1i vertex_components(const Mesh& mesh);

/// For each face the number of its piece, from 0 by first face.
Array1i face_components(const Mesh& mesh);

/// Each piece as a mesh of its own with all that belongs to it, by first vertex; vertices that no face and
/// edge uses are left out. Throws ArgumentError when there are neither faces nor edges: nothing connects a
/// cloud.
std::vector<Mesh> split(const Mesh& mesh);

}  // namespace easypbr
