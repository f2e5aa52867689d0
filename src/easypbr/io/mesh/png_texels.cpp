#include "easypbr/io/mesh/png_texels.h"

#include <fmt/format.h>

#include "easypbr/scene/texture_warnings.h"

namespace easypbr::io {

std::shared_ptr<const Image> PngTexels::of(const Texture& texture, TexelUse use, std::string_view name) {
    const Image& image = *texture.image;
    if (image.type() != PixelType::f32) return texture.image;
    if (use == TexelUse::color && checked_.insert(texture.image).second)
        warn_of_clamped_colors(image, name_in_warning(texture, fmt::format("{}_texture", name)));
    // Alpha has no curve.
    const bool is_alpha = has_alpha(image) && texture.channel == image.channels() - 1;
    const bool is_srgb = use == TexelUse::color || (use == TexelUse::number && is_alpha);
    ImagePointer& texels = images_[{texture.image, is_srgb}];
    if (!texels) texels = std::make_shared<const Image>(texels_to_u8(image, is_srgb));
    return texels;
}

}  // namespace easypbr::io
