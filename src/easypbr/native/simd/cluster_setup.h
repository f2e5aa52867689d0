// The setup of a cluster's triangles: which of them may cover the centre of a pixel.
#pragma once

#include "easypbr/native/kernels.h"
#include "easypbr/native/simd/reductions.h"
#include "easypbr/native/simd/texels.h"

namespace easypbr::native::EASYPBR_ISA {

/// As float to int conversions of the C library do by default: to the nearest, halves to the even one.
INLINE vint nearest_int(vfloat a) {
#if defined(__AVX512F__)
    return Ints(_mm512_cvtps_epi32(a.v));
#elif defined(__AVX2__)
    return Ints(_mm256_cvtps_epi32(a.v));
#elif defined(__SSE2__)
    return Ints(_mm_cvtps_epi32(a.v));
#else
    Ints r;
    for (int k = 0; k < lanes; ++k) r[k] = int32_t(__builtin_rintf(a.v[k]));
    return r;
#endif
}

/// A bit for each lane.
INLINE unsigned lane_bits(vbool a) {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(__m512i(a.v), __m512i(a.v));
#elif defined(__AVX2__)
    return unsigned(_mm256_movemask_ps(__m256(a.v)));
#elif defined(__SSE2__)
    return unsigned(_mm_movemask_ps(__m128(a.v)));
#else
    unsigned bits = 0;
    for (int k = 0; k < lanes; ++k) bits |= unsigned(a.v[k] & 1) << k;
    return bits;
#endif
}

/// Projects the vertices as TriangleRaster does, to the same bits. False where one has to be clipped.
inline bool project_cluster(const ClusterFaces& c, ClusterScreen& screen) {
    const auto& m = c.clip_from_mesh;
    const float subpixels = float(1 << ClusterFaces::subpixel_bits), guard = ClusterFaces::guard_band;
    vbool inside = true;
    vint left = INT32_MAX, top = INT32_MAX, right = INT32_MIN, bottom = INT32_MIN;
    vfloat nearest = 0.0f;
    for (int first = 0; first < c.vertex_count; first += lanes) {
        const vbool beyond = lane_numbers() + first >= c.vertex_count;
        vfloat p[3];
        for (int i = 0; i < 3; ++i) p[i] = load<Floats>(c.vertices + i * c.vertex_count + first);
        const auto row = [&](int r) __attribute__((always_inline)) {
            return vfloat(m[0][r]) * p[0] + vfloat(m[1][r]) * p[1] + vfloat(m[2][r]) * p[2] + vfloat(m[3][r]);
        };
        const vfloat w = row(3), scale = vfloat(1.0f) / w;
        const vfloat x = (row(0) * scale + 1.0f) * vfloat(c.half_width),
                     y = (1.0f - row(1) * scale) * vfloat(c.half_height), depth = row(2) * scale;
        const vbool is_inside = w > 0.0f && abs(x) < guard && abs(y) < guard && depth > 0.0f && depth <= 1.0f;
        inside = inside && (is_inside || beyond);
        const vint px = nearest_int(x * subpixels), py = nearest_int(y * subpixels);
        left = min(left, select(beyond, left, px));
        right = max(right, select(beyond, right, px));
        top = min(top, select(beyond, top, py));
        bottom = max(bottom, select(beyond, bottom, py));
        nearest = max(nearest, select(beyond, nearest, depth));
        std::memcpy(screen.x + first, &px.v, sizeof px.v);
        std::memcpy(screen.y + first, &py.v, sizeof py.v);
        std::memcpy(screen.depth + first, &depth.v, sizeof depth.v);
    }
    if (any_lane(!inside)) return false;
    screen.left = least_of(left);
    screen.top = least_of(top);
    screen.right = largest_of(right);
    screen.bottom = largest_of(bottom);
    screen.nearest = largest_of(nearest);
    return true;
}

/// Lanes of bytes as numbers.
INLINE vint gather(const int32_t* from, const uint8_t* places) {
    Ints r;
    for (int k = 0; k < lanes; ++k) r[k] = from[places[k]];
    return r;
}

inline int set_up_cluster(const ClusterFaces& c, ClusterScreen& screen) {
    // Places relative to the cluster's fit into 15 bits, and areas into 31.
    constexpr int most_extent = (1 << 15) - 1;
    constexpr int bits = ClusterFaces::subpixel_bits, half = ClusterFaces::half_pixel;
    const int left = screen.left, top = screen.top;
    if (screen.right - left > most_extent || screen.bottom - top > most_extent) return -1;
    for (int first = 0; first < c.vertex_count; first += lanes) {
        const vint x = vint(load<Ints>(screen.x + first)) - left,
                   y = vint(load<Ints>(screen.y + first)) - top, both = x | y << 16;
        std::memcpy(screen.packed + first, &both.v, sizeof both.v);
    }
    int count = 0;
    const uint8_t* corners = c.corners;
    for (int first = 0; first < c.face_count; first += lanes, corners += lanes) {
        const vint a = gather(screen.packed, corners), b = gather(screen.packed, corners + c.face_count),
                   d = gather(screen.packed, corners + 2 * c.face_count);
        const vint ax = a & 0xffff, bx = b & 0xffff, dx = d & 0xffff, ay = a >> 16, by = b >> 16,
                   dy = d >> 16;
        const vint doubled = (bx - ax) * (dy - ay) - (dx - ax) * (by - ay);
        vbool kept = lane_numbers() + first < c.face_count && doubled != 0;
        if (!c.both_sides) kept = kept && (c.mirrored ? doubled > 0 : doubled < 0);
        const vint x0 = (min(min(ax, bx), dx) + (left + half - 1)) >> bits,
                   x1 = (max(max(ax, bx), dx) + (left - half)) >> bits,
                   y0 = (min(min(ay, by), dy) + (top + half - 1)) >> bits,
                   y1 = (max(max(ay, by), dy) + (top - half)) >> bits;
        kept = kept && max(x0, c.left) <= min(x1, c.right) && max(y0, c.top) <= min(y1, c.bottom);
        for (unsigned waiting = lane_bits(kept); waiting != 0; waiting &= waiting - 1)
            screen.kept[count++] = uint8_t(first + __builtin_ctz(waiting));
    }
    return count;
}

}  // namespace easypbr::native::EASYPBR_ISA
