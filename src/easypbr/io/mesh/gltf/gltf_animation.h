// Animations, skins and nodes of a glTF file (glTF 2.0, sections 3.5, 3.7.3 and 3.11).
#pragma once

#include <vector>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/io/mesh/gltf/gltf_pointers.h"
#include "easypbr/scene/animation.h"

namespace easypbr::io {

inline constexpr const char* khr_animation_pointer = "KHR_animation_pointer";
inline constexpr const char* khr_node_visibility = "KHR_node_visibility";

/// Translation, rotation and scale, or the matrix, of a node; parent, mesh and deformation stay empty. Throws
/// FormatError.
AnimationNode read_gltf_pose(const GltfDocument& document, size_t index);

/// All nodes with parents and skins, the skins, the animations, the materials that they change, which
/// `pointers` finds, and the lights and cameras, without users. Without animations nodes and skins alone, and
/// without skins and weights of morph targets nothing. Channels whose target is not known are left out.
/// Throws FormatError for keys that do not rise or do not fit their values, and indices out of range.
AnimationRig read_gltf_rig(GltfDocument& document, GltfMaterialPointers& pointers);

}  // namespace easypbr::io
