#include "easypbr/render/primitives/surfels/software_surfels.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <span>

#include "easypbr/core/parallel.h"
#include "easypbr/render/primitives/vertex_alpha.h"

namespace easypbr::render {
namespace {

constexpr size_t binning_grain = 1 << 13;

/// What is of a thread itself takes room on the stack of every thread.
SurfelTile& tile_of_thread() {
    thread_local const auto tile = std::make_unique<SurfelTile>();
    return *tile;
}

/// Those of one source, in entries that are sorted.
std::span<const uint64_t> entries_of_source(std::span<const uint64_t> entries, size_t source) {
    const auto begin = std::ranges::lower_bound(entries, uint64_t(source) << 32),
               end = std::ranges::lower_bound(entries, uint64_t(source + 1) << 32);
    return {begin, end};
}

/// Of an entry; null where its item shows none.
const float* color_of(const std::vector<SurfelSource>& sources, uint64_t entry) {
    const SurfelSource& source = sources[source_of(entry)];
    if (!source.item->with_colors) return nullptr;
    const auto& C = source.item->mesh().C;
    return C.data() + source.projector.vertex_of(surfel_of(entry)) * size_t(C.cols());
}

/// An entry with the vertex in the surfel's place: the same whether there are batches or not.
uint64_t vertex_entry(const std::vector<SurfelSource>& sources, uint64_t entry) {
    const size_t source = source_of(entry);
    return uint64_t(source) << 32 | sources[source].projector.vertex_of(surfel_of(entry));
}

}  // namespace

namespace {

/// Tiles of the frame that a surfel reaches into: from the first up to the ends.
struct TileRange {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;

