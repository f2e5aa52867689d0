#include "easypbr/render/primitives/surfels/software_surfels.h"

#include <algorithm>
#include <atomic>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

constexpr size_t binning_grain = 1 << 13;

SurfelTile& tile_of_thread() {
    thread_local SurfelTile tile;
    return tile;
}

/// Those of one source, in entries that are sorted.
std::span<const uint64_t> entries_of_source(std::span<const uint64_t> entries, size_t source) {
    const auto begin = std::ranges::lower_bound(entries, uint64_t(source) << 32),
               end = std::ranges::lower_bound(entries, uint64_t(source + 1) << 32);
    return {begin, end};
}

Eigen::Index surfel_of(uint64_t entry) {
    return Eigen::Index(entry & 0xffffffffu);
}

}  // namespace

void SoftwareSurfels::bin(const std::vector<SurfelSource>& sources, Vec2i frame) {
    const Vec2i tiles = tiles_of(frame);
    constexpr int tile_size = SurfelTile::size;
    const size_t tile_count = size_t(tiles.x()) * size_t(tiles.y());
    const auto for_each_tile = [&](const SurfelProjection& s, auto&& body) {
        const auto [x0, x1] = pixels_between(s.x0, s.x1, 0, tiles.x() * tile_size);
        const auto [y0, y1] = pixels_between(s.y0, s.y1, 0, tiles.y() * tile_size);
        if (x0 >= x1 || y0 >= y1) return;
        for (int ty = y0 / tile_size; ty <= (y1 - 1) / tile_size; ++ty)
            for (int tx = x0 / tile_size; tx <= (x1 - 1) / tile_size; ++tx)
                body(size_t(ty) * size_t(tiles.x()) + size_t(tx));
    };
    const auto for_each_surfel = [&](auto&& body) {
        for (size_t k = 0; k < sources.size(); ++k) {
            const DrawItem& item = *sources[k].item;
            const auto is_drawn = item.alpha == AlphaMode::mask ? drawn_vertices(item) : nullptr;
            parallel_for(size_t(item.mesh().V.rows()), binning_grain, [&](size_t i) {
                if (is_drawn && !is_drawn(i)) return;
                if (const auto s = sources[k].projector.project(Eigen::Index(i)))
                    for_each_tile(*s, [&](size_t tile) { body(tile, uint64_t(k) << 32 | i); });
            });
        }
    };
    std::vector<std::atomic<size_t>> counts(tile_count);
    for_each_surfel([&](size_t tile, uint64_t) { counts[tile].fetch_add(1, std::memory_order_relaxed); });
    first_.assign(tile_count + 1, 0);
    for (size_t i = 0; i < tile_count; ++i) {
        first_[i + 1] = first_[i] + counts[i];
        counts[i] = first_[i];
    }
    entries_.resize(first_.back());
    for_each_surfel([&](size_t tile, uint64_t entry) {
        entries_[counts[tile].fetch_add(1, std::memory_order_relaxed)] = entry;
    });
}

void SoftwareSurfels::draw_tile(const Frame& frame, const std::vector<SurfelSource>& sources,
                                std::span<const float> opaque, Vec2i place, std::span<const uint64_t> entries,
                                SurfaceWriter& writer) const {
    SurfelTile& t = tile_of_thread();
    t.place(frame.size, place);
    t.limit.fill(std::numeric_limits<float>::infinity());
    t.nearest.fill(std::numeric_limits<uint64_t>::max());
    for (auto& sum : t.sums) sum.fill(0);
    t.for_all([&](int x, int y, size_t i) {
        t.hidden[i] = axial_distance(frame, opaque[size_t(y) * size_t(frame.size.x()) + size_t(x)]);
    });
    for (const uint64_t entry : entries) {
        const auto s = sources[entry >> 32].projector.project(surfel_of(entry));
        t.for_covered(*s, [&](size_t i, const SurfelProjection::Hit& hit) {
            const float pushed = hit.z + s->band;
            if (hit.z > t.hidden[i] || pushed > t.limit[i] || (pushed == t.limit[i] && entry > t.nearest[i]))
                return;
            t.limit[i] = pushed;
            t.nearest[i] = entry;
        });
    }
    for (const uint64_t entry : entries)
        t.add<false>(sources[entry >> 32], surfel_of(entry), [&](size_t i, const SurfelProjection::Hit& hit) {
            return hit.z <= t.hidden[i] && hit.z <= t.limit[i];
        });
    t.for_all([&](int x, int y, size_t i) {
        if (t.sums[i][SurfelTile::weight] == 0) return;
        SurfacePixel pixel = t.mean(frame, *sources[t.nearest[i] >> 32].item, i);
        pixel.element = uint32_t(t.nearest[i]);
        // The mean may lie behind what hides some of the surfels.
        const size_t to = writer.index(x, y);
        if (pixel.depth > writer.depth(to)) writer.put(to, pixel);
    });
}

