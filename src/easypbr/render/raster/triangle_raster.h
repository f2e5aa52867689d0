// Rasterises triangles on the CPU into whatever the caller keeps of a pixel.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/raster/culling.h"
#include "easypbr/render/raster/face_clusters.h"
#include "easypbr/scene/array.h"

namespace easypbr::render {

/// Triangles of a mesh on their way to the screen.
struct ScreenTriangles {
    const Array3f& V;
    const Array3i& F;
    int first_face = 0, face_count = 0;
    Mat4 clip_from_mesh;
    /// Faces whose winding is clockwise on the screen are left out unless `both_sides`; `mirrored` swaps the
    /// two.
    bool both_sides = false, mirrored = false;
    bool clips = false;  ///< what crosses the near plane is cut there; else nothing is drawn then
    const FaceClusters* clusters = nullptr;  ///< of these faces; null: there are none
};

/// Rules as OpenGL's: 8 bits of sub-pixel precision, top-left.
class TriangleRaster {
  public:
    /// `size` is that of the whole picture, `area` the part of it that is drawn.
    void set_area(Vec2i size, const PixelRect& area) {
        size_ = size;
        area_ = area;
    }
    Vec2i size() const { return size_; }
    const PixelRect& area() const { return area_; }

    /// Calls put(pixel of the area, reversed depth in the plane of the snapped vertices, face from 0 on) for
    /// each pixel of each triangle, on all cores in any order, also for one pixel at once; every run of faces
    /// has a copy of `put` of its own. Returns false, without any call, when a vertex is before the near
    /// plane or so far outside of the picture that triangles would have to be clipped, and they do not.
    /// No depth is larger than those of the triangle's vertices.
    template <class Put>
    bool draw(const ScreenTriangles& triangles, const Put& put) {
        NothingHides nothing;
        return draw(triangles, put, nothing);
    }
    /// The same, without the clusters whose calls would not count, since depths.hides(bounds).
    template <class Put, class Depths>
    bool draw(const ScreenTriangles& triangles, const Put& put, Depths& depths);
    /// The same, but the calls for a pixel follow each other in the order of the faces: for what adds up.
    /// Every band of rows has a copy of `put` of its own.
    template <class Put>
    bool draw_in_order(const ScreenTriangles& triangles, const Put& put);

  private:
    static constexpr int subpixel_bits = native::ClusterFaces::subpixel_bits, subpixel = 1 << subpixel_bits,
                         half_pixel = native::ClusterFaces::half_pixel;
    /// Pixels beyond which coordinates are not drawn here; edge functions stay far below 63 bits.
    static constexpr float guard_band = native::ClusterFaces::guard_band;
    static constexpr size_t vertex_grain = 1 << 12, face_grain = 1 << 11, row_grain = 64, cluster_grain = 32,
                            prefetch_distance = 24;
    static constexpr size_t most_kept = 1 << 20;
    /// Triangles up to this many pixels across have edge functions below 2^31: 2 (64 * 256)^2 = 2^29.
    static constexpr int small_extent = 64;

    /// A vertex on the screen, x to the right and y downwards.
    struct Vertex {
        int32_t x, y;  ///< 1/256 of a pixel
        float depth;   ///< reversed, (0, 1]; -1 where the vertex would have to be clipped
    };

    /// The edge function of a -> b, stepped from pixel to pixel; at least 0 inside. Pixel centres on an edge
    /// belong to the triangle to the right of or below it (the top-left rule).
    template <class Integer>
    struct Edge {
        Integer value, step_x, step_y;

        [[gnu::always_inline]] Edge(const Vertex& a, const Vertex& b, int x, int y) {
            const Integer dx = b.x - a.x, dy = b.y - a.y;
            const Integer px = Integer(x) * subpixel + half_pixel - a.x,
                          py = Integer(y) * subpixel + half_pixel - a.y;
            const bool top_left = dy < 0 || (dy == 0 && dx > 0);
            value = dx * py - dy * px - (top_left ? 0 : 1);
            step_x = -dy * subpixel;
            step_y = dx * subpixel;
        }
    };

