#include "easypbr/render/primitives/points/point_order.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

namespace {

/// The colours of vertices by places. Those of later places are asked for ahead: they are anywhere in memory.
class ColorsByPlace {
  public:
    ColorsByPlace(const PointBatches& batches, const ArrayXf& C) : batches_(batches), C_(C) {}

    const float* at(size_t place) const {
        constexpr size_t ahead = 32;
        if (place + ahead < size_t(C_.rows())) __builtin_prefetch(color_of(place + ahead));
        return color_of(place);
    }

  private:
    const float* color_of(size_t place) const {
        return C_.data() + size_t(C_.cols()) * batches_.vertex_of(uint32_t(place));
    }

    const PointBatches& batches_;
    const ArrayXf& C_;
};

}  // namespace

PointColors::PointColors(const PointBatches& batches, const ArrayXf& C) {
    const auto count = size_t(C.rows());
    const ColorsByPlace colors(batches, C);
    codes_.resize(count);
    std::atomic<bool> are_exact = true;
    parallel_chunks(count, size_t(1) << 12, [&](size_t begin, size_t end) {
        for (size_t place = begin; place < end && are_exact.load(std::memory_order_relaxed); ++place) {
            const float* const color = colors.at(place);
            uint32_t code = 0;
            for (int k = 0; k < 3; ++k) {
                const float value = color[k];
                const long own = value >= 0 && value <= 1 ? std::lrint(value * 255) : 0;
                if (!(float(own) / 255.0f == value)) are_exact.store(false, std::memory_order_relaxed);
                code |= uint32_t(own) << 8 * k;
            }
            codes_[place] = code;
        }
    });
    if (are_exact) return;
    LargeVector<uint32_t>().swap(codes_);
    values_.resize(3 * count);
    parallel_for(count, size_t(1) << 12,
                 [&](size_t place) { std::copy_n(colors.at(place), 3, &values_[3 * place]); });
}

}  // namespace easypbr::render
