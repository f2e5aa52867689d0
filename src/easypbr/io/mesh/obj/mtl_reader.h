// MTL: the material files of OBJ, with the PBR extension's keywords (Pr, Pm, map_Pr, map_Pm, map_Ke, norm).
#pragma once

#include <map>
#include <string>

#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/source/source.h"
#include "easypbr/scene/material.h"

namespace easypbr::io {

/// Materials by name. Kd and Ke are linear Rec.709. Without Pr, the roughness is that of the Beckmann
/// distribution nearest to the Phong exponent Ns (Walter et al. 2007, section 5.2): alpha = sqrt(2 / (Ns +
/// 2)), roughness = sqrt(alpha). A map alone has the factor 1. `map_d` cuts out where the image is black and
/// white and nothing else is transparent, else it blends. Opacity is `d` wherever it is given; else 1 - Tr,
/// but 1 for `Tr 1`, with a warning, and Tr in files whose first comment names VTK. `map_d` is the alpha of
/// an image that has one, unless it is 1 everywhere, else its first channel; where it is the alpha of the
/// base colour's texture there is no texture beside that. `illum 0` (constant colour) is unlit. Lines that
/// are not understood are left out; maps that have no counterpart are reported to the log. Images are looked
/// for in the folder of the source before that of the textures.
std::map<std::string, Material> read_mtl(const Source& source, TextureLoader& textures);

}  // namespace easypbr::io
