#include "easypbr/geometry/place.h"

#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/scene/merge.h"
#include "easypbr/scene/offset.h"

namespace easypbr {
namespace {

/// The mesh's arrays after T, which moves offset + V. The offset is chosen anew where there is one.
MeshData moved_arrays(const MeshData& mesh, const Eigen::Affine3d& T) {
    if (mesh.offset.isZero(0)) return transformed(mesh, T);
    MeshData data = transformed(mesh, Eigen::Affine3d(T.linear()));
    const LocalPositions positions =
        local_positions(data.V.cast<double>().rowwise() + (T * mesh.offset).transpose());
    data.V = positions.V;
    data.offset = positions.offset;
    return data;
}

/// The mesh after T in its own frame, children moved along. Poses act on what is relative to the offset of
/// the tree, which may become another one.
Mesh moved(const Mesh& mesh, const Eigen::Affine3d& T) {
    MeshData data = moved_arrays(*mesh.snapshot(), T);
    const Vec3d before = offset_of_tree(mesh), after = data.V.empty() ? before : data.offset;
    const Eigen::Affine3d T_local = Eigen::Translation3d(-after) * T * Eigen::Translation3d(before);
    for (Mesh& child : data.children) {
        child = child.clone();
        child.set_T_parent_mesh(T_local * child.T_parent_mesh() * Eigen::Translation3d(after - before));
    }
    return Mesh(std::move(data));
}

Box3d box_in_own_frame(const Mesh& mesh) {
    return bounding_box(mesh, Eigen::Affine3d::Identity());
}

}  // namespace

Mesh transformed(const Mesh& mesh, const Eigen::Affine3d& T) {
    if (!T.matrix().allFinite()) throw ArgumentError("transform: expected finite numbers");
    if (T.linear().determinant() == 0)
        throw ArgumentError("transform: expected a matrix that can be inverted, got one of determinant 0");
    return moved(mesh, T);
}

Mesh merged(std::span<const Mesh> meshes) {
    if (meshes.empty()) throw ArgumentError("merge: expected at least one mesh, got none");
    return Mesh(flatten(meshes));
}

Box3d bounding_box(const Mesh& mesh, const Eigen::Affine3d& T_world_mesh) {
    Mesh placed = mesh.clone();
    placed.set_T_parent_mesh(T_world_mesh);
    const MeshData flat = flatten_shape(placed);
    geometry::require_vertices("bounding box", flat);
    return {flat.V.colwise().minCoeff().transpose().cast<double>() + flat.offset,
            flat.V.colwise().maxCoeff().transpose().cast<double>() + flat.offset};
}

Box3d bounding_box(const Mesh& mesh) {
    return bounding_box(mesh, mesh.T_parent_mesh());
}

Mesh centered(const Mesh& mesh) {
    return moved(mesh, Eigen::Affine3d(Eigen::Translation3d(-box_in_own_frame(mesh).center())));
}

Mesh with_size(const Mesh& mesh, double size) {
    geometry::require_positive("size", size);
    const double longest = box_in_own_frame(mesh).sizes().maxCoeff();
    if (!(longest > 0)) throw ArgumentError("size: expected vertices at different places, got all at one");
    return moved(mesh, Eigen::Affine3d(Eigen::Scaling(size / longest)));
}

}  // namespace easypbr
