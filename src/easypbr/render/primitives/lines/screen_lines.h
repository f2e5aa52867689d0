// Line segments as they lie on the screen, for the native rasteriser.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/gpu/line_segments.h"
#include "easypbr/native/kernels.h"

namespace easypbr::render {

/// How segments are seen; as shaders/overlay_lines.vert.
struct LineView {
    Mat4 clip_from_mesh = Mat4::Identity();
    Vec2 size{0, 0};         ///< of the picture, pixels
    Vec4 color{0, 0, 0, 0};  ///< linear; w: 0: the segments' own, -1: their own opacity, 1: none
    float dash = 0;          ///< pixels, 0: solid
    /// Along which dashes go on; empty: they begin with each segment.
    std::span<const gpu::ChainStep> chains = {};
};

/// Those that do not lie wholly before the near plane, beyond the far plane of an orthographic camera or far
/// outside of the picture; the others are cut there. In their order.
std::vector<native::ScreenLine> screen_lines(std::span<const gpu::Segment> segments, const LineView& view);

/// native::ScreenLine::dash of each segment.
std::vector<std::array<float, 2>> dashes_of(std::span<const gpu::Segment> segments, const LineView& view);

}  // namespace easypbr::render
