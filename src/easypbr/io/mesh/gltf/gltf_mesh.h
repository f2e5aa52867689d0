// One mesh of a glTF file: a mesh for its faces, and children for its lines and points.
#pragma once

#include <set>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_materials.h"
#include "easypbr/io/mesh/gltf/gltf_variants.h"
#include "easypbr/scene/animation.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// In the extras of a primitive of lines that EasyPBR writes beside faces: it is their E, which is not drawn.
inline constexpr const char* gltf_edges_of_faces = "EasyPBR:edges_of_faces";

/// In the extras of a mesh that EasyPBR writes of voxels: their edge (MeshData::voxel_size).
inline constexpr const char* gltf_voxel_size = "EasyPBR:voxel_size";

struct GltfMesh {
    MeshData data;
    Deformation deformation;                       ///< empty without joints and morph targets
    std::vector<float> weights;                    ///< of the morph targets at rest
    std::vector<std::optional<size_t>> materials;  ///< of the file, one for each of data's
    std::vector<GltfMesh> children;                ///< which data does not have yet: each node has its own
};

/// Triangles, strips and fans become F with a part for each primitive, lines E, points plain vertices.
/// A mesh draws faces, or lines or points of one material: others of its primitives are children of it, where
/// there are faces all lines and points, but for lines marked by gltf_edges_of_faces. Splats are the mesh
/// where they are its only primitive, else children. Primitives with the same attributes share their
/// vertices, in the order of the file. Of points, of lines beside others and of accessors in
/// `shared_positions` a mesh has only the vertices that it indexes. Without any normals the mesh is drawn
/// flat. Where only some primitives have normals, the faces of the others have vertices of their own with the
/// normals of the faces. Throws FormatError as load_gltf() does.
GltfMesh read_gltf_mesh(GltfDocument& document, const GltfMaterials& materials, const GltfVariants& variants,
                        const std::set<size_t>& shared_positions, size_t index);

}  // namespace easypbr::io
