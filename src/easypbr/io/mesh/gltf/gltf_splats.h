// 3D Gaussian splats in glTF: KHR_gaussian_splatting, release candidate of 2026.
#pragma once

#include <string>

#include "easypbr/io/mesh/gltf/gltf_document.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

inline constexpr const char* khr_gaussian_splatting = "KHR_gaussian_splatting";
/// A draft: the splats as an SPZ file in a buffer view.
inline constexpr const char* khr_splats_as_spz = "KHR_gaussian_splatting_compression_spz_2";

// Names of the attributes.
inline constexpr const char* splat_rotation_attribute = "KHR_gaussian_splatting:ROTATION";  ///< x, y, z, w
inline constexpr const char* splat_scale_attribute = "KHR_gaussian_splatting:SCALE";        ///< no logarithm
inline constexpr const char* splat_opacity_attribute = "KHR_gaussian_splatting:OPACITY";
/// Of the k-th spherical harmonic of a degree.
std::string splat_harmonic_name(int degree, int k);

/// Whether a primitive is one of splats.
bool has_gltf_splats(const Json& primitive);

/// The splats of a primitive. Throws FormatError that names the mesh for attributes that are missing or do
/// not fit together. Kernels other than ellipses are drawn as such, with a warning.
MeshData read_gltf_splats(GltfDocument& document, const Json& primitive, const std::string& mesh);

}  // namespace easypbr::io
