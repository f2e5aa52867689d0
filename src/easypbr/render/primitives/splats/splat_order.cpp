#include "easypbr/render/primitives/splats/splat_order.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

struct Keyed {
    uint32_t key, place;
};

constexpr size_t sort_block = 1 << 16;
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

/// Puts splats of equal depth in the order of what they look like.
void order_equal_depths(std::span<const ProjectedSplat> splats, std::span<Keyed> items) {
    const auto is_first = [&](size_t i) { return i == 0 || items[i - 1].key != items[i].key; };
    parallel_chunks(items.size(), sort_block, [&](size_t begin, size_t end) {
        // A chunk has the runs that begin in it.
        for (size_t first = begin, past; first < end; first = past) {
            for (past = first + 1; past < items.size() && items[past].key == items[first].key;) ++past;
            if (past - first == 1 || !is_first(first)) continue;
            std::stable_sort(items.begin() + std::ptrdiff_t(first), items.begin() + std::ptrdiff_t(past),
                             [&](const Keyed& a, const Keyed& b) {
                                 return look_of(splats[a.place]) < look_of(splats[b.place]);
                             });
        }
    });
}

int tiles_across(int pixels) {
    return (pixels + SplatTiles::tile_size - 1) / SplatTiles::tile_size;
}

}  // namespace

std::vector<uint32_t> front_to_back(std::span<const ProjectedSplat> splats,
                                    std::span<const uint32_t> places) {
    const size_t count = places.size();
    auto items = std::make_unique_for_overwrite<Keyed[]>(count),
         other = std::make_unique_for_overwrite<Keyed[]>(count);
    // Depths are above 0, and their bits rise with them.
    parallel_for(count, sort_block, [&](size_t i) {
        items[i] = {~std::bit_cast<uint32_t>(splats[places[i]].depth), places[i]};
    });
    for (int shift = 0; shift < 32; shift += digit_bits) {
        sort_by_digit({items.get(), count}, {other.get(), count}, shift);
        items.swap(other);
    }
    other.reset();
    order_equal_depths(splats, {items.get(), count});
    std::vector<uint32_t> order(count);
    parallel_for(count, sort_block, [&](size_t i) { order[i] = items[i].place; });
    return order;
}

SplatTiles::Box SplatTiles::box_of(const ProjectedSplat& s, int columns, int rows) {
    constexpr float scale = 1.0f / tile_size;
    const auto tile = [](float pixel, int last) {
        return int(std::clamp(std::floor(pixel * scale), -1.0f, float(last)));
    };
    // Pixels are seen by their centres.
    const int x0 = std::max(0, tile(std::ceil(s.x - s.half_width - 0.5f), columns)),
              y0 = std::max(0, tile(std::ceil(s.y - s.half_height - 0.5f), rows)),
              x1 = std::min(columns, tile(s.x + s.half_width - 0.5f, columns) + 1),
              y1 = std::min(rows, tile(s.y + s.half_height - 0.5f, rows) + 1);
    if (x1 <= x0 || y1 <= y0) return {};
    return {uint16_t(x0), uint16_t(y0), uint16_t(x1), uint16_t(y1)};
}

void SplatTiles::clear() {
    boxes_.reset();
    entries_.reset();
}

size_t SplatTiles::begin(std::span<const ProjectedSplat> splats, std::span<const uint32_t> order,
                         Vec2i size) {
    columns_ = tiles_across(size.x());
    rows_ = tiles_across(size.y());
    boxes_ = std::make_unique_for_overwrite<Box[]>(order.size());
    std::atomic<size_t> entries = 0;
    parallel_chunks(order.size(), sort_block, [&](size_t begin, size_t end) {
        size_t own = 0;
        for (size_t i = begin; i < end; ++i) {
            if (i + 16 < end) __builtin_prefetch(&splats[order[i + 16]]);
            const Box box = boxes_[i] = box_of(splats[order[i]], columns_, rows_);
            own += size_t(box.x1 - box.x0) * size_t(box.y1 - box.y0);
        }
        entries += own;
    });
    return entries;
}

void SplatTiles::bin(std::span<const uint32_t> order, int first_row, int end_row) {
    first_row_ = first_row;
    const size_t tiles = size_t(columns_) * size_t(end_row - first_row);
    // Few enough that their counts take less room than the lists.
    const size_t block = std::max<size_t>(order.size() / 64 + 1, 1 << 12);
    std::vector<std::vector<uint32_t>> counts(block_count(order.size(), block), std::vector<uint32_t>(tiles));
    const auto for_each_tile = [&](size_t begin, size_t end, auto&& body) {
        for (size_t i = begin; i < end; ++i) {
            const Box box = boxes_[i];
            const int y0 = std::max(int(box.y0), first_row), y1 = std::min(int(box.y1), end_row);
            for (int y = y0; y < y1; ++y)
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
    entries_.reset();
    entries_ = std::make_unique_for_overwrite<uint32_t[]>(first_.back());
    parallel_chunks(order.size(), block, [&](size_t begin, size_t end) {
        auto& own = counts[begin / block];
        for_each_tile(begin, end,
                      [&](size_t tile, uint32_t splat) { entries_[first_[tile] + own[tile]++] = splat; });
    });
}

}  // namespace easypbr::render
