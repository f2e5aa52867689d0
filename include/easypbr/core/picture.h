// Pictures in plain terms: what their values are, parts of them, and how passes draw into them.
#pragma once

#include <string>
#include <vector>

namespace easypbr {

/// What a picture's values are.
enum class Encoding {
    srgb8,        ///< RGBA8, tone mapped, sRGB-encoded, straight alpha
    srgb16,       ///< RGBA16, the same
    scene_linear  ///< RGBA32F, radiance before exposure and tone curve, premultiplied alpha
};

/// A rectangle of pixels, row 0 on top.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// When a pass of a program's own draws, and what into.
enum class Stage {
    light,    ///< in each frame before lens, bloom and tone curve: linear radiance, premultiplied by coverage
    overlay,  ///< in each frame past the tone curve: linear display light, premultiplied, over the picture
    picture  ///< once, into the finished picture as it is encoded: sRGB with straight alpha, 8 or 16 bits, or
             ///< linear radiance
};

/// "light", "overlay", "picture". Throws NameError with the nearest name.
Stage stage_named(const std::string& name);
const std::vector<std::string>& stage_names();

/// How a pass' colours and those that are there become one.
enum class Blend {
    over,    ///< premultiplied colours over what is there
    add,     ///< to what is there
    replace  ///< what is there
};

}  // namespace easypbr
