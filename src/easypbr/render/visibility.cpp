#include "easypbr/render/visibility.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

namespace {

constexpr int subpixel_bits = 8, subpixel = 1 << subpixel_bits, half_pixel = subpixel / 2;
/// Pixels beyond which coordinates are not drawn here; edge functions stay far below 63 bits.
constexpr float guard_band = 1 << 15;
constexpr size_t vertex_grain = 1 << 12, face_grain = 1 << 11, prefetch_distance = 24;

/// First and last pixel whose centre lies between two sub-pixel coordinates.
int first_pixel(int32_t low) {
    return (low + half_pixel - 1) >> subpixel_bits;
}
int last_pixel(int32_t high) {
    return (high - half_pixel) >> subpixel_bits;
}

/// The edge function of a -> b, stepped from pixel to pixel; at least 0 inside. Pixel centres on an edge
/// belong to the triangle to the right of or below it (the top-left rule).
template <class Integer>
struct Edge {
    Integer value, step_x, step_y;

    template <class Vertex>
    Edge(const Vertex& a, const Vertex& b, int x, int y) {
        const Integer dx = b.x - a.x, dy = b.y - a.y;
        const Integer px = Integer(x) * subpixel + half_pixel - a.x,
                      py = Integer(y) * subpixel + half_pixel - a.y;
        const bool top_left = dy < 0 || (dy == 0 && dx > 0);
        value = dx * py - dy * px - (top_left ? 0 : 1);
        step_x = -dy * subpixel;
        step_y = dx * subpixel;
    }
};

/// Triangles up to this many pixels across have edge functions below 2^31: 2 (64 * 256)^2 = 2^29.
constexpr int small_extent = 64;

/// Keeps the larger of a pixel and a key; any order of calls gives the same.
void raise(uint64_t& pixel, uint64_t key) {
    const std::atomic_ref<uint64_t> cell(pixel);
    uint64_t seen = cell.load(std::memory_order_relaxed);
    while (key > seen && !cell.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
}

/// The same for points: of equal depths the larger content, of equal contents the smaller id is kept.
void raise_point(uint64_t& pixel, uint64_t key, const std::function<uint64_t(uint32_t)>& content) {
    const std::atomic_ref<uint64_t> cell(pixel);
    uint64_t seen = cell.load(std::memory_order_relaxed);
    for (;;) {
        if (seen >> 32 > key >> 32) return;
        if (seen >> 32 == key >> 32) {
            const uint64_t mine = content(VisibilityBuffer::id_of(key)),
                           other = content(VisibilityBuffer::id_of(seen));
            if (other > mine || (other == mine && seen >= key)) return;
        }
        if (cell.compare_exchange_weak(seen, key, std::memory_order_relaxed)) return;
    }
}

}  // namespace

void VisibilityBuffer::clear(Vec2i size, const PixelRect& area) {
    size_ = size;
    area_ = area;
    pixels_.assign(size_t(area.width) * size_t(area.height), 0);
}

bool VisibilityBuffer::draw(const Array3f& V, const Array3i& F, int first_face, int face_count,
                            const Mat4& clip_from_mesh, uint32_t first_id, bool both_sides, bool mirrored) {
    screen_.resize(size_t(V.rows()));
    std::atomic<bool> inside{true};
    const Vec2 half(0.5f * float(size_.x()), 0.5f * float(size_.y()));
    parallel_chunks(screen_.size(), vertex_grain, [&](size_t begin, size_t end) {
        bool all_inside = true;
        for (size_t i = begin; i < end; ++i) {
            const float* p = V.data() + 3 * i;
            const Vec4 clip = clip_from_mesh.col(0) * p[0] + clip_from_mesh.col(1) * p[1] +
                              clip_from_mesh.col(2) * p[2] + clip_from_mesh.col(3);
            const float scale = 1.0f / clip.w();
            const float x = (clip.x() * scale + 1) * half.x(), y = (1 - clip.y() * scale) * half.y();
            const float depth = clip.z() * scale;
            all_inside &= clip.w() > 0 && std::abs(x) < guard_band && std::abs(y) < guard_band && depth > 0 &&
                          depth <= 1;
            screen_[i] = {int32_t(std::lrintf(x * subpixel)), int32_t(std::lrintf(y * subpixel)), depth};
        }
        if (!all_inside) inside = false;
    });
    if (!inside) return false;

    parallel_chunks(size_t(face_count), face_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = F.data() + 3 * (size_t(first_face) + i);
            // The vertices of large meshes are far apart in memory: they are asked for ahead of their turn.
            if (i + prefetch_distance < end)
                for (size_t k = 0; k < 3; ++k)
                    __builtin_prefetch(&screen_[size_t(f[3 * prefetch_distance + k])]);
            const ScreenVertex &a = screen_[size_t(f[0])], &b = screen_[size_t(f[1])],
                               &c = screen_[size_t(f[2])];
            // Most triangles of a large mesh lie between the pixels' centres.
            const int32_t x0 = std::min(std::min(a.x, b.x), c.x), x1 = std::max(std::max(a.x, b.x), c.x);
            const int32_t y0 = std::min(std::min(a.y, b.y), c.y), y1 = std::max(std::max(a.y, b.y), c.y);
            const PixelRect box{first_pixel(x0), first_pixel(y0), last_pixel(x1) - first_pixel(x0) + 1,
                                last_pixel(y1) - first_pixel(y0) + 1};
            if (box.width <= 0 || box.height <= 0) continue;
            const int64_t area = int64_t(b.x - a.x) * (c.y - a.y) - int64_t(c.x - a.x) * (b.y - a.y);
            // y runs downwards: a counter-clockwise triangle has a negative area.
            if (area == 0 || (!both_sides && (area < 0) == mirrored)) continue;
            if (area > 0)
                draw_triangle(a, b, c, first_id + uint32_t(i), box);
            else
                draw_triangle(a, c, b, first_id + uint32_t(i), box);
        }
    });
    return true;
}

