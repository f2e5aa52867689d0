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
    parallel_chunks(size_t(area.height), 4, [&](size_t begin, size_t end) {
        std::vector<native::VisiblePixel> run;
        run.reserve(size_t(area.width));
        for (size_t row = begin; row < end; ++row) resolve_row(frame, area.y + int(row), run, writer);
    });
}

void VisibleSurfaces::resolve_row(const Frame& frame, int y, std::vector<native::VisiblePixel>& run,
                                  SurfaceWriter& writer) const {
    const PixelRect& area = buffer_.area();
    const auto row = buffer_.pixels().subspan(size_t(y - area.y) * size_t(area.width), size_t(area.width));
    const Entry* entry = nullptr;
    int64_t last_id = -1;  // of the entry
    run.clear();
    for (int x = area.x; x < area.x + area.width; ++x) {
        const uint64_t found = row[size_t(x - area.x)];
        if (found == 0) {
            writer.put_nothing(writer.index(x, y));
            continue;
        }
        const uint32_t id = VisibilityBuffer::id_of(found);
        if (!entry || id < entry->first_id || int64_t(id) > last_id) {
            if (entry) resolve_run(frame, *entry, run, y, writer);
            run.clear();
            entry = &entry_of(id);
            last_id = entry == &items_.back() ? next_id_ - 1 : int64_t((entry + 1)->first_id) - 1;
        }
        run.push_back({x, id - entry->first_id});
    }
    if (entry) resolve_run(frame, *entry, run, y, writer);
}

void VisibleSurfaces::resolve_run(const Frame& frame, const Entry& entry,
                                  std::span<const native::VisiblePixel> run, int y,
                                  SurfaceWriter& writer) const {
    if (entry.visible->resolve(frame, *entry.item, run, y, writer)) return;
    const double step_x = 2.0 / frame.size.x(), step_y = 2.0 / frame.size.y();
    const PixelRect& area = buffer_.area();
    for (const native::VisiblePixel& p : run) {
        const uint64_t found =
            buffer_.pixels()[size_t(y - area.y) * size_t(area.width) + size_t(p.x - area.x)];
        SurfacePixel pixel = entry.visible->at(p.face, (p.x + 0.5) * step_x - 1, 1 - (y + 0.5) * step_y,
                                               VisibilityBuffer::depth_of(found));
        pixel.metallic = entry.item->material.metallic;
        pixel.roughness = entry.item->material.roughness;
        pixel.kind = entry.item->kind;
        pixel.object = uint32_t(entry.item->object - frame.scene->objects.data());
        writer.put(writer.index(p.x, y), pixel);
    }
}

}  // namespace easypbr::render
