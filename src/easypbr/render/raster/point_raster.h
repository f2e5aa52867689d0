// Points as discs or squares that face the viewer: which pixels each of them covers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"

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
};

/// A column or row as a number, no farther out than it matters.
inline int bounded(float place) {
    return int(std::clamp(place, -1e6f, 1e6f));
}

/// A point on a picture, with the half axes of its splat.
struct ScreenPoint {
    float x = 0, y = 0;
    float rx = 0, ry = 0;
    float depth = 0;  ///< reversed; 0: the point is before the near plane or outside

    /// Rows that it may reach: from the first up to the end.
    int first_row() const { return bounded(std::floor(y - std::max(ry, 1.0f))); }
    int end_row() const { return depth > 0 ? bounded(std::ceil(y + std::max(ry, 1.0f))) : first_row(); }
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

    /// Calls put(column, line) once for each pixel of `part`, inside of the area, that a point covers: the
    /// one that it lies in, and those whose centres are inside of the splat.
    template <class Put>
    void cover(const ScreenPoint& point, const PixelRect& part, const Put& put) const {
        const int own_x = bounded(std::floor(point.x)), own_y = bounded(std::floor(point.y));
        if (own_x >= part.x && own_x < part.x + part.width && own_y >= part.y && own_y < part.y + part.height)
            put(own_x, own_y);
        if (point.rx <= 0.5f && point.ry <= 0.5f) return;
        const int x0 = std::max(bounded(std::ceil(point.x - point.rx - 0.5f)), part.x),
                  x1 = std::min(bounded(std::floor(point.x + point.rx - 0.5f)), part.x + part.width - 1);
        const int y0 = std::max(bounded(std::ceil(point.y - point.ry - 0.5f)), part.y),
                  y1 = std::min(bounded(std::floor(point.y + point.ry - 0.5f)), part.y + part.height - 1);
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
    Mat4 m_;
    const PointSplats& splats_;
    Vec2 half_size_;
    PixelRect area_;
};

}  // namespace easypbr::render
