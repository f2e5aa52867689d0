// The table of the split sum: A and B with L_specular = L_prefiltered (F0 A + B) (Karis 2013).
#pragma once

#include <cstdint>
#include <span>

#include "easypbr/native/views.h"

namespace easypbr {
enum class Brdf;
}

namespace easypbr::gpu {

/// Nodes per side. Node (i, j) holds NoV = (i / (N - 1))^2, roughness = j / (N - 1), row by row in roughness.
inline constexpr int dfg_size = 64;

/// A and B of one node's geometry term as halves: 2 dfg_size^2 values, computed when the library was built.
std::span<const uint16_t> dfg_table(Brdf brdf);
/// The same for native shaders.
native::View host_dfg(Brdf brdf);

/// What the sheen of KHR_materials_sheen with colour 1 reflects of a uniform environment (Estevez and Kulla
/// 2017), at the same nodes, as halves.
std::span<const uint16_t> sheen_albedo_table();
/// The same for native shaders.
native::View host_sheen_albedo();

}  // namespace easypbr::gpu
