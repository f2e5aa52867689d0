#include "easypbr/render/primitives/splats/splat_set.h"

#include <algorithm>
#include <numeric>

#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

constexpr size_t projection_block = 1 << 13;
/// Entries of tiles' lists that are held at once: 256 MB. Where there are more, the screen is drawn band by
/// band.
constexpr size_t most_entries = size_t(1) << 26;

}  // namespace

void SplatSet::project(const SplatView& view, const DrawItem& item, size_t first, const Finish& finish) {
    const SplatProjector projector(view, item);
    const auto count = size_t(item.mesh().V.rows());
    std::vector<uint32_t> seen((count + projection_block - 1) / projection_block);
    parallel_chunks(count, projection_block, [&](size_t begin, size_t end) {
        ProjectedSplat* const own = splats_.get() + first + begin;
        uint32_t& n = seen[begin / projection_block];
        for (size_t i = begin; i < end; ++i)
            if (projector.project(Eigen::Index(i), own[n])) ++n;
        if (finish) finish(projector, item, {own, n});
    });
    // Of each block's in the order.
    size_t end_of_all = order_.size();
    std::vector<size_t> ends;
    for (const uint32_t n : seen) ends.push_back(end_of_all += n);
    order_.resize(end_of_all);
    parallel_for(seen.size(), 1, [&](size_t block) {
        const auto end = order_.begin() + std::ptrdiff_t(ends[block]);
        std::iota(end - seen[block], end, uint32_t(first + block * projection_block));
    });
}

void SplatSet::begin(const SplatView& view, const std::vector<const DrawItem*>& items, const Finish& finish) {
    size_ = view.size;
    items_ = items;
    ends_.clear();
    order_.clear();
    tiles_.clear();
    size_t count = 0;
    for (const DrawItem* item : items) ends_.push_back(count += size_t(item->mesh().V.rows()));
    if (count > room_) {
        splats_.reset();
        splats_ = std::make_unique_for_overwrite<ProjectedSplat[]>(count);
        room_ = count;
    }
    for (size_t i = 0; i < items.size(); ++i) project(view, *items[i], i == 0 ? 0 : ends_[i - 1], finish);
    order_ = front_to_back(splats(), order_);
    entries_ = tiles_.begin(splats(), order_, size_);
}

const DrawItem& SplatSet::item_of(uint32_t place) const {
    return *items_[size_t(std::ranges::upper_bound(ends_, place) - ends_.begin())];
}

void SplatSet::for_each_tile(const std::function<void(int, int, std::span<const uint32_t>)>& body) {
    if (empty()) return;
    const int rows = tiles_.rows();
    const size_t bands = 1 + entries_ / most_entries;
    const int step = std::max(1, rows / int(std::min(bands, size_t(rows))));
    for (int first = 0; first < rows; first += step) {
        const int end = std::min(first + step, rows);
        tiles_.bin(order_, first, end);
        parallel_for(size_t(end - first) * size_t(tiles_.columns()), 1, [&](size_t i) {
            const int column = int(i) % tiles_.columns(), row = first + int(i) / tiles_.columns();
            const std::span<const uint32_t> places = tiles_.of(column, row);
            if (!places.empty()) body(column, row, places);
        });
    }
}

}  // namespace easypbr::render
