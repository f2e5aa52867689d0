// Points as discs or squares that face the viewer: which pixels each of them covers.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/picture.h"
#include "easypbr/native/shaders.h"
#include "easypbr/render/raster/culling.h"
#include "easypbr/render/raster/point_batches.h"
#include "easypbr/render/raster/whole_pixels.h"

namespace easypbr::render {

/// How the points of a cloud are splatted.
struct PointSplats {
    Mat4 clip_from_mesh = Mat4::Identity();
    float pixels = 1;        ///< diameter, where world_pixels is 0
    float world_pixels = 0;  ///< diameter in pixels times the clip coordinate w
    float least_pixels = 1;  ///< no splat with a world size gets smaller
    float y_per_x = 1;       ///< height of a splat in parts of its width
    bool round = true;
    std::function<bool(size_t point)> is_drawn = {};  ///< empty: all of them
    const PointBatches* batches = nullptr;            ///< of the cloud; null: there are none
};

/// A point on a picture, with the half axes of its splat.
struct ScreenPoint {
    float x = 0, y = 0;
    float rx = 0, ry = 0;
    float depth = 0;  ///< reversed; 0: the point is before the near plane or outside

    /// Rows that it may reach: from the first up to the end.
    int first_row() const { return floor_of(y - std::max(ry, 1.0f)); }
    int end_row() const { return depth > 0 ? ceil_of(y + std::max(ry, 1.0f)) : first_row(); }
};

class PointRaster {
  public:
    /// Of a rectangle of a picture of that size.
    PointRaster(const PointSplats& splats, Vec2i size, const PixelRect& area)
        : m_(splats.clip_from_mesh), splats_(splats), half_size_(size.cast<float>() / 2), area_(area) {}

    ScreenPoint project(const float* p) const {
        const auto row = [&](int r) {
            return m_(r, 0) * p[0] + m_(r, 1) * p[1] + m_(r, 2) * p[2] + m_(r, 3);
        };
        const float w = row(3), scale = 1.0f / w;
        const float depth = row(2) * scale;
        if (!(w > 0 && depth > 0 && depth <= 1)) return {};
        const float diameter = splats_.world_pixels > 0
                                   ? std::max(splats_.least_pixels, splats_.world_pixels * scale)
                                   : splats_.pixels;
        const float r = 0.5f * diameter;
        const ScreenPoint point{(row(0) * scale + 1) * half_size_.x(), (1 - row(1) * scale) * half_size_.y(),
                                r, r * splats_.y_per_x, depth};
        const bool inside =
            point.x + point.rx >= float(area_.x) && point.x - point.rx < float(area_.x + area_.width) &&
            point.y + point.ry >= float(area_.y) && point.y - point.ry < float(area_.y + area_.height);
        return inside ? point : ScreenPoint{};
    }

    /// Calls draw(depth, place, cover) for all points that project() finds inside, on all cores; cover(put)
    /// calls put(column, line) as the function below does, for the whole area. Batches are left out where
    /// depths.hides(bounds), and pixels where `seen`, unless it is null, is nearer: see native::PointBatch.
    template <class Draw, class Depths>
    void draw_batches(const PointBatches& batches, const Draw& draw, Depths& depths,
                      const uint64_t* seen) const {
        constexpr size_t grain = 16;
        const SphereCulling culling = sphere_culling();
        const auto depth = [&](size_t i) {
            return culling.depth(batches.sphere_of(i).center, batches.sphere_of(i).radius);
        };
        visit_near_to_far(batches.count(), grain, depth, [&](std::span<const uint32_t> near) {
            native::PointBatch own = batch();
            own.seen = seen;
            native::PointScreen screen;
            NeighborsHidden hidden(depths);
            for (size_t place = 0; place < near.size(); ++place) {
                // The next batch is somewhere else in memory.
                if (place + 1 < near.size()) {
                    const auto* next = reinterpret_cast<const char*>(batches.points_of(near[place + 1]));
                    for (size_t at = 0; at < PointBatches::block_size; at += 64)
                        __builtin_prefetch(next + at);
                }
                const uint32_t i = near[place];
                const PointBatches::Sphere& sphere = batches.sphere_of(i);
                if (hidden.hides([&] { return culling.bounds(sphere.center, sphere.radius); })) continue;
                own.points = batches.points_of(i);
                own.count = batches.size_of(i);
                const int kept = native::set_up_points(own, screen);
                for (int k = 0; k < kept; ++k) {
                    const int at = screen.kept[k];
                    draw(screen.depth[at], PointBatches::first_place(i) + uint32_t(at),
                         [&](const auto& put) { cover(screen, at, put); });
                }
            }
        });
    }

