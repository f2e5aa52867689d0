// Lines of a band of rows: of each stroke one segment a pixel, and strokes over each other by their depths.
// Included after the shaders.
#pragma once

#include "easypbr/native/simd/packing.h"

namespace easypbr::native::EASYPBR_ISA {

/// The pixels of a row that a line may cover.
struct Span {
    float low, high;

    /// Leaves those where slope * x + value lies between two numbers.
    INLINE void narrow(float slope, float value, float least, float most) {
        if (slope < 1e-6f && slope > -1e-6f) {
            if (value < least || value > most) high = low - 1;
            return;
        }
        const float a = (least - value) / slope, b = (most - value) / slope;
        low = low > (a < b ? a : b) ? low : (a < b ? a : b);
        high = high < (a < b ? b : a) ? high : (a < b ? b : a);
    }
};

INLINE Span span_of(const ScreenLine& l, float reach, int y, const Region& region) {
    Span span{float(region.x0), float(region.x1 - 1)};
    const float dx = 0.5f - l.start[0], dy = float(y) + 0.5f - l.start[1];
    span.narrow(-l.along[1], dy * l.along[0] - dx * l.along[1], -reach, reach);
    span.narrow(l.along[0], dx * l.along[0] + dy * l.along[1], -reach, l.length + reach);
    return span;
}

INLINE void keep_nearest(const Region& region, int x, int y, vfloat depth, vbool written) {
    const size_t at = size_t(y - region.y) * size_t(region.width) + size_t(x - region.x);
    for (int k = 0; k < lanes; ++k) {
        std::byte* p = region.outputs[0].data + 4 * (at + size_t(k));
        const float nearest = depth.v[k];
        if (written.v[k] && nearest > load<float>(p)) std::memcpy(p, &nearest, sizeof nearest);
    }
}

/// A colour and a depth for each pixel of a band of rows, an array for each number.
struct LinePixels {
    float *color[4], *depth;
    int x0, y0;
    size_t row;

    INLINE size_t at(int x, int y) const { return size_t(y - y0) * row + size_t(x - x0); }
    INLINE vec4 color_at(size_t at) const {
        return {load_lanes(color[0], at), load_lanes(color[1], at), load_lanes(color[2], at),
                load_lanes(color[3], at)};
    }
    INLINE void store(size_t at, const vec4& c, vfloat d) const {
        store_lanes(color[0], at, c.x);
        store_lanes(color[1], at, c.y);
        store_lanes(color[2], at, c.z);
        store_lanes(color[3], at, c.w);
        store_lanes(depth, at, d);
    }
};

/// What lines of a band are gathered in.
struct LineBand {
    LinePixels stroke;  ///< defined where the rank is above 0
    float* rank;        ///< of `stroke`; 0 beyond the columns from `first` to `past`
    int first = 0, past = 0;
    LinePixels others;  ///< the strokes before it; defined where the depth is above 0

