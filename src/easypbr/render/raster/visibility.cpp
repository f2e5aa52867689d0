#include "easypbr/render/raster/visibility.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

namespace {

constexpr size_t point_grain = 1 << 12;

template <class Key>
void fill(PooledVector<Key>& pixels, size_t count, Key key) {
    pixels.resize(count);
    parallel_chunks(count, size_t(1) << 16, [&](size_t begin, size_t end) {
        std::fill(pixels.begin() + long(begin), pixels.begin() + long(end), key);
    });
}

/// A pixel while others are drawn.
template <class Key>
Key load_relaxed(Key& pixel) {
    return std::atomic_ref<Key>(pixel).load(std::memory_order_relaxed);
}

/// Keeps the larger of a pixel and a key; any order of calls gives the same.
template <class Key>
[[gnu::always_inline]] inline void raise(Key& pixel, Key key) {
    const std::atomic_ref<Key> cell(pixel);
    Key seen = cell.load(std::memory_order_relaxed);
    while (key > seen && !cell.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
}

/// The same for points of a depth that is kept already, or is about to be: of equal depths the rank decides.
void replace_point(uint64_t& pixel, uint64_t key, const std::function<PointRank(uint32_t)>& rank) {
    const std::atomic_ref<uint64_t> cell(pixel);
    uint64_t seen = cell.load(std::memory_order_relaxed);
    for (;;) {
        if (seen >> 32 > key >> 32) return;
        if (seen >> 32 == key >> 32) {
            const PointRank mine = rank(VisibilityBuffer::id_of(key)),
                            other = rank(VisibilityBuffer::id_of(seen));
            if (other.content > mine.content) return;
            if (other.content == mine.content && other.number <= mine.number) return;
        }
        if (cell.compare_exchange_weak(seen, key, std::memory_order_relaxed)) return;
    }
}
inline void raise_point(uint64_t& pixel, uint64_t key, const std::function<PointRank(uint32_t)>& rank) {
    const uint64_t seen = load_relaxed(pixel);
    if (seen >> 32 <= key >> 32) replace_point(pixel, key, rank);
}

/// The limit of a pixel of which no layer is left: nothing is as near.
constexpr float finished = 2;

/// Which of the triangles of a pixel is kept: the one with the largest key.
struct KeyOrder {
    const float* limits = nullptr;  ///< of each pixel: what is not nearer is left out
    bool behind = false;            ///< what is not farther is left out instead, and all where nothing is
    uint32_t flipped = 0;           ///< bits of the depth

    explicit KeyOrder(const PeelLimits* layer) {
        if (!layer) return;
        limits = layer->depths.data();
        behind = layer->backs;
        if (layer->farthest && !behind) flipped = ~0u;
    }
    bool takes(size_t pixel, float depth) const {
        if (!limits) return true;
        const float limit = limits[pixel];
        return behind ? depth < limit && limit < finished : depth > limit;
    }
    uint64_t key(float depth, uint32_t id) const {
        return uint64_t(std::bit_cast<uint32_t>(depth) ^ flipped) << 32 | uint32_t(~id);
    }
};

/// Puts the pixels that pass a test, many at once.
class TestedPixels {
  public:
    TestedPixels(const KeyOrder& order, const AlphaTest& test, PooledVector<uint64_t>& pixels,
                 const PixelRect& area, uint32_t first_id)
        : order_(order), test_(test), pixels_(pixels), area_(area), first_id_(first_id) {}
    /// A copy begins with nothing.
    TestedPixels(const TestedPixels& other)
        : TestedPixels(other.order_, other.test_, other.pixels_, other.area_, other.first_id_) {}
    TestedPixels& operator=(const TestedPixels&) = delete;
    ~TestedPixels() { flush(); }

    void operator()(size_t pixel, float depth, uint32_t face) {
        const uint64_t seen = load_relaxed(pixels_[pixel]);
        if (!order_.takes(pixel, depth) || order_.key(depth, 0) >> 32 < seen >> 32) return;
        const int row = int(pixel / size_t(area_.width)), column = int(pixel % size_t(area_.width));
        waiting_[count_] = {area_.x + column, area_.y + row, face, depth};
        places_[count_] = pixel;
        if (++count_ == most) flush();
    }

  private:
    static constexpr size_t most = 256;

    void flush() {
        std::array<float, most> alpha;
        test_.alpha({waiting_.data(), count_}, {alpha.data(), count_});
        for (size_t i = 0; i < count_; ++i)
            if (alpha[i] >= test_.cutoff)
                raise(pixels_[places_[i]], order_.key(waiting_[i].depth, first_id_ + waiting_[i].face));
        count_ = 0;
    }

    const KeyOrder order_;
    const AlphaTest& test_;
    PooledVector<uint64_t>& pixels_;
    const PixelRect& area_;
    uint32_t first_id_;
    std::array<native::VisiblePixel, most> waiting_;
    std::array<size_t, most> places_;
    size_t count_ = 0;
};

}  // namespace

void VisibilityBuffer::clear(Vec2i size, const PixelRect& area) {
    raster_.set_area(size, area);
    hierarchy_.clear(area);
    fill(pixels_, size_t(area.width) * size_t(area.height), uint64_t(0));
    limits_ = nullptr;
}

void VisibilityBuffer::begin_layer(const PeelLimits& limits) {
    limits_ = &limits;
}

void VisibilityBuffer::end_layer(PeelLimits& limits) {
    const uint64_t flipped = uint64_t(KeyOrder(limits_).flipped) << 32;
    parallel_for(pixels_.size(), size_t(1) << 14, [&](size_t i) {
        if (pixels_[i] != 0) pixels_[i] ^= flipped;
        limits.depths[i] = pixels_[i] != 0 ? depth_of(pixels_[i]) : finished;
    });
    limits_ = nullptr;
}

bool VisibilityBuffer::draw(const ScreenTriangles& triangles, uint32_t first_id, const AlphaTest* test) {
    const KeyOrder order(limits_);
    if (test)
        return raster_.draw(triangles, TestedPixels(order, *test, pixels_, raster_.area(), first_id), *this);
    if (limits_)
        return raster_.draw(triangles, [&](size_t pixel, float depth, uint32_t face) {
            if (order.takes(pixel, depth)) raise(pixels_[pixel], order.key(depth, first_id + face));
        });
    const auto put = [&](size_t pixel, float depth, uint32_t face) {
        raise(pixels_[pixel], uint64_t(std::bit_cast<uint32_t>(depth)) << 32 | uint32_t(~(first_id + face)));
    };
    return raster_.draw(triangles, put, *this);
}

bool VisibilityBuffer::hides(const ScreenBounds& bounds) {
    if (limits_) return bounds.empty();
    return hierarchy_.hides(bounds, [&](size_t pixel) { return depth_of(load_relaxed(pixels_[pixel])); });
}

void DepthBuffer::clear(Vec2i size, float nothing) {
    raster_.set_area(size, {0, 0, size.x(), size.y()});
    hierarchy_.clear(raster_.area());
    fill(pixels_, size_t(size.x()) * size_t(size.y()), std::bit_cast<int32_t>(nothing));
}

bool DepthBuffer::draw(const ScreenTriangles& triangles) {
    const auto put = [&](size_t pixel, float depth, uint32_t) {
        raise(pixels_[pixel], std::bit_cast<int32_t>(depth));
    };
    return raster_.draw(triangles, put, *this);
}

bool DepthBuffer::hides(const ScreenBounds& bounds) {
    return hierarchy_.hides(bounds,
                            [&](size_t pixel) { return std::bit_cast<float>(load_relaxed(pixels_[pixel])); });
}

void DepthBuffer::put(size_t pixel, float depth) {
    raise(pixels_[pixel], std::bit_cast<int32_t>(depth));
}

void DepthBuffer::add(const VisibilityBuffer& other) {
    parallel_for(pixels_.size(), size_t(1) << 14, [&](size_t i) {
        if (const uint64_t pixel = other.pixels()[i]; pixel != 0)
            pixels_[i] = std::max(pixels_[i], std::bit_cast<int32_t>(VisibilityBuffer::depth_of(pixel)));
    });
}

bool cover(TriangleRaster& raster, const ScreenTriangles& triangles, std::span<uint8_t> covered) {
    return raster.draw(triangles, [&](size_t pixel, float, uint32_t) {
        std::atomic_ref<uint8_t>(covered[pixel]).store(1, std::memory_order_relaxed);
    });
}

void VisibilityBuffer::draw_points(const Array3f& V, const PointSplats& splats, uint32_t first_id,
                                   const std::function<PointRank(uint32_t id)>& rank) {
    const KeyOrder order(limits_);
    const PixelRect& area = raster_.area();
    const PointRaster raster(splats, raster_.size(), area);
    const auto draw = [&](float depth, uint32_t i, const auto& cover) {
        if (splats.is_drawn && !splats.is_drawn(splats.batches ? splats.batches->vertex_of(i) : i)) return;
        const uint64_t key = order.key(depth, first_id + i);
        cover([&](int column, int line) {
            const size_t pixel = size_t(line - area.y) * size_t(area.width) + size_t(column - area.x);
            if (order.takes(pixel, depth)) raise_point(pixels_[pixel], key, rank);
        });
    };
    if (splats.batches)
        return raster.draw_batches(*splats.batches, draw, *this, limits_ ? nullptr : pixels_.data());
    parallel_for(size_t(V.rows()), point_grain, [&](size_t i) {
        const ScreenPoint point = raster.project(V.data() + 3 * i);
        if (point.depth > 0)
            draw(point.depth, uint32_t(i), [&](const auto& put) { raster.cover(point, area, put); });
    });
}

void VisibilityBuffer::crop() {
    const PixelRect area = raster_.area();
    int x0 = area.width, x1 = -1, y0 = area.height, y1 = -1;
    for (int y = 0; y < area.height; ++y) {
        const auto row = pixels().subspan(size_t(y) * size_t(area.width), size_t(area.width));
        const auto is_covered = [](uint64_t pixel) { return pixel != 0; };
        const auto first = std::ranges::find_if(row, is_covered);
        if (first == row.end()) continue;
        const auto last = std::find_if(row.rbegin(), row.rend(), is_covered);
        x0 = std::min(x0, int(first - row.begin()));
        x1 = std::max(x1, area.width - 1 - int(last - row.rbegin()));
        y0 = std::min(y0, y);
        y1 = y;
    }
    const PixelRect kept{area.x + x0, area.y + y0, std::max(0, x1 - x0 + 1), std::max(0, y1 - y0 + 1)};
    for (int y = 0; y < kept.height; ++y) {
        const auto from = pixels_.begin() + (long(y0 + y) * area.width + x0);
        std::copy(from, from + kept.width, pixels_.begin() + long(y) * kept.width);
    }
    const PixelRect left = kept.width > 0 ? kept : PixelRect{};
    raster_.set_area(raster_.size(), left);
    hierarchy_.clear(left);
    pixels_.resize(size_t(left.width) * size_t(left.height));
}

}  // namespace easypbr::render
