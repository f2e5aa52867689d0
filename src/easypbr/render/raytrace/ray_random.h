// Numbers and directions for rays: the same for the same pixel of a picture, whatever part of it is drawn.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "easypbr/core/math.h"
#include "easypbr/native/sample_points.h"

namespace easypbr::render {

inline float fraction(double x) {
    return float(x - std::floor(x));
}

using native::pcg_advance, native::pcg_hash, native::pcg_output;

/// The largest number of single precision below 1.
inline constexpr float below_one = 1 - 0x1p-24f;

/// In [0, 1), of 24 bits.
inline float unit_number(uint32_t bits) {
    return float(bits >> 8) * 0x1p-24f;
}

/// Numbers for the path of one of a pixel's rays: three for each surface that it meets. Those for the first
/// are points of a sequence that fills the cube evenly over the pixel's rays (Roberts 2018), whose noise is a
/// fraction of that of independent numbers; those after it come from a permuted congruential hash (Jarzynski
/// and Olano 2020, "Hash Functions for GPU Rendering").
class RayRandom {
  public:
    /// Rays of different streams have nothing to do with each other.
    RayRandom(uint32_t x, uint32_t y, uint32_t index, uint32_t stream) {
        constexpr double g = 1.22074408460575947536;
        state_ = pcg_hash(x + pcg_hash(y + pcg_hash(stream)));
        const Vec3 shift = next();
        state_ = pcg_hash(state_ + pcg_hash(index));
        first_ = {fraction(shift.x() + index / g), fraction(shift.y() + index / (g * g)),
                  fraction(shift.z() + index / (g * g * g))};
        is_first_ = true;
    }

    /// Each in [0, 1).
    Vec3 next() {
        if (std::exchange(is_first_, false)) return first_;
        const float x = number(), y = number();
        return {x, y, number()};
    }

  private:
    float number() {
        state_ = pcg_advance(state_);
        return unit_number(pcg_output(state_));
    }

    uint32_t state_ = 0;
    Vec3 first_{0, 0, 0};
    bool is_first_ = false;
};

/// Interleaved gradient noise (Jimenez 2014), as in shaders/common_noise.glsl.
inline double gradient_noise(double x, double y) {
    const auto part = [](double v) { return v - std::floor(v); };
    return part(52.9829189 * part(x * 0.06711056 + y * 0.00583715));
}

/// Point `index` of a sequence that fills the unit square evenly (Roberts 2018), shifted by another amount in
/// each pixel.
inline Vec2 pixel_point(double x, double y, int index) {
    constexpr double g = 1.32471795724474602596;
    return {fraction(gradient_noise(x, y) + index / g),
            fraction(gradient_noise(y + 17, x + 47) + index / (g * g))};
}

/// A number in [0, 1) of the same ray for choices, independent of its point.
inline float pixel_choice(double x, double y, int index) {
    return fraction(gradient_noise(y + 29, x + 91) + index * 0.6180339887498949);
}

/// Unit vectors that make a right-handed frame with n (Duff et al. 2017).
struct RayFrame {
    Vec3 t, b, n;

    explicit RayFrame(const Vec3& normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z()), a = -1 / (sign + n.z()), c = n.x() * n.y() * a;
        t = Vec3(1 + sign * n.x() * n.x() * a, sign * c, -sign * n.x());
        b = Vec3(c, sign + n.y() * n.y() * a, -n.y());
    }
    Vec3 to_world(const Vec3& v) const { return t * v.x() + b * v.y() + n * v.z(); }
    Vec3 to_local(const Vec3& v) const { return {t.dot(v), b.dot(v), n.dot(v)}; }
};

/// A direction around a normal, distributed by the cosine.
inline Vec3 cosine_direction(const RayFrame& frame, const Vec2& u) {
    const float r = std::sqrt(u.x()), phi = float(2 * pi) * u.y();
    return frame.to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u.x()))});
}

/// The direction that GGX's facets, distributed as they are seen, mirror the view to (Heitz 2018). `view` is
/// unit and points away from the surface; the result may point below it.
inline Vec3 mirrored_direction(const RayFrame& frame, const Vec3& view, float alpha, const Vec2& u) {
    Vec3 v = frame.to_local(view);
    v.z() = std::max(std::abs(v.z()), 1e-4f);
    const Vec3 stretched = Vec3(alpha * v.x(), alpha * v.y(), v.z()).normalized();
    const float length = stretched.head<2>().squaredNorm();
    const Vec3 t1 =
        length > 0 ? Vec3(Vec3(-stretched.y(), stretched.x(), 0) / std::sqrt(length)) : Vec3(1, 0, 0);
    const Vec3 t2 = stretched.cross(t1);
    const float r = std::sqrt(u.x()), phi = float(2 * pi) * u.y(), s = 0.5f * (1 + stretched.z());
    const float x = r * std::cos(phi);
    const float y = (1 - s) * std::sqrt(std::max(0.0f, 1 - x * x)) + s * r * std::sin(phi);
    const Vec3 h = x * t1 + y * t2 + std::sqrt(std::max(0.0f, 1 - x * x - y * y)) * stretched;
    const Vec3 facet = Vec3(alpha * h.x(), alpha * h.y(), std::max(1e-6f, h.z())).normalized();
    return frame.to_world(2 * facet.dot(v) * facet - v);
}

}  // namespace easypbr::render
