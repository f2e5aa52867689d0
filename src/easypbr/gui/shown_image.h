// How values become colours in the images beside the scene.
#pragma once

#include "easypbr/app/picture.h"
#include "easypbr/core/image.h"
#include "easypbr/scene/colormap.h"

namespace easypbr::gui {

using app::ImageLook;

/// The values that the first and the last colour stand for; min < max. Of f32 with one channel data_min and
/// data_max are those of all finite values.
ValueRange range_of(const Image& image, const ImageLook& look);
Colormap colormap_of(const Image& image, const ImageLook& look);

/// What a look makes of an image: RGBA u8 of the same size. Transparent parts stand before a chequered
/// ground; NaN is magenta.
Image shown_image(const Image& image, const ImageLook& look);

}  // namespace easypbr::gui
