// Meshes moved, and several made into one.
#pragma once

#include <span>

#include "easypbr/scene/mesh_data.h"

namespace easypbr {

/// The mesh's own arrays after x -> T x, x being local positions; offset, pose and children stay. Normals go
/// by the inverse transpose, a mirroring T turns the winding of the faces, and T and B become the axes
/// of the ellipses that T makes of theirs (radii included). A T that flattens (determinant 0) is allowed;
/// what has no direction left gets (0, 0, 1). The cubes of voxels keep their volume's factor, but cannot
/// turn.
MeshData transformed(const MeshData& mesh, const Eigen::Affine3d& T);

/// The mesh's positions relative to another offset than its own.
Array3f positions_from(const MeshData& mesh, const Vec3d& offset);

/// All vertices, faces and edges in the order of the meshes, which count in one common frame: poses and
/// children are not looked at, offsets are. Name, file, style, pose and offset are those of the first.
/// Parts are kept, one for each mesh that has none, and materials, equal ones once. What only some of the
/// meshes have is filled in for the others: normals as they are drawn (add_drawn_normals()), zero where there
/// are no faces (no normal); white; uv 0; intensity 0; label -1; scalar NaN. Vertices that sharp edges repeat
/// come last, after those of all meshes. Tangents with lengths and voxel sizes are kept
/// only when all meshes have them (the same), for an ellipse without axes would vanish. Labels or scalars of
/// the same name that belong to faces here and to vertices there cannot be one array: those of the later mesh
/// are left out with a warning, and so are other label maps than the first one. Throws ArgumentError when
/// vertices or faces are too many for 32-bit indices.
MeshData merged(std::span<const MeshData> meshes);

/// The offset of the first node that has vertices: what the tree's other offsets are relative to.
Vec3d offset_of_tree(const Mesh& mesh);

/// The mesh and its descendants merged in the frame of the mesh's parent, without pose and children. The
/// offset is offset_of_tree(), and more where poses move vertices so far that float32 would lose what matters
/// (scene/offset.h). A single node with an identity pose keeps its arrays.
MeshData flatten(const Mesh& mesh);
/// The same for several trees in one frame, merged.
MeshData flatten(std::span<const Mesh> meshes);

/// The positions, faces and edges of flatten(), for what needs no other arrays: no vertex is repeated.
MeshData flatten_shape(const Mesh& mesh);

}  // namespace easypbr
