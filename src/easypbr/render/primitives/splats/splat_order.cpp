#include "easypbr/render/primitives/splats/splat_order.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

struct Keyed {
    uint32_t key, place;
};

constexpr size_t sort_block = 1 << 16;
/// The entries of so many in tiles are counted, those of more estimated.
constexpr size_t few_splats = 1 << 14;
constexpr int digit_bits = 11, digit_count = 1 << digit_bits;

size_t block_count(size_t count, size_t block) {
    return (count + block - 1) / block;
}

/// A stable pass of a radix sort: blocks count their digits, then each knows where its items go.
void sort_by_digit(std::span<const Keyed> from, std::span<Keyed> to, int shift) {
    std::vector<std::array<uint32_t, digit_count>> places(block_count(from.size(), sort_block));
    const auto digit_of = [&](const Keyed& item) { return (item.key >> shift) & (digit_count - 1); };
    parallel_chunks(from.size(), sort_block, [&](size_t begin, size_t end) {
        auto& counts = places[begin / sort_block];
        counts.fill(0);
        for (size_t i = begin; i < end; ++i) ++counts[digit_of(from[i])];
    });
    uint32_t next = 0;
    for (int digit = 0; digit < digit_count; ++digit)
        for (auto& block : places) next += std::exchange(block[size_t(digit)], next);
    parallel_chunks(from.size(), sort_block, [&](size_t begin, size_t end) {
        auto& place = places[begin / sort_block];
        for (size_t i = begin; i < end; ++i) to[place[digit_of(from[i])]++] = from[i];
    });
}

/// All that a splat adds to a picture.
auto look_of(const ProjectedSplat& s) {
    return std::tie(s.x, s.y, s.opacity, s.xx, s.xy, s.yy, s.red, s.green, s.blue, s.depth_x, s.depth_y);
}

/// The tiles that a splat is seen in.
struct TileBox {
    int x0, y0, x1, y1;
};

TileBox tile_box(const ProjectedSplat& s, int columns, int first_row, int end_row) {
    constexpr float scale = 1.0f / SplatTiles::tile_size;
    const auto tile = [](float pixel, int low, int high) {
        return int(std::clamp(std::floor(pixel * scale), float(low), float(high)));
    };
    // Pixels are seen by their centres.
    return {tile(std::ceil(s.x - s.half_width - 0.5f), 0, columns),
            tile(std::ceil(s.y - s.half_height - 0.5f), first_row, end_row),
            std::min(columns, tile(s.x + s.half_width - 0.5f, -1, columns) + 1),
            std::min(end_row, tile(s.y + s.half_height - 0.5f, first_row - 1, end_row) + 1)};
}

int tiles_across(int pixels) {
    return (pixels + SplatTiles::tile_size - 1) / SplatTiles::tile_size;
}

}  // namespace

std::vector<uint32_t> front_to_back(std::span<const ProjectedSplat> splats,
                                    std::span<const uint32_t> places) {
    std::vector<Keyed> items(places.size()), other(places.size());
    // Depths are above 0, and their bits rise with them.
    parallel_for(places.size(), sort_block, [&](size_t i) {
        items[i] = {~std::bit_cast<uint32_t>(splats[places[i]].depth), places[i]};
    });
    for (int shift = 0; shift < 32; shift += digit_bits) {
        sort_by_digit(items, other, shift);
        items.swap(other);
    }
    for (size_t begin = 0, end; begin < items.size(); begin = end) {
        for (end = begin + 1; end < items.size() && items[end].key == items[begin].key;) ++end;
        if (end - begin > 1)
            std::stable_sort(items.begin() + std::ptrdiff_t(begin), items.begin() + std::ptrdiff_t(end),
                             [&](const Keyed& a, const Keyed& b) {
                                 return look_of(splats[a.place]) < look_of(splats[b.place]);
                             });
    }
    other = {};
    std::vector<uint32_t> order(items.size());
    parallel_for(order.size(), sort_block, [&](size_t i) { order[i] = items[i].place; });
    return order;
}

size_t SplatTiles::estimated_entries(std::span<const ProjectedSplat> splats, std::span<const uint32_t> places,
                                     Vec2i size) {
    // Of many splats some are looked at, evenly spread over the depths.
    const size_t step = places.size() > few_splats ? 16 : 1;
    const int columns = tiles_across(size.x()), rows = tiles_across(size.y());
    size_t count = 0;
    for (size_t i = 0; i < places.size(); i += step) {
        const TileBox box = tile_box(splats[places[i]], columns, 0, rows);
        count += size_t(std::max(0, box.x1 - box.x0)) * size_t(std::max(0, box.y1 - box.y0));
    }
    return count * step;
}

void SplatTiles::bin(std::span<const ProjectedSplat> splats, std::span<const uint32_t> order, Vec2i size,
                     int first_row, int end_row) {
    columns_ = tiles_across(size.x());
    first_row_ = first_row;
    const size_t tiles = size_t(columns_) * size_t(end_row - first_row);
    // Few enough that their counts take less room than the lists.
    const size_t block = std::max<size_t>(order.size() / 64 + 1, 1 << 12);
    std::vector<std::vector<uint32_t>> counts(block_count(order.size(), block), std::vector<uint32_t>(tiles));
    const auto for_each_tile = [&](size_t begin, size_t end, auto&& body) {
        for (size_t i = begin; i < end; ++i) {
            if (i + 8 < end) __builtin_prefetch(&splats[order[i + 8]]);
            const TileBox box = tile_box(splats[order[i]], columns_, first_row, end_row);
            for (int y = box.y0; y < box.y1; ++y)
                for (int x = box.x0; x < box.x1; ++x)
                    body(size_t(y - first_row) * size_t(columns_) + size_t(x), order[i]);
        }
    };
    parallel_chunks(order.size(), block, [&](size_t begin, size_t end) {
        auto& own = counts[begin / block];
        for_each_tile(begin, end, [&](size_t tile, uint32_t) { ++own[tile]; });
    });
    first_.assign(tiles + 1, 0);
    for (size_t tile = 0; tile < tiles; ++tile) {
        size_t sum = 0;
        for (auto& own : counts) sum += std::exchange(own[tile], uint32_t(sum));
        first_[tile + 1] = first_[tile] + sum;
    }
    entries_.resize(first_.back());
    parallel_chunks(order.size(), block, [&](size_t begin, size_t end) {
        auto& own = counts[begin / block];
        for_each_tile(begin, end,
                      [&](size_t tile, uint32_t splat) { entries_[first_[tile] + own[tile]++] = splat; });
    });
}

}  // namespace easypbr::render
