#include "easypbr/render/primitives/splats/splat_compositor.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

constexpr size_t projection_block = 1 << 13;
/// Entries of tiles' lists that are held at once: 256 MB. Where there are more, the screen is blended band by
/// band.
constexpr size_t most_entries = size_t(1) << 26;

/// The splats of an item that are seen, in their order.
void append_projected(const SplatProjector& projector, Eigen::Index count,
                      std::vector<ProjectedSplat>& splats) {
    std::vector<std::vector<ProjectedSplat>> blocks((size_t(count) + projection_block - 1) /
                                                    projection_block);
    parallel_chunks(size_t(count), projection_block, [&](size_t begin, size_t end) {
        std::vector<ProjectedSplat>& own = blocks[begin / projection_block];
        ProjectedSplat splat;
        for (size_t i = begin; i < end; ++i)
            if (projector.project(Eigen::Index(i), splat)) own.push_back(splat);
    });
    std::vector<size_t> first(blocks.size() + 1, splats.size());
    for (size_t i = 0; i < blocks.size(); ++i) first[i + 1] = first[i] + blocks[i].size();
    splats.resize(first.back());
    parallel_for(blocks.size(), 1, [&](size_t i) {
        std::ranges::copy(blocks[i], splats.begin() + std::ptrdiff_t(first[i]));
        blocks[i] = {};
    });
}

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

void SplatCompositor::begin(const Frame& frame, const std::vector<const DrawItem*>& items) {
    size_ = frame.size;
    items_ = items;
    ends_.clear();
    splats_.clear();
    for (const DrawItem* item : items) {
        append_projected(SplatProjector(frame, *item), item->mesh().V.rows(), splats_);
        ends_.push_back(splats_.size());
    }
    order_ = front_to_back(splats_);
}

const DrawItem& SplatCompositor::item_of(uint32_t place) const {
    return *items_[size_t(std::ranges::upper_bound(ends_, place) - ends_.begin())];
}

void SplatCompositor::blend(const Limits& limits, const std::function<void(const SplatTile&)>& take) {
    if (splats_.empty()) return;
    const int rows = (size_.y() + SplatTile::size - 1) / SplatTile::size;
    const size_t bands = 1 + SplatTiles::count_entries(splats_, size_) / most_entries;
    const int step = std::max(1, rows / int(std::min(bands, size_t(rows))));
    for (int first = 0; first < rows; first += step) {
        const int end = std::min(first + step, rows);
        tiles_.bin(splats_, order_, size_, first, end);
        parallel_for(size_t(end - first) * size_t(tiles_.columns()), 1, [&](size_t i) {
            const int column = int(i) % tiles_.columns(), row = first + int(i) / tiles_.columns();
            const std::span<const uint32_t> places = tiles_.of(column, row);
            if (places.empty()) return;
            thread_local SplatTile tile;
            tile.left = column * SplatTile::size;
            tile.top = row * SplatTile::size;
            tile.clear();
            tile.is_limited = !limits.farthest.empty() || !limits.nearest.empty();
            if (tile.is_limited) {
                copy_tile(limits.farthest, size_, 0, tile, tile.farthest);
                copy_tile(limits.nearest, size_, std::numeric_limits<float>::infinity(), tile, tile.nearest);
            }
            tile.blend(splats_, places);
            take(tile);
        });
    }
}

}  // namespace easypbr::render
