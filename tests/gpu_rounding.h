// What tests allow where a GPU draws.
#pragma once

#include "easypbr/gl/context.h"

namespace easypbr {

/// Whether pictures are drawn by a GPU on this machine.
inline bool has_gpu() {
    static const bool has = !gl::Context::create()->info().software;
    return has;
}

/// Pixels by which a surface may be off, 0 where none does: GPUs move vertices to places of 8 bits within a
/// pixel (GL_SUBPIXEL_BITS), and interpolate over the triangles that they have then. Natively, and by
/// llvmpipe, only what is covered follows the moved ones.
inline double vertex_rounding() {
    return has_gpu() ? 1.0 / 256 : 0.0;
}

}  // namespace easypbr