    /// The depth in the plane through three vertices.
    struct Plane {
        const Vertex& a;
        float slope_x, slope_y, nearest;

        [[gnu::always_inline]] Plane(const Vertex& a_, const Vertex& b, const Vertex& c)
            : a(a_), nearest(std::max(std::max(a_.depth, b.depth), c.depth)) {
            const float bx = float(b.x - a.x), by = float(b.y - a.y), cx = float(c.x - a.x),
                        cy = float(c.y - a.y);
            const float inverse = 1 / (bx * cy - cx * by), db = b.depth - a.depth, dc = c.depth - a.depth;
            slope_x = (db * cy - dc * by) * inverse;
            slope_y = (dc * bx - db * cx) * inverse;
        }
        float at(int x, int y) const {
            const float depth = a.depth + slope_x * float(x * subpixel + half_pixel - a.x) +
                                slope_y * float(y * subpixel + half_pixel - a.y);
            // The slopes of slivers are far off.
            return std::min(std::max(depth, least_depth), nearest);
        }
    };

    /// Rows of the area, as far as they are drawn by one thread.
    struct Window {
        Vec2i size;
        PixelRect area;
        int first_row, last_row;

        template <class Put>
        void draw_face(const ScreenTriangles& t, const std::vector<Vertex>& screen, bool inside, size_t face,
                       const Put& put) const;
        /// A face whose corners project() may have marked.
        template <class Put>
        void draw_corners(const ScreenTriangles& t, const Vertex& a, const Vertex& b, const Vertex& c,
                          const int32_t* face, const Put& put) const;
        template <class Put>
        void draw_triangle(const Vertex& a, const Vertex& b, const Vertex& c, const Put& put) const;
        /// Of triangles with vertices that project() has marked: cuts off what is before the near plane,
        /// beyond the far one, or far outside.
        template <class Put>
        void draw_clipped(const ScreenTriangles& t, const int32_t* face, const Put& put) const;
        template <class Put>
        void draw_faced(const ScreenTriangles& t, const Vertex& a, const Vertex& b, const Vertex& c,
                        const Put& put) const;
        template <class Put>
        void fill_tiny(const Vertex& a, const Vertex& b, const Vertex& c, int x0, int y0, unsigned kept,
                       const Put& put) const;
        template <class Integer, class Put>
        void fill(const Vertex& a, const Vertex& b, const Vertex& c, int x0, int x1, int y0, int y1,
                  const Put& put) const;
        size_t index(int x, int y) const {
            return size_t(y - area.y) * size_t(area.width) + size_t(x - area.x);
        }
    };

    /// Vertices to the screen, rows upwards to rows downwards.
    struct Projection {
        Mat4 m;
        Vec2 half;

        Projection(const ScreenTriangles& t, Vec2i size)
            : m(t.clip_from_mesh), half(size.cast<float>() / 2) {}
        Vertex operator()(const float* p) const {
            const Vec4 clip = m.col(0) * p[0] + m.col(1) * p[1] + m.col(2) * p[2] + m.col(3);
            const float scale = 1.0f / clip.w();
            const float x = (clip.x() * scale + 1) * half.x(), y = (1 - clip.y() * scale) * half.y();
            const float depth = clip.z() * scale;
            const bool is_inside = clip.w() > 0 && std::abs(x) < guard_band && std::abs(y) < guard_band &&
                                   depth > 0 && depth <= 1;
            if (!is_inside) return {0, 0, -1};
            return {int32_t(std::lrintf(x * subpixel)), int32_t(std::lrintf(y * subpixel)), depth};
        }
    };

