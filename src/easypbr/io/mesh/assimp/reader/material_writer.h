// Materials of an assimp scene.
#pragma once

#include <assimp/scene.h>

#include "easypbr/io/mesh/assimp/reader/message_writer.h"

namespace easypbr::io {

/// The images inside the file, in assimp's order.
void write_images(const aiScene& scene, MessageWriter& out);

/// All materials, in assimp's order. PBR keys are taken where there are any; else diffuse colour (linear, as
/// in MTL; of 3MF sRGB with an alpha) and shininess n, as roughness^4 = 2 / (n + 2) (Walter et al. 2007:
/// Phong lobe of equal width).
void write_materials(const aiScene& scene, bool is_3mf, MessageWriter& out);

}  // namespace easypbr::io
