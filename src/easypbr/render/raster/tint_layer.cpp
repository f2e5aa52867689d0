#include "easypbr/render/raster/tint_layer.h"

#include <algorithm>
#include <array>

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
    const PointRaster raster(splats, {resolution_, resolution_}, {0, 0, resolution_, resolution_});
    const auto project = [&](size_t i) { return raster.project(V.data() + 3 * i); };
    const auto cover = [&](const ScreenPoint& point, const PixelRect& part, const auto& put) {
        raster.cover(point, part, [&](int column, int row) { put(column, row, point.depth); });
    };
    draw_splats(size_t(V.rows()), project, cover, absorbed);
}

}  // namespace easypbr::render
