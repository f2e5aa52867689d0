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

uint64_t VisibleSurfaces::content(uint32_t id) const {
    const Entry& entry = entry_of(id);
    return entry.visible->content(id - entry.first_id);
}

const PixelRect& VisibleSurfaces::crop() {
    buffer_.crop();
    return buffer_.area();
}

void VisibleSurfaces::resolve(const Frame& frame, SurfaceWriter& writer) const {
    const PixelRect& area = buffer_.area();
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const auto resolve_pixel = [&](uint64_t found, int x, int y) {
        const uint32_t id = VisibilityBuffer::id_of(found);
        const Entry& entry = entry_of(id);
        SurfacePixel pixel = entry.visible->at(id - entry.first_id, (x + 0.5) * step_x - 1,
                                               1 - (y + 0.5) * step_y, VisibilityBuffer::depth_of(found));
        pixel.metallic = entry.item->material.metallic;
        pixel.roughness = entry.item->material.roughness;
        pixel.kind = entry.item->kind;
        pixel.object = uint32_t(entry.item->object - frame.scene->objects.data());
        writer.put(writer.index(x, y), pixel);
    };
    parallel_for(size_t(area.height), 4, [&](size_t row) {
        const int y = area.y + int(row);
        for (int x = area.x; x < area.x + area.width; ++x) {
            const uint64_t found = buffer_.pixels()[row * size_t(area.width) + size_t(x - area.x)];
            if (found == 0)
                writer.put_nothing(writer.index(x, y));
            else
                resolve_pixel(found, x, y);
        }
    });
}

}  // namespace easypbr::render