    Window rows(int first, int last) const { return {size_, area_, first, last}; }
    bool project(const ScreenTriangles& triangles);
    /// The same of clusters, none of which is drawn yet.
    bool needs_no_clipping(const ScreenTriangles& triangles, const ClusterCulling& culling) const;
    template <class Put, class Depths>
    void draw_clusters(const ScreenTriangles& triangles, const ClusterCulling& culling, const Put& put,
                       Depths& depths) const;
    template <class Put, class Depths>
    void draw_cluster(const ScreenTriangles& triangles, const FaceClusters::Cluster& cluster,
                      native::ClusterFaces& faces, native::ClusterScreen& screen, Put& put,
                      NeighborsHidden<Depths>& hidden) const;
    /// Of a cluster's vertices, of which none has to be clipped.
    ScreenBounds bounds(const native::ClusterScreen& screen) const {
        return {std::max(first_pixel(screen.left), area_.x), std::max(first_pixel(screen.top), area_.y),
                std::min(last_pixel(screen.right), area_.x + area_.width - 1),
                std::min(last_pixel(screen.bottom), area_.y + area_.height - 1), screen.nearest};
    }
    /// First and last pixel whose centre lies between two sub-pixel coordinates.
    static int first_pixel(int32_t low) { return (low + half_pixel - 1) >> subpixel_bits; }
    static int last_pixel(int32_t high) { return (high - half_pixel) >> subpixel_bits; }

    Vec2i size_{0, 0};
    PixelRect area_;
    std::vector<Vertex> screen_;
};

template <class Put>
inline void TriangleRaster::Window::draw_face(const ScreenTriangles& t, const std::vector<Vertex>& screen,
                                              bool inside, size_t face, const Put& put) const {
    const int32_t* f = t.F.data() + 3 * (size_t(t.first_face) + face);
    const Vertex &a = screen[size_t(f[0])], &b = screen[size_t(f[1])], &c = screen[size_t(f[2])];
    const auto to_pixel = [&](size_t pixel, float depth) { put(pixel, depth, uint32_t(face)); };
    if (inside)
        draw_faced(t, a, b, c, to_pixel);
    else
        draw_corners(t, a, b, c, f, to_pixel);
}

template <class Put>
inline void TriangleRaster::Window::draw_corners(const ScreenTriangles& t, const Vertex& a, const Vertex& b,
                                                 const Vertex& c, const int32_t* face, const Put& put) const {
    if (a.depth < 0 || b.depth < 0 || c.depth < 0)
        draw_clipped(t, face, put);
    else
        draw_faced(t, a, b, c, put);
}

template <class Put, class Depths>
bool TriangleRaster::draw(const ScreenTriangles& t, const Put& put, Depths& depths) {
    if (t.clusters) {
        const ClusterCulling culling(t, size_, area_);
        if (t.clips || needs_no_clipping(t, culling)) {
            draw_clusters(t, culling, put, depths);
            return true;
        }
    }
    const bool inside = project(t);
    if (!inside && !t.clips) return false;
    const Window all = rows(area_.y, area_.y + area_.height - 1);
    parallel_chunks(size_t(t.face_count), face_grain, [&](size_t begin, size_t end) {
        Put own = put;
        for (size_t i = begin; i < end; ++i) {
            const int32_t* f = t.F.data() + 3 * (size_t(t.first_face) + i);
            // The vertices of large meshes are far apart in memory: they are asked for ahead of their turn.
            if (i + prefetch_distance < end)
                for (size_t k = 0; k < 3; ++k)
                    __builtin_prefetch(&screen_[size_t(f[3 * prefetch_distance + k])]);
            all.draw_face(t, screen_, inside, i,
                          [&](size_t pixel, float depth, uint32_t face) { own(pixel, depth, face); });
        }
    });
    // Of a large mesh there are clusters the next time.
    if (screen_.size() > most_kept) screen_ = {};
    return true;
}

template <class Put, class Depths>
void TriangleRaster::draw_clusters(const ScreenTriangles& t, const ClusterCulling& culling, const Put& put,
                                   Depths& depths) const {
    const std::span<const FaceClusters::Cluster> clusters = t.clusters->clusters();
    native::ClusterFaces all{.half_width = 0.5f * float(size_.x()),
                             .half_height = 0.5f * float(size_.y()),
                             .left = area_.x,
                             .top = area_.y,
                             .right = area_.x + area_.width - 1,
                             .bottom = area_.y + area_.height - 1,
                             .both_sides = t.both_sides,
                             .mirrored = t.mirrored};
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) all.clip_from_mesh[column][row] = t.clip_from_mesh(row, column);
    const auto depth = [&](size_t i) { return culling.depth(clusters[i]); };
    visit_near_to_far(clusters.size(), cluster_grain, depth, [&](std::span<const uint32_t> near) {
        Put own = put;
        native::ClusterFaces faces = all;
        native::ClusterScreen screen;
        // Of the spheres, and of what is projected.
        NeighborsHidden around(depths), within(depths);
        for (const uint32_t i : near)
            if (!around.hides([&] { return culling.bounds(clusters[i]); }))
                draw_cluster(t, clusters[i], faces, screen, own, within);
    });
}

