#include "easypbr/render/raster/curve_order.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"

namespace easypbr::render {
namespace {

/// The two lower bits of each of three are free.
uint32_t every_third_bit(uint32_t v) {
    v = (v | v << 16) & 0x030000ff;
    v = (v | v << 8) & 0x0300f00f;
    v = (v | v << 4) & 0x030c30c3;
    return (v | v << 2) & 0x09249249;
}

/// Of the finite vertices.
Box3 box_of(const Array3f& V) {
    constexpr size_t grain = size_t(1) << 16;
    const auto count = size_t(V.rows());
    std::vector<Box3> boxes((count + grain - 1) / grain);
    parallel_chunks(count, grain, [&](size_t begin, size_t end) {
        Box3& box = boxes[begin / grain];
        for (size_t i = begin; i < end; ++i) {
            const Vec3 p = Eigen::Map<const Vec3>(V.data() + 3 * i);
            if (p.allFinite()) box.extend(p);
        }
    });
    Box3 all;
    for (const Box3& box : boxes) all.extend(box);
    return all.isEmpty() ? Box3(Vec3::Zero(), Vec3::Zero()) : all;
}

/// The cell of each element, by its place on the curve.
std::vector<uint32_t> places_of(const Array3f& V, size_t count,
                                const std::function<size_t(size_t)>& vertex_of) {
    constexpr int cells = 1 << 10;
    const Box3 box = box_of(V);
    const Vec3& low = box.min();
    const float scale = cells / std::max(box.sizes().maxCoeff(), std::numeric_limits<float>::min());
    std::vector<uint32_t> places(count);
    parallel_chunks(count, size_t(1) << 14, [&](size_t begin, size_t end) {
        // Vertices of neighbours may be far apart in memory: they are asked for ahead of their turn.
        constexpr size_t ahead = 24;
        for (size_t i = begin; i < end; ++i) {
            if (i + ahead < end) __builtin_prefetch(V.data() + 3 * vertex_of(i + ahead));
            const float* const p = V.data() + 3 * vertex_of(i);
            uint32_t place = 0;
            for (int k = 0; k < 3; ++k) {
                const float cell = (p[k] - low[k]) * scale;
                // What is not a number is in the first cell.
                place |= every_third_bit(cell > 0 ? uint32_t(std::min(cell, cells - 1.0f)) : 0u) << k;
            }
            places[i] = place;
        }
    });
    return places;
}

}  // namespace

std::vector<uint32_t> curve_order(const Array3f& V, size_t count,
                                  const std::function<size_t(size_t)>& vertex_of) {
    // A radix sort.
    constexpr int digit_bits = 15;
    constexpr uint32_t digits = 1u << digit_bits;
    const std::vector<uint32_t> places = places_of(V, count, vertex_of);
    std::vector<uint32_t> order(count), from(count);
    std::iota(order.begin(), order.end(), 0u);
    for (int shift = 0; shift < 30; shift += digit_bits) {
        const auto digit_of = [&](uint32_t i) { return places[i] >> shift & (digits - 1); };
        order.swap(from);
        std::vector<uint32_t> next(digits + 1, 0);
        for (const uint32_t i : from) ++next[digit_of(i) + 1];
        std::partial_sum(next.begin(), next.end(), next.begin());
        for (const uint32_t i : from) order[next[digit_of(i)]++] = i;
    }
    return order;
}

}  // namespace easypbr::render
