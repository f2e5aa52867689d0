// Materials of an assimp scene.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <vector>

#include "easypbr/scene/material.h"

namespace easypbr::io {

/// All materials with their textures, in assimp's order. PBR keys are taken where there are any; else diffuse
/// colour (linear, as in MTL) and shininess n, as roughness^4 = 2 / (n + 2) (Walter et al. 2007: Phong lobe
/// of equal width).
std::vector<Material> assimp_materials(const aiScene& scene, const std::filesystem::path& path);

}  // namespace easypbr::io
