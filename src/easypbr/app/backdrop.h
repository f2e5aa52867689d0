// Background images behind pictures that are drawn without them.
#pragma once

#include <memory>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"

namespace easypbr {
struct BackgroundSettings;
}

namespace easypbr::app {

/// A background image in a picture's pixels, and the encoding of the picture over it.
struct Backdrop {
    /// RGB f32, opaque: linear light for Encoding::scene_linear, else sRGB-encoded, 1 is white.
    std::shared_ptr<const Image> image;
    Encoding encoding = Encoding::srgb8;
};

/// Keeps what was asked for last.
class BackdropCache {
  public:
    /// The image, over the background's colour where it is transparent, as the renderer shows it in a picture
    /// of this size and encoding.
    Backdrop get(const BackgroundSettings& background, const std::shared_ptr<const Image>& image, Vec2i size,
                 Encoding encoding);

  private:
    std::shared_ptr<const Image> of_;  ///< the background image
    Vec3 color_{0, 0, 0};
    bool is_linear_ = false;
    std::shared_ptr<const Image> image_;
};

/// The picture over the backdrop, mixed in linear light as the renderer does it. `picture` has its size and
/// four channels: f32 of light (premultiplied) for Encoding::scene_linear, else u16 (straight codes). The
/// result is of the encoding's type; opaque pixels keep their codes.
Image over_backdrop(const Image& picture, const Backdrop& backdrop);

}  // namespace easypbr::app
