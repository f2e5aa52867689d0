#include "easypbr/render/raster/tint_layer.h"

#include <algorithm>
#include <array>
#include <vector>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

/// Adds the texels of one draw, many at once where what they absorb varies.
class TintLayer::Texels {
  public:
    Texels(TintLayer& layer, const std::variant<Vec3, TexelAbsorption>& absorbed)
        : layer_(layer), absorbed_(absorbed) {}
    /// A copy begins with nothing.
    Texels(const Texels& other) : Texels(other.layer_, other.absorbed_) {}
    Texels& operator=(const Texels&) = delete;
    ~Texels() { flush(); }

    void operator()(size_t texel, float depth, uint32_t face) {
        if (const Vec3* same = std::get_if<Vec3>(&absorbed_)) return layer_.add(texel, depth, same->data());
        const auto width = size_t(layer_.resolution_);
        waiting_[count_++] = {int32_t(texel % width), int32_t(texel / width), face, depth};
        if (count_ == most) flush();
    }

  private:
    static constexpr size_t most = 256;

    void flush() {
        if (count_ == 0) return;
        std::array<float, 4 * most> values;
        std::get<TexelAbsorption>(absorbed_)({waiting_.data(), count_}, {values.data(), 4 * count_});
        for (size_t i = 0; i < count_; ++i) {
            const native::VisiblePixel& at = waiting_[i];
            layer_.add(size_t(at.y) * size_t(layer_.resolution_) + size_t(at.x), at.depth, &values[4 * i]);
        }
        count_ = 0;
    }

    TintLayer& layer_;
    const std::variant<Vec3, TexelAbsorption>& absorbed_;
    std::array<native::VisiblePixel, most> waiting_;
    size_t count_ = 0;
};

TintLayer::TintLayer(std::span<float> absorption, std::span<float> moment, int resolution, float nothing)
    : absorption_(absorption), moment_(moment), resolution_(resolution) {
    raster_.set_area({resolution, resolution}, {0, 0, resolution, resolution});
    parallel_for(absorption.size() / 4, size_t(1) << 14, [&](size_t i) {
        for (const std::span<float> values : {absorption_, moment_}) {
            std::fill_n(&values[4 * i], 3, 0.0f);
            values[4 * i + 3] = nothing;
        }
    });
}

void TintLayer::add(size_t texel, float depth, const float* absorbed) {
    const Vec3 absorption(absorbed[0], absorbed[1], absorbed[2]);
    add(texel, {absorption, absorption * depth, depth, depth});
}

void TintLayer::add(size_t texel, const Absorbed& absorbed) {
    if (absorbed.absorption.isZero(0)) return;
    float *absorption = &absorption_[4 * texel], *moment = &moment_[4 * texel];
    for (int i = 0; i < 3; ++i) {
        absorption[i] += absorbed.absorption[i];
        moment[i] += absorbed.moment[i];
    }
    absorption[3] = std::max(absorption[3], absorbed.first);
    moment[3] = std::max(moment[3], -absorbed.last);
}

bool TintLayer::draw(const ScreenTriangles& triangles, const std::variant<Vec3, TexelAbsorption>& absorbed) {
    return raster_.draw_in_order(triangles, Texels(*this, absorbed));
}

void TintLayer::draw_points(const Array3f& V, const PointSplats& splats,
                            const std::function<float(size_t point)>& absorbed) {
    // So many at once: what is projected takes memory.
    constexpr size_t block = size_t(1) << 18;
    // Each band of rows takes all points, in their order.
    const int bands = std::min(thread_count(), resolution_), rows = (resolution_ + bands - 1) / bands;
    const PointRaster raster(splats, {resolution_, resolution_}, {0, 0, resolution_, resolution_});
    const auto count = size_t(V.rows());
    std::vector<ScreenPoint> points;
    for (size_t first = 0; first < count; first += block) {
        points.resize(std::min(block, count - first));
        parallel_for(points.size(), size_t(1) << 12,
                     [&](size_t i) { points[i] = raster.project(V.data() + 3 * (first + i)); });
        parallel_for(size_t(bands), 1, [&](size_t band) {
            const int top = int(band) * rows, bottom = std::min(top + rows, resolution_);
            if (top >= bottom) return;
            const PixelRect part{0, top, resolution_, bottom - top};
            for (size_t i = 0; i < points.size(); ++i) {
                const ScreenPoint& point = points[i];
                const bool reaches =
                    std::max(point.ry, 1.0f) >= std::max(float(top) - point.y, point.y - float(bottom));
                if (point.depth == 0 || !reaches) continue;
                const Vec3 value = Vec3::Constant(absorbed(first + i));
                raster.cover(point, part, [&](int column, int line) {
                    add(size_t(line) * size_t(resolution_) + size_t(column), point.depth, value.data());
                });
            }
        });
    }
}

}  // namespace easypbr::render
