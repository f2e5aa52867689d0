#include "easypbr/io/mesh/png_texels.h"

namespace easypbr::io {

std::shared_ptr<const Image> PngTexels::of(const Texture& texture, TexelUse use) {
    const Image& image = *texture.image;
    if (image.type() != PixelType::f32) return texture.image;
    // Alpha has no curve.
    const bool is_alpha = has_alpha(image) && texture.channel == image.channels() - 1;
    const bool is_srgb = use == TexelUse::color || (use == TexelUse::number && is_alpha);
    ImagePointer& texels = images_[{texture.image, is_srgb}];
    if (!texels) texels = std::make_shared<const Image>(texels_to_u8(image, is_srgb));
    return texels;
}

}  // namespace easypbr::io