template <class Put, class Depths>
void TriangleRaster::draw_cluster(const ScreenTriangles& t, const FaceClusters::Cluster& cluster,
                                  native::ClusterFaces& faces, native::ClusterScreen& screen, Put& put,
                                  NeighborsHidden<Depths>& hidden) const {
    const Window all = rows(area_.y, area_.y + area_.height - 1);
    faces.vertices = cluster.vertices;
    faces.corners = t.clusters->corners_of(cluster);
    faces.vertex_count = cluster.vertex_count;
    faces.face_count = cluster.face_count;
    int count = -1;
    if (native::project_cluster(faces, screen)) {
        const ScreenBounds covered = bounds(screen);
        if (covered.empty() || hidden.hides([&] { return covered; })) return;
        count = native::set_up_cluster(faces, screen);
    }
    for (int i = 0; i < count; ++i) {
        const int face = screen.kept[i];
        const uint32_t number = t.clusters->face_of(cluster, face);
        const auto corner = [&](int k) {
            const int at = faces.corners[k * cluster.face_count + face];
            return Vertex{screen.x[at], screen.y[at], screen.depth[at]};
        };
        all.draw_faced(t, corner(0), corner(1), corner(2),
                       [&](size_t pixel, float depth) { put(pixel, depth, number); });
    }
    if (count >= 0) return;
    const Projection projection(t, size_);
    for (int face = 0; face < cluster.face_count; ++face) {
        const uint32_t number = t.clusters->face_of(cluster, face);
        const int32_t* f = t.F.data() + 3 * (size_t(t.first_face) + number);
        const auto corner = [&](int k) { return projection(t.V.data() + 3 * size_t(f[k])); };
        all.draw_corners(t, corner(0), corner(1), corner(2), f,
                         [&](size_t pixel, float depth) { put(pixel, depth, number); });
    }
}

template <class Put>
bool TriangleRaster::draw_in_order(const ScreenTriangles& t, const Put& put) {
    const bool inside = project(t);
    if (!inside && !t.clips) return false;
    parallel_chunks(size_t(area_.height), row_grain, [&](size_t begin, size_t end) {
        Put own = put;
        const Window band = rows(area_.y + int(begin), area_.y + int(end) - 1);
        for (size_t i = 0; i < size_t(t.face_count); ++i)
            band.draw_face(t, screen_, inside, i,
                           [&](size_t pixel, float depth, uint32_t face) { own(pixel, depth, face); });
    });
    return true;
}

