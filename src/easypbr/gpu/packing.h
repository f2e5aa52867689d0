// Vertex attributes in the formats that buffers hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/core/octahedral.h"
#include "easypbr/core/parallel.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/scene/array.h"

namespace easypbr::gpu {

inline int16_t snorm16(float v) {
    return int16_t(std::lrint(std::clamp(v, -1.0f, 1.0f) * 32767.0f));
}

/// A unit vector, 0.004 degrees exact.
struct Oct16 {
    int16_t x, y;
};

inline Oct16 oct16(const Vec3& n) {
    const Vec2 p = oct_encode(n);
    return {snorm16(p.x()), snorm16(p.y())};
}

/// Row `i` of colours with 3 or 4 columns.
inline Rgba8 rgba8(const ArrayXf& C, Eigen::Index i) {
    const auto code = [&](int c) { return uint8_t(std::lrint(std::clamp(C(i, c), 0.0f, 1.0f) * 255.0f)); };
    return {code(0), code(1), code(2), C.cols() == 4 ? code(3) : uint8_t(255)};
}

template <class T>
gl::Buffer upload(const std::vector<T>& values) {
    return gl::Buffer(std::as_bytes(std::span(values)));
}

/// A buffer of convert(row) for each of `count` rows.
template <class To, class Convert>
gl::Buffer converted(Eigen::Index count, Convert&& convert) {
    std::vector<To> values(static_cast<size_t>(count));
    parallel_for(values.size(), 1 << 15, [&](size_t i) { values[i] = convert(Eigen::Index(i)); });
    return upload(values);
}

}  // namespace easypbr::gpu