void SoftwareSurfels::draw(const Frame& frame, const std::vector<SurfelSource>& sources,
                           std::span<const float> opaque, SurfaceWriter& writer) {
    bin(sources, frame.size);
    const int columns = tiles_of(frame.size).x();
    parallel_for(first_.size() - 1, 1, [&](size_t tile) {
        draw_tile(frame, sources, opaque, Vec2i(int(tile) % columns, int(tile) / columns), entries_of(tile),
                  writer);
    });
}

void SoftwareSurfels::begin_layers(const Frame& frame, const std::vector<SurfelSource>& sources,
                                   std::span<const float> opaque) {
    bin(sources, frame.size);
    parallel_for(first_.size() - 1, 1, [&](size_t tile) {
        std::sort(entries_.begin() + long(first_[tile]), entries_.begin() + long(first_[tile + 1]));
    });
    std::vector<float> distances(opaque.size());
    std::ranges::transform(opaque, distances.begin(),
                           [&](float depth) { return axial_distance(frame, depth); });
    ends_.assign(sources.size(), distances);
}

bool SoftwareSurfels::add_layer(const Frame& frame, const std::vector<SurfelSource>& sources, Vec2i place,
                                std::span<const uint64_t> entries, PeelLimits& limits,
                                SurfaceWriter& writer) {
    constexpr int nobody = -1;
    const PixelRect& area = frame.covered;
    const auto is_inside = [&](int x, int y) {
        return x >= area.x && x < area.x + area.width && y >= area.y && y < area.y + area.height;
    };
    const auto in_area = [&](int x, int y) {
        return size_t(y - area.y) * size_t(area.width) + size_t(x - area.x);
    };
    const float near = float(frame.camera.near);
    SurfelTile& t = tile_of_thread();
    t.place(frame.size, place);
    std::array<int, SurfelTile::most_pixels> owner;
    std::array<float, SurfelTile::most_pixels> end;
    owner.fill(nobody);
    for (size_t k = 0; k < sources.size(); ++k) {
        const std::span<const uint64_t> own = entries_of_source(entries, k);
        if (own.empty()) continue;
        t.limit.fill(limits.farthest ? 0 : std::numeric_limits<float>::infinity());
        for (auto& sum : t.sums) sum.fill(0);
        t.for_all(
            [&](int x, int y, size_t i) { t.hidden[i] = is_inside(x, y) ? ends_[k][in_area(x, y)] : 0; });
        for (const uint64_t entry : own) {
            const auto s = sources[k].projector.project(surfel_of(entry));
            t.for_covered(*s, [&](size_t i, const SurfelProjection::Hit& hit) {
                float& limit = t.limit[i];
                if (hit.z >= t.hidden[i]) return;
                // Before the near plane all bands end alike.
                limit = limits.farthest ? std::max(limit, std::max(hit.z - s->band, near))
                                        : std::min(limit, hit.z + s->band);
            });
        }
        for (const uint64_t entry : own)
            t.add<true>(sources[k], surfel_of(entry), [&](size_t i, const SurfelProjection::Hit& hit) {
                const bool in_band = limits.farthest ? hit.z >= t.limit[i] : hit.z <= t.limit[i];
                return hit.z < t.hidden[i] && in_band;
            });
        t.for_all([&](int x, int y, size_t i) {
            if (t.sums[i][SurfelTile::weight] == 0) return;
            const SurfacePixel pixel = t.mean(frame, *sources[k].item, i);
            const size_t to = writer.index(x, y);
            const float held = writer.depth(to);
            if (held != 0 && (limits.farthest ? pixel.depth >= held : pixel.depth <= held)) return;
            writer.put(to, pixel);
            owner[i] = int(k);
            end[i] = t.limit[i];
        });
    }
    bool any = false;
    t.for_all([&](int x, int y, size_t i) {
        if (owner[i] == nobody) return;
        any = true;
        ends_[size_t(owner[i])][in_area(x, y)] = end[i];
        limits.depths[in_area(x, y)] = writer.depth(writer.index(x, y));
    });
    return any;
}

bool SoftwareSurfels::add_layer(const Frame& frame, const std::vector<SurfelSource>& sources,
                                PeelLimits& limits, SurfaceWriter& writer) {
    const int columns = tiles_of(frame.size).x();
    std::atomic<bool> any = false;
    parallel_for(first_.size() - 1, 1, [&](size_t tile) {
        const std::span<const uint64_t> entries = entries_of(tile);
        const Vec2i place(int(tile) % columns, int(tile) / columns);
        if (!entries.empty() && add_layer(frame, sources, place, entries, limits, writer)) any = true;
    });
    return any;
}

}  // namespace easypbr::render
