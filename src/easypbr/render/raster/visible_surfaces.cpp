#include "easypbr/render/raster/visible_surfaces.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

void VisibleSurfaces::clear(Vec2i size, const PixelRect& area) {
    buffer_.clear(size, area);
    items_.clear();
    next_id_ = 0;
}

void VisibleSurfaces::release() {
    clear({0, 0}, {});
    buffer_.release();
}

uint32_t VisibleSurfaces::add(const DrawItem& item, uint32_t count, std::unique_ptr<VisibleItem> visible) {
    const auto first = uint32_t(next_id_);
    items_.push_back({first, &item, std::move(visible)});
    next_id_ += count;
    return first;
}

const VisibleSurfaces::Entry& VisibleSurfaces::entry_of(uint32_t id) const {
    return *std::prev(std::upper_bound(items_.begin(), items_.end(), id,
                                       [](uint32_t v, const Entry& entry) { return v < entry.first_id; }));
}

PointRank VisibleSurfaces::rank(uint32_t id) const {
    const Entry& entry = entry_of(id);
    PointRank rank = entry.visible->rank(id - entry.first_id);
    rank.number += entry.first_id;
    return rank;
}

const PixelRect& VisibleSurfaces::crop() {
    buffer_.crop();
    return buffer_.area();
}

void VisibleSurfaces::resolve(const Frame& frame, SurfaceWriter& writer) const {
    // Neighbours in both directions read the same texels and vertices.
    constexpr int block_width = 64, block_height = 8;
    const PixelRect& area = buffer_.area();
    parallel_chunks(size_t(area.height), size_t(block_height), [&](size_t begin, size_t end) {
        std::vector<native::VisiblePixel> run;
        run.reserve(size_t(block_width) * (end - begin));
        for (int x = 0; x < area.width; x += block_width) {
            const int width = std::min(block_width, area.width - x);
            resolve_block(frame, {area.x + x, area.y + int(begin), width, int(end - begin)}, run, writer);
        }
    });
}

void VisibleSurfaces::resolve_block(const Frame& frame, const PixelRect& block,
                                    std::vector<native::VisiblePixel>& run, SurfaceWriter& writer) const {
    const PixelRect& area = buffer_.area();
    const Entry* entry = nullptr;
    int64_t last_id = -1;  // of the entry
    run.clear();
    for (int y = block.y; y < block.y + block.height; ++y)
        for (int x = block.x; x < block.x + block.width; ++x) {
            const uint64_t found =
                buffer_.pixels()[size_t(y - area.y) * size_t(area.width) + size_t(x - area.x)];
            if (found == 0) {
                writer.put_nothing(writer.index(x, y));
                continue;
            }
            const uint32_t id = VisibilityBuffer::id_of(found);
            if (!entry || id < entry->first_id || int64_t(id) > last_id) {
                if (entry) entry->visible->resolve(frame, *entry->item, run, writer);
                run.clear();
                entry = &entry_of(id);
                last_id = entry == &items_.back() ? next_id_ - 1 : int64_t((entry + 1)->first_id) - 1;
            }
            run.push_back({x, y, id - entry->first_id, VisibilityBuffer::depth_of(found)});
        }
    if (entry) entry->visible->resolve(frame, *entry->item, run, writer);
}

}  // namespace easypbr::render