void VisibilityBuffer::draw_points(const Array3f& V, const PointSplats& splats, uint32_t first_id,
                                   const std::function<uint64_t(uint32_t id)>& content) {
    const float half_width = 0.5f * float(size_.x()), half_height = 0.5f * float(size_.y());
    const float left = float(area_.x), right = float(area_.x + area_.width);
    const float top = float(area_.y), bottom = float(area_.y + area_.height);
    const Mat4& m = splats.clip_from_mesh;
    parallel_chunks(size_t(V.rows()), vertex_grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const float* p = V.data() + 3 * i;
            const auto row = [&](int r) {
                return m(r, 0) * p[0] + m(r, 1) * p[1] + m(r, 2) * p[2] + m(r, 3);
            };
            const float w = row(3), scale = 1.0f / w;
            const float depth = row(2) * scale;
            if (!(w > 0 && depth > 0 && depth <= 1)) continue;
            const float x = (row(0) * scale + 1) * half_width, y = (1 - row(1) * scale) * half_height;
            const float diameter = splats.world_pixels > 0
                                       ? std::max(splats.least_pixels, splats.world_pixels * scale)
                                       : splats.pixels;
            const float r = 0.5f * diameter, ry = r * splats.y_per_x;
            if (!(x + r >= left && x - r < right && y + ry >= top && y - ry < bottom)) continue;
            const uint64_t key = uint64_t(std::bit_cast<uint32_t>(depth)) << 32 | uint32_t(~(first_id + i));
            const auto put = [&](int column, int line) {
                if (column < area_.x || column >= area_.x + area_.width || line < area_.y ||
                    line >= area_.y + area_.height)
                    return;
                raise_point(pixels_[size_t(line - area_.y) * size_t(area_.width) + size_t(column - area_.x)],
                            key, content);
            };
            const int own_x = int(std::floor(x)), own_y = int(std::floor(y));
            put(own_x, own_y);
            if (diameter <= 1 && ry <= 0.5f) continue;
            const int x0 = std::max(int(std::ceil(x - r - 0.5f)), area_.x),
                      x1 = std::min(int(std::floor(x + r - 0.5f)), area_.x + area_.width - 1);
            const int y0 = std::max(int(std::ceil(y - ry - 0.5f)), area_.y),
                      y1 = std::min(int(std::floor(y + ry - 0.5f)), area_.y + area_.height - 1);
            for (int line = y0; line <= y1; ++line)
                for (int column = x0; column <= x1; ++column) {
                    const float dx = float(column) + 0.5f - x, dy = (float(line) + 0.5f - y) / splats.y_per_x;
                    if (!splats.round || dx * dx + dy * dy <= r * r) put(column, line);
                }
        }
    });
}

