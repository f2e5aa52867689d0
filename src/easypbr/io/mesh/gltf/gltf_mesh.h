// One mesh of a glTF file: its primitives as parts of a single vertex and face list.
#pragma once

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_materials.h"
#include "easypbr/io/mesh/gltf/gltf_variants.h"
#include "easypbr/scene/animation.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

struct GltfMesh {
    MeshData data;
    Deformation deformation;                       ///< empty without joints and morph targets
    std::vector<float> weights;                    ///< of the morph targets at rest
    std::vector<std::optional<size_t>> materials;  ///< of the file, one for each of data's
};

/// Triangles, strips and fans become F with a part for each primitive, lines E, points plain vertices.
/// Splats are the mesh where they are its only primitive, else children of it.
/// Primitives with the same attributes share their vertices, of which those are read that they index, in the
/// order of the file. Without any normals the mesh is drawn flat.
/// Where only some primitives have normals, the faces of the others have vertices of their own with the
/// normals of the faces. Throws FormatError as load_gltf() does.
GltfMesh read_gltf_mesh(GltfDocument& document, const GltfMaterials& materials, const GltfVariants& variants,
                        size_t index);

}  // namespace easypbr::io
