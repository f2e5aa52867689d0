// The setup of a batch of points: where they are on the screen, and which of them are inside.
#pragma once

#include "easypbr/native/simd/cluster_setup.h"

namespace easypbr::native::EASYPBR_ISA {

/// The bits of the depths that are seen at pixels, where `asked`; any elsewhere. Each is read at once: others
/// may write meanwhile.
INLINE vint seen_at(const uint64_t* pixels, vint index, vbool asked) {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
#if defined(__AVX512F__)
    const auto* depths = reinterpret_cast<const int*>(pixels) + 1;
    const __mmask16 mask = _mm512_test_epi32_mask(__m512i(asked.v), __m512i(asked.v));
    return Ints(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), mask, __m512i(index.v), depths, 8));
#elif defined(__AVX2__)
    const auto* depths = reinterpret_cast<const int*>(pixels) + 1;
    return Ints(
        _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), depths, __m256i(index.v), __m256i(asked.v), 8));
#else
    index = select(asked, index, vint(0));
    Ints r;
    for (int k = 0; k < lanes; ++k)
        r[k] = int32_t(__atomic_load_n(pixels + index.v[k], __ATOMIC_RELAXED) >> 32);
    return r;
#endif
}

/// Sets the pixels of two columns and lines that splats of less than 2 pixels cover, as PointRaster::cover()
/// finds them, without those that nearer ones are seen in. Returns false where none is left.
INLINE vbool set_covered(const PointBatch& b, const vec2& at, vfloat radius, vfloat depth, vbool kept,
                         int first, PointScreen& screen) {
    const vbool is_tiny = radius <= 0.5f;
    const vint own_x = to_int(floor(at.x)), own_y = to_int(floor(at.y));
    const vint x0 = select(is_tiny, own_x, to_int(ceil(at.x - radius - 0.5f))),
               x1 = select(is_tiny, own_x, to_int(floor(at.x + radius - 0.5f))),
               y0 = select(is_tiny, own_y, to_int(ceil(at.y - radius - 0.5f))),
               y1 = select(is_tiny, own_y, to_int(floor(at.y + radius - 0.5f)));
    const vint left = int(b.left), right = int(b.right), top = int(b.top), bottom = int(b.bottom);
    const vbool is_small = vbool(b.y_per_x == 1.0f) && radius < 1.0f;
    const vint width = right - left, bits = Ints(depth.v);
    vint covered = 0;
    for (int i = 0; i < 4; ++i) {
        const vint x = x0 + (i & 1), y = y0 + (i >> 1);
        const vfloat dx = to_float(x) + 0.5f - at.x, dy = to_float(y) + 0.5f - at.y;
        const vbool within = dx * dx + dy * dy <= radius * radius, own = x == own_x && y == own_y;
        vbool is_covered = kept && is_small && x <= x1 && y <= y1 && (vbool(!b.round) || within || own) &&
                           x >= left && x < right && y >= top && y < bottom;
        if (b.seen && any_lane(is_covered))
            is_covered = is_covered && seen_at(b.seen, (y - top) * width + x - left, is_covered) <= bits;
        covered |= select(is_covered, 1 << i, 0);
    }
    covered = select(is_small, covered, vint(-1));
    std::memcpy(screen.column + first, &x0.v, sizeof x0.v);
    std::memcpy(screen.line + first, &y0.v, sizeof y0.v);
    std::memcpy(screen.covered + first, &covered.v, sizeof covered.v);
    return covered != 0;
}

/// As PointRaster::project() does, to the same bits.
inline int set_up_points(const PointBatch& b, PointScreen& screen) {
    const auto& m = b.clip_from_mesh;
    int count = 0;
    for (int first = 0; first < b.count; first += lanes) {
        vfloat p[3];
        for (int i = 0; i < 3; ++i) p[i] = load<Floats>(b.points + i * b.count + first);
        const auto row = [&](int r) __attribute__((always_inline)) {
            return vfloat(m[0][r]) * p[0] + vfloat(m[1][r]) * p[1] + vfloat(m[2][r]) * p[2] + vfloat(m[3][r]);
        };
        const vfloat w = row(3), scale = vfloat(1.0f) / w, depth = row(2) * scale;
        const vfloat diameter =
            b.world_pixels > 0 ? max(b.world_pixels * scale, vfloat(b.least_pixels)) : vfloat(b.pixels);
        const vfloat rx = 0.5f * diameter, ry = rx * b.y_per_x;
        const vfloat x = (row(0) * scale + 1.0f) * b.half_width, y = (1.0f - row(1) * scale) * b.half_height;
        const vbool kept = lane_numbers() + first < b.count && w > 0.0f && depth > 0.0f && depth <= 1.0f &&
                           x + rx >= b.left && x - rx < b.right && y + ry >= b.top && y - ry < b.bottom;
        std::memcpy(screen.x + first, &x.v, sizeof x.v);
        std::memcpy(screen.y + first, &y.v, sizeof y.v);
        std::memcpy(screen.radius + first, &rx.v, sizeof rx.v);
        std::memcpy(screen.depth + first, &depth.v, sizeof depth.v);
        const vbool is_seen = kept && set_covered(b, {x, y}, rx, depth, kept, first, screen);
        for (unsigned waiting = lane_bits(is_seen); waiting != 0; waiting &= waiting - 1)
            screen.kept[count++] = uint16_t(first + __builtin_ctz(waiting));
    }
    return count;
}

}  // namespace easypbr::native::EASYPBR_ISA
