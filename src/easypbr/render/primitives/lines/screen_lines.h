// Line segments as they lie on the screen, for the native rasteriser.
#pragma once

#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/gpu/line_segments.h"
#include "easypbr/native/kernels.h"

namespace easypbr::render {

/// How segments are seen; as shaders/overlay_lines.vert.
struct LineView {
    Mat4 clip_from_mesh = Mat4::Identity();
    Vec2 size{0, 0};  ///< of the picture, pixels
    bool orthographic = false;
    float near = 0;          ///< of a perspective camera
    Vec4 color{0, 0, 0, 0};  ///< linear; w: 0: the segments' own, -1: their own opacity, 1: none
};

/// Those that are not wholly before the near plane (or, orthographic, beyond near and far plane), which cut
/// the others. In their order.
std::vector<native::ScreenLine> screen_lines(std::span<const gpu::Segment> segments, const LineView& view);

}  // namespace easypbr::render