    LineBand(const Region& region, int y0, int y1, float* work) {
        const size_t row = size_t(region.x1 - region.x0) + size_t(stream_alignment),
                     size = size_t(y1 - y0) * row;
        for (LinePixels* pixels : {&stroke, &others}) {
            for (float*& channel : pixels->color) {
                channel = work;
                work += size;
            }
            pixels->depth = work;
            work += size;
            pixels->x0 = region.x0;
            pixels->y0 = y0;
            pixels->row = row;
        }
        rank = work;
    }
    INLINE void clear(float* numbers, int rows) const {
        std::memset(numbers, 0, size_t(rows) * stroke.row * sizeof(float));
    }
    /// Keeps those pixels whose rank is higher than what is there.
    INLINE void keep(const overlay_lines& s, int x, int y) {
        const size_t at = stroke.at(x, y);
        const vfloat before = load_lanes(rank, at);
        const vbool higher = s.written && s.gl_FragDepth > before;
        if (!any_lane(higher)) return;
        if (first == past) first = past = x;
        first = x < first ? x : first;
        past = x + lanes > past ? x + lanes : past;
        store_lanes(rank, at, select(higher, s.gl_FragDepth, before));
        stroke.store(at, select(higher, s.o_color, stroke.color_at(at)),
                     select(higher, s.o_depth, load_lanes(stroke.depth, at)));
    }
};

INLINE void draw_row(overlay_lines& s, const ScreenLine& l, const Region& region, int y, LineBand* to) {
    const Span span = span_of(l, s.u_half_width + 1.0f, y, region);
    if (span.high < span.low) return;
    const int last = int(__builtin_ceilf(span.high));
    for (int x = int(span.low); x <= last; x += lanes) {
        const vint column = lane_numbers() + x;
        s.written = column <= last && column < region.x1;
        s.gl_FragCoord = vec4(to_float(column) + 0.5f, float(y) + 0.5f, 0.0f, 1.0f);
        const vfloat dx = s.gl_FragCoord.x - l.start[0], dy = s.gl_FragCoord.y - l.start[1];
        s.v_place = vec2(dx * l.along[0] + dy * l.along[1], dy * l.along[0] - dx * l.along[1]);
        s.main();
        if (!any_lane(s.written)) continue;
        if (to)
            to->keep(s, x, y);
        else
            keep_nearest(region, x, y, s.gl_FragDepth, s.written);
    }
}

/// Of `to` no more than the stroke is written; null: the nearest depth is kept in the region.
INLINE void draw_stroke(overlay_lines& s, const LineStroke& stroke, const Region& region, int y0, int y1,
                        LineBand* to) {
    const float reach = s.u_half_width + 1.0f;
    for (int i = 0; i < stroke.count; ++i) {
        const ScreenLine& l = stroke.lines[stroke.chosen[i]];
        const float *a = l.start_color, *b = l.end_color;
        s.v_length = l.length;
        s.v_depths = vec2(l.depths[0], l.depths[1]);
        s.v_start_color = vec4(a[0], a[1], a[2], a[3]);
        s.v_end_color = vec4(b[0], b[1], b[2], b[3]);
        s.v_parts = vec2(l.parts[0], l.parts[1]);
        s.v_w = vec2(l.ws[0], l.ws[1]);
        s.v_table = vec3(l.places[0], l.places[1], l.row);
        s.v_dash = vec2(l.dash[0], l.dash[1]);
        const float end = l.start[1] + l.along[1] * l.length;
        const float top = (l.start[1] < end ? l.start[1] : end) - reach,
                    bottom = (l.start[1] < end ? end : l.start[1]) + reach;
        const int first = top > float(y0) ? int(top) : y0,
                  past = bottom < float(y1 - 1) ? int(bottom) + 1 : y1;
        for (int y = first; y < past; ++y) draw_row(s, l, region, y, to);
    }
}

/// Puts the stroke before or behind the others, and empties it.
INLINE void join_stroke(overlay_lines& s, LineBand& band, const Region& region, int y0, int y1) {
    const int past = band.past < region.x1 ? band.past : region.x1;
    for (int y = y0; y < y1; ++y)
        for (int x = band.first; x < past; x += lanes) {
            const size_t at = band.stroke.at(x, y);
            const vbool seen = load_lanes(band.rank, at) > 0.0f;
            if (!any_lane(seen)) continue;
            store_lanes(band.rank, at, 0.0f);
            const vfloat depth = load_lanes(band.stroke.depth, at), held = load_lanes(band.others.depth, at);
            const vec4 color = band.stroke.color_at(at), before = band.others.color_at(at),
                       there = select(held > 0.0f, before, vec4(vfloat(0.0f)));
            const vec4 joined = select(s.lies_behind(depth, held), there + color * (1.0f - there.w),
                                       color + there * (1.0f - color.w));
            // An orthographic camera's far plane is at 0.
            band.others.store(at, select(seen, joined, before),
                              select(seen, max(held, max(depth, 1e-30f)), held));
        }
    band.first = band.past = 0;
}

}  // namespace easypbr::native::EASYPBR_ISA
