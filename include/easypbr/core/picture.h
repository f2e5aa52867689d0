// Pictures in plain terms: what their values are, parts of them, and how passes draw into them.
#pragma once

#include <string>
#include <vector>

#include "easypbr/core/error.h"

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

/// What pictures are drawn by. The environment variable EASYPBR_DEVICE, "auto", "gl" or "cpu", stands for
/// `automatic`.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // GCC takes enumerators for names in the namespace.
enum class DrawDevice {
    automatic,  ///< a GPU where there is one, else the CPU
    gl,         ///< OpenGL: a GPU, or a driver that draws on the CPU
    cpu  ///< natively; OpenGL is loaded for what it alone can draw, and that is an error where it is missing
};
#pragma GCC diagnostic pop

/// "auto", "gl", "cpu". Throws NameError with the nearest name.
DrawDevice draw_device_named(const std::string& name);
const std::vector<std::string>& draw_device_names();

}  // namespace easypbr
