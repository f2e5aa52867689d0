// Primitives of a glTF mesh that become one mesh of ours.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_materials.h"
#include "easypbr/io/mesh/gltf/gltf_mesh.h"

namespace easypbr::io {

/// The numbers of the specification.
enum class GltfMode : size_t {
    points,
    lines,
    line_loop,
    line_strip,
    triangles,
    triangle_strip,
    triangle_fan
};

/// What a mesh draws: it has one kind of primitives.
enum class GltfKind { faces, lines, points };

struct GltfPrimitive {
    const Json* json;
    GltfMode mode;
    GltfKind kind;
    std::optional<size_t> material;
};

/// Primitives that are one mesh; lines and points have one material.
struct GltfPrimitiveGroup {
    GltfKind kind;
    std::vector<GltfPrimitive> primitives;
};

/// The mesh of the file that groups are of.
struct GltfMeshSource {
    const Json& json;
    std::string name;         ///< for messages
    size_t target_count = 0;  ///< morph targets, which its weights are for
};

/// Makes a mesh of a group. Throws FormatError as load_gltf() does.
GltfMesh build_gltf_mesh(GltfDocument& document, const GltfMaterials& materials,
                         const std::set<size_t>& shared_positions, const GltfMeshSource& source,
                         const GltfPrimitiveGroup& group);

}  // namespace easypbr::io
