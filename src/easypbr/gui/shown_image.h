// How values become colours in the images beside the scene.
#pragma once

#include <optional>

#include "easypbr/core/image.h"
#include "easypbr/scene/colormap.h"

namespace easypbr::gui {

/// How an image is shown. Its values are shown as they are: no curve is applied.
struct ImageLook {
    std::optional<float> min, max;  ///< black and white; none: 0 to 255 of u8, 0 to 65535 of u16, 0 to 1 of
                                    ///< f32 in colour, all finite values of f32 with one channel
    std::optional<Colormap> colormap;  ///< of one channel; none: grey, of f32 viridis
};

/// The values that the first and the last colour stand for; min < max. Of f32 with one channel data_min and
/// data_max are those of all finite values.
ValueRange range_of(const Image& image, const ImageLook& look);
Colormap colormap_of(const Image& image, const ImageLook& look);

/// What a look makes of an image: RGBA u8 of the same size. Transparent parts stand before a chequered
/// ground; NaN is magenta.
Image shown_image(const Image& image, const ImageLook& look);

}  // namespace easypbr::gui