template <class Put>
inline void TriangleRaster::Window::draw_faced(const ScreenTriangles& t, const Vertex& a, const Vertex& b,
                                               const Vertex& c, const Put& put) const {
    const int64_t doubled = int64_t(b.x - a.x) * (c.y - a.y) - int64_t(c.x - a.x) * (b.y - a.y);
    // y runs downwards: a counter-clockwise triangle has a negative area. Neighbours face the same way, which
    // processors foresee better than whether there is a pixel's centre within.
    if (doubled == 0 || (!t.both_sides && (doubled < 0) == t.mirrored)) return;
    if (doubled > 0)
        draw_triangle(a, b, c, put);
    else
        draw_triangle(a, c, b, put);
}

/// Sutherland and Hodgman (1974). Neighbours cut their common edge at the same point: from the end that is
/// kept.
template <class Put>
void TriangleRaster::Window::draw_clipped(const ScreenTriangles& t, const int32_t* face,
                                          const Put& put) const {
    using Corner = Eigen::Vector4d;
    constexpr size_t most = 9;  // each of six planes adds a corner at most
    std::array<Corner, most> polygon, kept;
    size_t count = 3;
    for (size_t k = 0; k < 3; ++k) {
        const float* p = t.V.data() + 3 * size_t(face[k]);
        polygon[k] = t.clip_from_mesh.cast<double>() * Corner(double(p[0]), double(p[1]), double(p[2]), 1);
        if (!polygon[k].allFinite()) return;
    }
    const Vec2d half = 0.5 * size.cast<double>();
    const double x = (guard_band - 1) / half.x() - 1, y = (guard_band - 1) / half.y() - 1;
    const Corner planes[] = {{0, 0, -1, 1}, {0, 0, 1, 0}, {1, 0, 0, x},
                             {-1, 0, 0, x}, {0, 1, 0, y}, {0, -1, 0, y}};
    for (const Corner& plane : planes) {
        size_t left = 0;
        for (size_t k = 0; k < count; ++k) {
            const Corner &a = polygon[k], &b = polygon[(k + 1) % count];
            const double from = plane.dot(a), to = plane.dot(b);
            if (from >= 0) kept[left++] = a;
            if ((from >= 0) == (to >= 0)) continue;
            kept[left++] = from >= 0 ? Corner(a + (b - a) * (from / (from - to)))
                                     : Corner(b + (a - b) * (to / (to - from)));
        }
        std::swap(polygon, kept);
        count = left;
        if (count < 3) return;
    }
    std::array<Vertex, most> screen;
    for (size_t k = 0; k < count; ++k) {
        const Corner& c = polygon[k];
        if (!(c.w() > 0)) return;
        screen[k] = {int32_t(std::lrint((c.x() / c.w() + 1) * half.x() * subpixel)),
                     int32_t(std::lrint((1 - c.y() / c.w()) * half.y() * subpixel)),
                     float(std::clamp(c.z() / c.w(), double(least_depth), 1.0))};
    }
    for (size_t k = 1; k + 1 < count; ++k) draw_faced(t, screen[0], screen[k], screen[k + 1], put);
}

template <class Put>
void TriangleRaster::Window::draw_triangle(const Vertex& a, const Vertex& b, const Vertex& c,
                                           const Put& put) const {
    const int left = first_pixel(std::min(std::min(a.x, b.x), c.x)),
              right = last_pixel(std::max(std::max(a.x, b.x), c.x));
    const int top = first_pixel(std::min(std::min(a.y, b.y), c.y)),
              bottom = last_pixel(std::max(std::max(a.y, b.y), c.y));
    const int x0 = std::max(left, area.x), x1 = std::min(right, area.x + area.width - 1);
    const int y0 = std::max(top, first_row), y1 = std::min(bottom, last_row);
    if (x0 > x1 || y0 > y1) return;  // Most triangles of a large mesh lie between the pixels' centres.
    if (right - left < 2 && bottom - top < 2) {
        const unsigned kept = (x1 > x0 ? 0b11u : 0b01u) * (y1 > y0 ? 0b101u : 0b001u);
        fill_tiny(a, b, c, x0, y0, kept, put);
    } else if (right - left < small_extent && bottom - top < small_extent) {
        fill<int32_t>(a, b, c, x0, x1, y0, y1, put);
    } else {
        fill<int64_t>(a, b, c, x0, x1, y0, y1, put);
    }
}