void VisibilityBuffer::crop() {
    int x0 = area_.width, x1 = -1, y0 = area_.height, y1 = -1;
    for (int y = 0; y < area_.height; ++y) {
        const auto row = pixels().subspan(size_t(y) * size_t(area_.width), size_t(area_.width));
        const auto is_covered = [](uint64_t pixel) { return pixel != 0; };
        const auto first = std::ranges::find_if(row, is_covered);
        if (first == row.end()) continue;
        const auto last = std::find_if(row.rbegin(), row.rend(), is_covered);
        x0 = std::min(x0, int(first - row.begin()));
        x1 = std::max(x1, area_.width - 1 - int(last - row.rbegin()));
        y0 = std::min(y0, y);
        y1 = y;
    }
    const PixelRect kept{area_.x + x0, area_.y + y0, std::max(0, x1 - x0 + 1), std::max(0, y1 - y0 + 1)};
    for (int y = 0; y < kept.height; ++y) {
        const auto from = pixels_.begin() + (long(y0 + y) * area_.width + x0);
        std::copy(from, from + kept.width, pixels_.begin() + long(y) * kept.width);
    }
    area_ = kept.width > 0 ? kept : PixelRect{};
    pixels_.resize(size_t(area_.width) * size_t(area_.height));
}

void VisibilityBuffer::draw_triangle(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c,
                                     uint32_t id, const PixelRect& box) {
    const int x0 = std::max(box.x, area_.x), x1 = std::min(box.x + box.width, area_.x + area_.width) - 1;
    const int y0 = std::max(box.y, area_.y), y1 = std::min(box.y + box.height, area_.y + area_.height) - 1;
    if (x0 > x1 || y0 > y1) return;
    if (box.width <= small_extent && box.height <= small_extent)
        fill<int32_t>(a, b, c, id, x0, x1, y0, y1);
    else
        fill<int64_t>(a, b, c, id, x0, x1, y0, y1);
}

template <class Integer>
void VisibilityBuffer::fill(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, uint32_t id,
                            int x0, int x1, int y0, int y1) {
    Edge<Integer> ab(a, b, x0, y0), bc(b, c, x0, y0), ca(c, a, x0, y0);
    // The plane of the depth through the three vertices; most small triangles cover no pixel and need none.
    bool has_plane = false;
    float slope_x = 0, slope_y = 0;
    const auto key = [&](int x, int y) {
        if (!has_plane) {
            const float bx = float(b.x - a.x), by = float(b.y - a.y), cx = float(c.x - a.x),
                        cy = float(c.y - a.y);
            const float inverse = 1 / (bx * cy - cx * by), db = b.depth - a.depth, dc = c.depth - a.depth;
            slope_x = (db * cy - dc * by) * inverse;
            slope_y = (dc * bx - db * cx) * inverse;
            has_plane = true;
        }
        const float depth = a.depth + slope_x * float(x * subpixel + half_pixel - a.x) +
                            slope_y * float(y * subpixel + half_pixel - a.y);
        return uint64_t(std::bit_cast<uint32_t>(std::max(depth, 1e-30f))) << 32 | uint32_t(~id);
    };
    for (int y = y0; y <= y1; ++y) {
        Integer e0 = ab.value, e1 = bc.value, e2 = ca.value;
        uint64_t* row = pixels_.data() + size_t(y - area_.y) * size_t(area_.width) - area_.x;
        for (int x = x0; x <= x1; ++x) {
            if ((e0 | e1 | e2) >= 0) raise(row[x], key(x, y));
            e0 += ab.step_x, e1 += bc.step_x, e2 += ca.step_x;
        }
        ab.value += ab.step_y, bc.value += bc.step_y, ca.value += ca.step_y;
    }
}

}  // namespace easypbr::render