    TileRange(const SurfelProjection& s, Vec2i tiles) {
        constexpr int size = SurfelTile::size;
        const auto [left, right] = pixels_between(s.x0, s.x1, 0, tiles.x() * size);
        const auto [top, bottom] = pixels_between(s.y0, s.y1, 0, tiles.y() * size);
        if (left >= right || top >= bottom) return;
        x0 = left / size;
        x1 = (right - 1) / size + 1;
        y0 = top / size;
        y1 = (bottom - 1) / size + 1;
    }
    int count() const { return (x1 - x0) * (y1 - y0); }
};

/// In place of a tile's number: none, and more than one.
constexpr uint32_t no_tile = UINT32_MAX, several_tiles = UINT32_MAX - 1;

}  // namespace

void SoftwareSurfels::bin(const std::vector<SurfelSource>& sources, Vec2i frame) {
    const Vec2i tiles = tiles_of(frame);
    const size_t tile_count = size_t(tiles.x()) * size_t(tiles.y());
    const auto for_each_tile = [&](const TileRange& range, auto&& body) {
        for (int y = range.y0; y < range.y1; ++y)
            for (int x = range.x0; x < range.x1; ++x) body(size_t(y) * size_t(tiles.x()) + size_t(x));
    };
    std::vector<std::atomic<size_t>> counts(tile_count);
    const auto next_in = [&](size_t tile) { return counts[tile].fetch_add(1, std::memory_order_relaxed); };
    std::vector<std::vector<uint32_t>> tile_of(sources.size());
    size_t all = 0;
    for (const SurfelSource& source : sources) all += size_t(source.item->mesh().V.rows());
    kept_.resize(all <= most_kept ? sources.size() : 0);
    const bool keeps = !kept_.empty();
    for (size_t k = 0; k < sources.size(); ++k) {
        const DrawItem& item = *sources[k].item;
        const auto is_drawn = item.alpha == AlphaMode::mask ? drawn_vertices(item) : nullptr;
        tile_of[k].assign(size_t(item.mesh().V.rows()), no_tile);
        if (keeps) kept_[k].resize(tile_of[k].size());
        const SurfelProjector& projector = sources[k].projector;
        projector.project_all([&](size_t i, const SurfelProjection& s) {
            if (is_drawn && !is_drawn(projector.vertex_of(i))) return;
            if (keeps) kept_[k][i] = s;
            const TileRange range(s, tiles);
            for_each_tile(range, [&](size_t tile) {
                next_in(tile);
                tile_of[k][i] = range.count() == 1 ? uint32_t(tile) : several_tiles;
            });
        });
    }
    first_.assign(tile_count + 1, 0);
    for (size_t i = 0; i < tile_count; ++i) {
        first_[i + 1] = first_[i] + counts[i];
        counts[i] = first_[i];
    }
    entries_.resize(first_.back());
    for (size_t k = 0; k < sources.size(); ++k)
        parallel_for(tile_of[k].size(), binning_grain, [&](size_t i) {
            const uint32_t tile = tile_of[k][i];
            const uint64_t entry = uint64_t(k) << 32 | i;
            if (tile == no_tile) return;
            if (tile != several_tiles)
                entries_[next_in(tile)] = entry;
            else
                for_each_tile(TileRange(keeps ? kept_[k][i] : *sources[k].projector.project(i), tiles),
                              [&](size_t several) { entries_[next_in(several)] = entry; });
        });
}

void SoftwareSurfels::draw_tile(const Frame& frame, const std::vector<SurfelSource>& sources,
                                std::span<const float> opaque, bool nearest_alone, Vec2i place,
                                std::span<const uint64_t> entries, SurfaceWriter& writer) const {
    if (entries.empty()) return;
    SurfelTile& t = tile_of_thread();
    t.place(frame.size, place);
    t.limit.fill(std::numeric_limits<float>::infinity());
    t.nearest.fill(std::numeric_limits<uint64_t>::max());
    t.is_empty.fill(true);
    t.for_all([&](int x, int y, size_t i) {
        t.hidden[i] = axial_distance(frame, opaque[size_t(y) * size_t(frame.size.x()) + size_t(x)]);
    });
    t.project(sources, entries, kept_);
    // What lies behind the limits so far lies behind the last ones, which are nearer.
    std::vector<uint32_t>& seen = t.seen;
    seen.clear();
    for (size_t k = 0; k < entries.size(); ++k) {
        const uint64_t vertex = vertex_entry(sources, entries[k]);
        const SurfelProjection& s = t.projections[k];
        bool may_be_seen = false;
        t.for_covered(s, [&](size_t i, const SurfelProjection::Hit& hit) {
            const float pushed = nearest_alone ? hit.z : hit.z + s.band;
            if (hit.z > t.hidden[i]) return;
            may_be_seen |= hit.z <= t.limit[i];
            if (pushed > t.limit[i] || (pushed == t.limit[i] && vertex > t.nearest[i])) return;
            t.limit[i] = pushed;
            t.nearest[i] = vertex;
        });
        if (may_be_seen) seen.push_back(uint32_t(k));
    }
    for (size_t n = 0; n < seen.size(); ++n) {
        if (n + SurfelTile::ahead < seen.size())
            __builtin_prefetch(color_of(sources, entries[seen[n + SurfelTile::ahead]]));
        const uint32_t k = seen[n];
        const uint64_t vertex = vertex_entry(sources, entries[k]);
        t.add<false>(sources[source_of(entries[k])], surfel_of(entries[k]), t.projections[k],
                     [&](size_t i, const SurfelProjection::Hit& hit) {
                         return hit.z <= t.hidden[i] && hit.z <= t.limit[i] &&
                                (!nearest_alone || vertex == t.nearest[i]);
                     });
    }
    t.for_all([&](int x, int y, size_t i) {
        if (t.is_empty[i]) return;
        SurfacePixel pixel = t.mean(frame, *sources[source_of(t.nearest[i])].item, i);
        pixel.element = uint32_t(t.nearest[i]);
        // The mean may lie behind what hides some of the surfels.
        const size_t to = writer.index(x, y);
        if (pixel.depth > writer.depth(to)) writer.put(to, pixel);
    });
}

void SoftwareSurfels::draw(const Frame& frame, const std::vector<SurfelSource>& sources,
                           std::span<const float> opaque, bool nearest_alone, SurfaceWriter& writer) {
    bin(sources, frame.size);
    const int columns = tiles_of(frame.size).x();
    parallel_for(first_.size() - 1, 1, [&](size_t tile) {
        draw_tile(frame, sources, opaque, nearest_alone, Vec2i(int(tile) % columns, int(tile) / columns),
                  entries_of(tile), writer);
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
        t.is_empty.fill(true);
        t.for_all(
            [&](int x, int y, size_t i) { t.hidden[i] = is_inside(x, y) ? ends_[k][in_area(x, y)] : 0; });
        t.project(sources, own, kept_);
        for (const SurfelProjection& s : t.projections)
            t.for_covered(s, [&](size_t i, const SurfelProjection::Hit& hit) {
                float& limit = t.limit[i];
                if (hit.z >= t.hidden[i]) return;
                // Before the near plane all bands end alike.
                limit = limits.farthest ? std::max(limit, std::max(hit.z - s.band, near))
                                        : std::min(limit, hit.z + s.band);
            });
        for (size_t n = 0; n < own.size(); ++n)
            t.add<true>(sources[k], surfel_of(own[n]), t.projections[n],
                        [&](size_t i, const SurfelProjection::Hit& hit) {
                            const bool in_band = limits.farthest ? hit.z >= t.limit[i] : hit.z <= t.limit[i];
                            return hit.z < t.hidden[i] && in_band;
                        });
        t.for_all([&](int x, int y, size_t i) {
            if (t.is_empty[i]) return;
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
