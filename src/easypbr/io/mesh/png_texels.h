// Images of textures as PNG files have them: integers, of colours and of data.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "easypbr/scene/material_table.h"

namespace easypbr::io {

/// The images of one mesh file that is being written.
class PngTexels {
  public:
    /// The texels of a texture with an image, for what they are used as. f32 becomes u8: sRGB of colours, the
    /// numbers themselves of data. u8 and u16 stay. The same object for each use in which the texels are the
    /// same: of colours and their alpha there is one. Warns once of each image whose colours are clamped;
    /// `name` is that of the material's texture, without "_texture".
    std::shared_ptr<const Image> of(const Texture& texture, TexelUse use, std::string_view name);

  private:
    using ImagePointer = std::shared_ptr<const Image>;
    /// By image and whether it is sRGB.
    std::map<std::pair<ImagePointer, bool>, ImagePointer> images_;
    std::set<ImagePointer> checked_;  ///< for colours that are clamped
};

}  // namespace easypbr::io
