#include "easypbr/render/primitives/splats/splat_compositor.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// A tile's part of values of the whole frame; beyond the frame nothing is seen.
void copy_tile(std::span<const float> from, Vec2i size, float missing, const SplatTile& tile,
               SplatTile::Pixels& to) {
    to.fill(missing);
    if (from.empty()) return;
    const int columns = std::min(SplatTile::size, size.x() - tile.left),
              rows = std::min(SplatTile::size, size.y() - tile.top);
    for (int y = 0; y < rows; ++y)
        std::copy_n(&from[size_t(tile.top + y) * size_t(size.x()) + size_t(tile.left)], columns,
                    &to[size_t(y) * SplatTile::size]);
}

}  // namespace

void SplatCompositor::begin(const Frame& frame, const std::vector<const DrawItem*>& items,
                            const SplatSet::Finish& finish) {
    settings_ = frame.resolved->settings.splats;
    const Mat4d& P = frame.clip_from_view;
    axis_ = {float(P(2, 2)), float(P(2, 3)), float(P(3, 2)), float(P(3, 3))};
    set_.begin(view_of(frame), items, finish);
}

void SplatCompositor::blend(const Limits& limits, const Take& take, bool sums_positions) {
    set_.for_each_tile([&](int column, int row, std::span<const uint32_t> places) {
        // What is of a thread itself takes room on the stack of every thread.
        thread_local const auto own = std::make_unique<SplatTile>();
        SplatTile& tile = *own;
        tile.left = column * SplatTile::size;
        tile.top = row * SplatTile::size;
        tile.clear();
        tile.is_limited = !limits.farthest.empty() || !limits.nearest.empty();
        if (tile.is_limited) {
            constexpr float no_limit = std::numeric_limits<float>::infinity();
            copy_tile(limits.farthest, size(), 0, tile, tile.farthest);
            copy_tile(limits.nearest, size(), no_limit, tile, tile.nearest);
            std::ranges::replace(tile.farthest, 0.0f, -no_limit);
            // Most tiles have no surface.
            tile.is_limited =
                std::ranges::any_of(tile.farthest, [](float depth) { return depth > -no_limit; }) ||
                std::ranges::any_of(tile.nearest, [](float depth) { return depth < no_limit; });
        }
        tile.is_soft = settings_.soft;
        tile.sums_positions = sums_positions;
        tile.axis = axis_;
        settings_.resort ? tile.blend_resorted(set_.splats(), places) : tile.blend(set_.splats(), places);
        take(tile);
    });
}

}  // namespace easypbr::render