/// Of four pixels; `kept` has a bit for each that is drawn. Without branches on what is inside: for triangles
/// of about a pixel, mispredicted ones would cost more than all else.
template <class Put>
void TriangleRaster::Window::fill_tiny(const Vertex& a, const Vertex& b, const Vertex& c, int x0, int y0,
                                       unsigned kept, const Put& put) const {
    const Edge<int32_t> ab(a, b, x0, y0), bc(b, c, x0, y0), ca(c, a, x0, y0);
    const auto outside = [&](int32_t e0, int32_t e1, int32_t e2, int bit) {
        return (uint32_t(e0 | e1 | e2) >> 31) << bit;
    };
    const int32_t right[3] = {ab.value + ab.step_x, bc.value + bc.step_x, ca.value + ca.step_x};
    unsigned inside =
        kept & ~(outside(ab.value, bc.value, ca.value, 0) | outside(right[0], right[1], right[2], 1) |
                 outside(ab.value + ab.step_y, bc.value + bc.step_y, ca.value + ca.step_y, 2) |
                 outside(right[0] + ab.step_y, right[1] + bc.step_y, right[2] + ca.step_y, 3));
    if (inside == 0) return;
    const Plane plane(a, b, c);
    for (; inside != 0; inside &= inside - 1) {
        const int pixel = __builtin_ctz(inside), x = x0 + (pixel & 1), y = y0 + (pixel >> 1);
        put(index(x, y), plane.at(x, y));
    }
}

template <class Integer, class Put>
void TriangleRaster::Window::fill(const Vertex& a, const Vertex& b, const Vertex& c, int x0, int x1, int y0,
                                  int y1, const Put& put) const {
    Edge<Integer> ab(a, b, x0, y0), bc(b, c, x0, y0), ca(c, a, x0, y0);
    const Plane plane(a, b, c);
    for (int y = y0; y <= y1; ++y) {
        Integer e0 = ab.value, e1 = bc.value, e2 = ca.value;
        for (int x = x0; x <= x1; ++x) {
            if ((e0 | e1 | e2) >= 0) put(index(x, y), plane.at(x, y));
            e0 += ab.step_x, e1 += bc.step_x, e2 += ca.step_x;
        }
        ab.value += ab.step_y, bc.value += bc.step_y, ca.value += ca.step_y;
    }
}

inline bool TriangleRaster::needs_no_clipping(const ScreenTriangles& t, const ClusterCulling& culling) const {
    const std::span<const FaceClusters::Cluster> clusters = t.clusters->clusters();
    const Projection projection(t, size_);
    std::atomic<bool> inside{true};
    parallel_for(clusters.size(), cluster_grain, [&](size_t i) {
        const FaceClusters::Cluster& c = clusters[i];
        if (culling.is_inside(c)) return;
        for (int k = 0; k < c.vertex_count; ++k) {
            const float p[] = {c.vertices[k], c.vertices[c.vertex_count + k],
                               c.vertices[2 * c.vertex_count + k]};
            if (!(projection(p).depth > 0)) inside = false;
        }
    });
    return inside;
}

inline bool TriangleRaster::project(const ScreenTriangles& t) {
    screen_.resize(size_t(t.V.rows()));
    std::atomic<bool> inside{true};
    const Projection projection(t, size_);
    parallel_chunks(screen_.size(), vertex_grain, [&](size_t begin, size_t end) {
        bool all_inside = true;
        for (size_t i = begin; i < end; ++i) {
            screen_[i] = projection(t.V.data() + 3 * i);
            all_inside &= screen_[i].depth > 0;
        }
        if (!all_inside) inside = false;
    });
    return inside;
}

}  // namespace easypbr::render
