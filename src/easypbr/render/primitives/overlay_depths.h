// Depths that overlays are ordered by: reversed, of every pixel of the frame, row by row, in host memory.
#pragma once

#include <vector>

#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// Of a texture of the format r32f.
std::vector<float> read_depths(const gl::Texture& depth);
/// Of a target in host memory, which may hold a part of the frame; 0 elsewhere.
std::vector<float> whole_depths(const Target& depth);
/// Pixels of depth 0 take the nearest depth of the eight around them.
void widen_by_a_pixel(std::vector<float>& depths, Vec2i size);

}  // namespace easypbr::render