    /// Calls put(column, line) once for each pixel of `part`, inside of the area, that a point covers: the
    /// one that it lies in, and those whose centres are inside of the splat.
    template <class Put>
    void cover(const ScreenPoint& point, const PixelRect& part, const Put& put) const {
        const int own_x = floor_of(point.x), own_y = floor_of(point.y);
        if (own_x >= part.x && own_x < part.x + part.width && own_y >= part.y && own_y < part.y + part.height)
            put(own_x, own_y);
        if (point.rx <= 0.5f && point.ry <= 0.5f) return;
        const int x0 = std::max(ceil_of(point.x - point.rx - 0.5f), part.x),
                  x1 = std::min(floor_of(point.x + point.rx - 0.5f), part.x + part.width - 1);
        const int y0 = std::max(ceil_of(point.y - point.ry - 0.5f), part.y),
                  y1 = std::min(floor_of(point.y + point.ry - 0.5f), part.y + part.height - 1);
        for (int line = y0; line <= y1; ++line)
            for (int column = x0; column <= x1; ++column) {
                if (column == own_x && line == own_y) continue;
                const float dx = float(column) + 0.5f - point.x,
                            dy = (float(line) + 0.5f - point.y) / splats_.y_per_x;
                if (!splats_.round || dx * dx + dy * dy <= point.rx * point.rx) put(column, line);
            }
    }

    const PixelRect& area() const { return area_; }

  private:
    template <class Put>
    void cover(const native::PointScreen& screen, int at, const Put& put) const {
        const int covered = screen.covered[at];
        if (covered >= 0) {
            const int x = screen.column[at], y = screen.line[at];
            for (unsigned left = unsigned(covered); left != 0; left &= left - 1) {
                const int i = std::countr_zero(left);
                put(x + (i & 1), y + (i >> 1));
            }
            return;
        }
        const float rx = screen.radius[at];
        cover({screen.x[at], screen.y[at], rx, rx * splats_.y_per_x, screen.depth[at]}, area_, put);
    }
    /// What set_up_points() needs beside the points.
    native::PointBatch batch() const {
        native::PointBatch batch{.half_width = half_size_.x(),
                                 .half_height = half_size_.y(),
                                 .left = float(area_.x),
                                 .top = float(area_.y),
                                 .right = float(area_.x + area_.width),
                                 .bottom = float(area_.y + area_.height),
                                 .pixels = splats_.pixels,
                                 .world_pixels = splats_.world_pixels,
                                 .least_pixels = splats_.least_pixels,
                                 .y_per_x = splats_.y_per_x,
                                 .round = splats_.round};
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) batch.clip_from_mesh[column][row] = m_(row, column);
        return batch;
    }
    /// Of spheres around points, whose splats reach out of them.
    SphereCulling sphere_culling() const {
        const float wide = 0.5f * std::max(1.0f, splats_.y_per_x);
        const bool world = splats_.world_pixels > 0;
        const Vec2i size = (2 * half_size_).cast<int>();
        return {m_, size, area_, 1 + wide * (world ? splats_.least_pixels : splats_.pixels),
                wide * (world ? splats_.world_pixels : 0.0f)};
    }

    Mat4 m_;
    const PointSplats& splats_;
    Vec2 half_size_;
    PixelRect area_;
};

}  // namespace easypbr::render
