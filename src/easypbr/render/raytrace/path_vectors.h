// Vectors of many paths, as streams of shaders read and write them.
#pragma once

#include <cstddef>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/native/kernels.h"

namespace easypbr::render {

/// What arrays of streams have room for.
constexpr size_t whole_streams(size_t count) {
    constexpr auto step = size_t(native::stream_alignment);
    return (count + step - 1) / step * step;
}

/// Vectors, with an array for each component.
template <int components>
class PathVectors {
  public:
    using Vector = Eigen::Vector<float, components>;

    explicit PathVectors(size_t room) : room_(room), values_(components * stride(), 0.0f) {}

    size_t room() const { return room_; }
    Vector at(size_t i) const {
        Vector v;
        for (int c = 0; c < components; ++c) v[c] = component(c)[i];
        return v;
    }
    void set(size_t i, const Vector& v) {
        for (int c = 0; c < components; ++c) component(c)[i] = v[c];
    }
    float* component(int c) { return values_.data() + size_t(c) * stride(); }
    const float* component(int c) const { return values_.data() + size_t(c) * stride(); }
    /// The arrays as a stream (native/shader_streams.h) names them.
    void read_by(const float* (&arrays)[components]) const {
        for (int c = 0; c < components; ++c) arrays[c] = component(c);
    }
    /// From element `first` on.
    void written_by(float* (&arrays)[components], size_t first = 0) {
        for (int c = 0; c < components; ++c) arrays[c] = component(c) + first;
    }

  private:
    /// Components at multiples of 4096 bytes would share a part of the cache.
    size_t stride() const { return room_ + 16; }

    size_t room_;
    std::vector<float> values_;
};

}  // namespace easypbr::render
