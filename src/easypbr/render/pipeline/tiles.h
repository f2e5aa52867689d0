// Pictures that are too large to be drawn at once, in tiles with guard bands.
#pragma once

#include <vector>

#include "easypbr/gl/context.h"
#include "easypbr/render/frame/frame.h"

namespace easypbr::render {

/// A part of a picture, and what is drawn for it: more, so that its borders see what lies beyond them.
struct Tile {
    PixelRect inner, outer;
};

/// What is drawn at once: no side longer, no more pixels. Larger pictures are drawn in tiles of these limits,
/// guard bands included.
struct TileLimits {
    int side = 8192;
    /// Memory: the targets of a pixel take 100 to 200 bytes, by the effects that are on.
    int64_t pixels = int64_t(1) << 25;

    /// These, and what a context can draw.
    static TileLimits of(const gl::ContextInfo& context);
};

/// Tiles begin at multiples of this many pixels: of the widest texels of bloom, of the pattern that occlusion
/// is sampled by, and of the driver's 2 x 2 pixels.
inline constexpr int tile_grid = 128;

/// How far the pixels of a picture see beyond themselves.
struct Guard {
    int pixels = 0;                  ///< beyond a tile's borders on
    double reach = unlimited_reach;  ///< Frame::reach of its tiles
};

/// Ambient occlusion is cut off at 1024 pixels, at 512 beside transmission, which sees as far; all tiles cut
/// alike, so that no seam shows.
Guard guard_of(const SceneSnapshot& scene, const ResolvedSettings& resolved, Vec2i picture);

/// One tile with all of a picture that the limits allow to be drawn at once; else tiles that lie side by side
/// and cover it, row by row. Throws ArgumentError when the guard bands leave no room between them.
std::vector<Tile> tiles_of(Vec2i picture, int guard, const TileLimits& limits);

}  // namespace easypbr::render
