#include "easypbr/app/lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "easypbr/app/tiled_picture.h"
#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"

namespace easypbr::app {
namespace {

std::vector<Vec2d> undistorted_slopes(const Camera& camera, Vec2i size) {
    const Mat3d K = camera.opencv_K(size.x(), size.y());
    std::vector<Vec2d> slopes(size_t(size.x()) * size_t(size.y()));
    parallel_for(size_t(size.y()), 8, [&](size_t row) {
        for (int x = 0; x < size.x(); ++x) {
            const double y = (double(row) - K(1, 2)) / K(1, 1);
            const Vec2d seen((x - K(0, 2) - K(0, 1) * y) / K(0, 0), y);
            slopes[row * size_t(size.x()) + size_t(x)] =
                camera.distortion ? camera.distortion->undistort(seen) : seen;
        }
    });
    return slopes;
}

/// A pinhole camera with the same focal lengths whose picture holds all these rays, and one pixel more. Its
/// principal point lies within a pixel as the lens's does: where the lens does little, pixels meet pixels.
void choose_drawn(const Camera& camera, const std::vector<Vec2d>& slopes, LensMap& map) {
    const Mat3d K = camera.opencv_K(map.size.x(), map.size.y());
    Eigen::AlignedBox2d box;
    for (const Vec2d& s : slopes) box.extend(s);
    const Vec2d focal(K(0, 0), K(1, 1));
    const Vec2d within(K(0, 2) - std::floor(K(0, 2)), K(1, 2) - std::floor(K(1, 2)));
    const Vec2d low = (box.min().cwiseProduct(focal) + within).array().floor() - 1 - within.array(),
                high = (box.max().cwiseProduct(focal) + within).array().ceil() + 1 - within.array();
    const Vec2d drawn_size = (high - low).array() + 1;
    if (drawn_size.maxCoeff() > max_image_side || drawn_size.prod() > double(max_picture_pixels))
        throw ArgumentError(fmt::format(
            "camera: a picture of {}x{} pixels is drawn as one of {:.0f}x{:.0f} without distortion and skew, "
            "more than {} a side or {} in all; ask for a smaller picture, or for one nearer to the optical "
            "axis",
            map.size.x(), map.size.y(), drawn_size.x(), drawn_size.y(), max_image_side, max_picture_pixels));
    map.drawn = camera;
    map.drawn.distortion.reset();
    map.drawn_size = (high - low).array().round().cast<int>() + 1;
    map.drawn.intrinsics =
        Intrinsics{focal.x(), focal.y(), -low.x(), -low.y(), map.drawn_size.x(), map.drawn_size.y()};
}

}  // namespace

size_t LensMap::nearest(size_t pixel) const {
    if (source.empty()) return pixel;
    const int x = std::clamp(int(std::lround(source[pixel].x())), 0, drawn_size.x() - 1);
    const int y = std::clamp(int(std::lround(source[pixel].y())), 0, drawn_size.y() - 1);
    return size_t(y) * size_t(drawn_size.x()) + size_t(x);
}

Vec2d LensMap::drawn_slope(size_t pixel) const {
    const Intrinsics& k = *drawn.intrinsics;
    const auto width = size_t(drawn_size.x());
    const size_t row = pixel / width;
    return {(double(pixel % width) - k.cx) / k.fx, (double(row) - k.cy) / k.fy};
}

LensMap lens_map(const Camera& camera, Vec2i size) {
    LensMap map;
    map.size = map.drawn_size = size;
    map.drawn = camera;
    if (!camera.is_warped()) return map;
    const std::vector<Vec2d> slopes = undistorted_slopes(camera, size);
    choose_drawn(camera, slopes, map);
    const Intrinsics& k = *map.drawn.intrinsics;
    for (const Vec2d& s : slopes) {
        map.slopes.push_back(s.cast<float>());
        map.source.push_back(Vec2d(k.fx * s.x() + k.cx, k.fy * s.y() + k.cy).cast<float>());
    }
    return map;
}

Camera drawn_before(const Camera& before, const Camera& now, const LensMap& map) {
    Camera drawn = before;
    drawn.distortion.reset();
    if (!drawn.intrinsics) return drawn;
    drawn.intrinsics->skew = 0;
    if (map.is_identity() || before.projection != Projection::perspective) return drawn;
    const Mat3d K = before.opencv_K(map.size.x(), map.size.y()),
                K_now = now.opencv_K(map.size.x(), map.size.y());
    const Intrinsics& wide = *map.drawn.intrinsics;
    drawn.intrinsics = Intrinsics{
        K(0, 0),    K(1, 1),    wide.cx + (K(0, 2) - K_now(0, 2)), wide.cy + (K(1, 2) - K_now(1, 2)),
        wide.width, wide.height};
    return drawn;
}

namespace {

/// Light of the sRGB codes, from 0 to 1.
template <class T>
const float* light_of_codes() {
    if constexpr (std::is_same_v<T, uint8_t>) {
        return srgb8_table();
    } else {
        static const std::vector<float> table = [] {
            constexpr size_t most = std::numeric_limits<T>::max();
            std::vector<float> values(most + 1);
            for (size_t i = 0; i <= most; ++i) values[i] = linear_from_srgb(float(i) / float(most));
            return values;
        }();
        return table.data();
    }
}

/// The nearest sRGB code of 8 bits of light from 0 to 1, without a power per pixel.
uint8_t code_of_light(float light) {
    constexpr size_t cells = 4096;
    struct Table {
        /// Light from which each code is nearer than the one before.
        std::array<float, 257> limits;
        /// The code at the lower end of each cell. On the straight part of the curve, its flattest, codes are
        /// 1 / (255 * 12.92) = 1 / 3295 apart: no cell holds two limits.
        std::array<uint8_t, cells + 1> starts;
    };
    static const Table table = [] {
        Table made{};
        made.limits.back() = std::numeric_limits<float>::infinity();
        for (size_t code = 1; code < 256; ++code)
            made.limits[code] = linear_from_srgb((float(code) - 0.5f) / 255);
        for (size_t cell = 0; cell <= cells; ++cell)
            made.starts[cell] = uint8_t(std::ranges::upper_bound(made.limits, float(cell) / float(cells)) -
                                        made.limits.begin() - 1);
        return made;
    }();
    const size_t start = table.starts[size_t(light * float(cells))];
    return uint8_t(start + size_t(light >= table.limits[start + 1]));
}

/// The nearest sRGB code of light from 0 to 1.
template <class T>
T code_of(float light) {
    if constexpr (std::is_same_v<T, uint8_t>)
        return code_of_light(light);
    else
        return T(std::lround(srgb_from_linear(light) * float(std::numeric_limits<T>::max())));
}

/// Mixes what codes stand for: light, which counts as far as it covers its pixel.
template <class T, class Mix>
void mix_pixels(const std::array<const T*, 4>& near, Mix&& mix, T* to) {
    const auto is_first = [&](const T* pixel) { return std::equal(pixel, pixel + 4, near[0]); };
    if (std::ranges::all_of(near, is_first)) {
        std::copy_n(near[0], 4, to);
        return;
    }
    const float* const light = light_of_codes<T>();
    const float alpha = mix(near[0][3], near[1][3], near[2][3], near[3][3]);
    to[3] = T(std::lround(alpha));
    for (int c = 0; c < 3; ++c) {
        const auto covered = [&](size_t i) { return light[near[i][c]] * float(near[i][3]); };
        const float mixed = alpha > 0 ? mix(covered(0), covered(1), covered(2), covered(3)) / alpha : 0;
        // A mean of values from 0 to 1; rounding alone may lead beyond them.
        to[c] = code_of<T>(std::clamp(mixed, 0.0f, 1.0f));
    }
}

/// Of premultiplied light.
template <class Mix>
void mix_pixels(const std::array<const float*, 4>& near, Mix&& mix, float* to) {
    for (int c = 0; c < 4; ++c) to[c] = mix(near[0][c], near[1][c], near[2][c], near[3][c]);
}

/// Whether one of four neighbours, the upper left one at (x, y), is marked.
bool touches(const Image& marks, int x, int y) {
    const uint8_t *upper = marks.at<uint8_t>(x, y), *lower = marks.at<uint8_t>(x, y + 1);
    return upper[0] || upper[1] || lower[0] || lower[1];
}

template <class T>
void warp_pixels(const Image& drawn, const LensMap& map, const Image* exact, Image& picture) {
    parallel_for(map.source.size(), 1 << 12, [&](size_t i) {
        const Vec2 p = map.source[i];
        const int x = std::clamp(int(std::floor(p.x())), 0, drawn.width() - 2);
        const int y = std::clamp(int(std::floor(p.y())), 0, drawn.height() - 2);
        const float u = p.x() - float(x), v = p.y() - float(y);
        const auto mix = [&](float a, float b, float c, float d) {
            return (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
        };
        const std::array<const T*, 4> near = {drawn.at<T>(x, y), drawn.at<T>(x + 1, y), drawn.at<T>(x, y + 1),
                                              drawn.at<T>(x + 1, y + 1)};
        T* to = picture.pixels<T>().data() + 4 * i;
        if (exact && touches(*exact, x, y)) {
            std::copy_n(drawn.pixels<T>().data() + 4 * map.nearest(i), 4, to);
            return;
        }
        mix_pixels(near, mix, to);
    });
}

}  // namespace

Image pick_nearest(const Image& drawn, const LensMap& map) {
    if (map.is_identity()) return drawn;
    const size_t channels = size_t(drawn.channels());
    Image picture(map.size.x(), map.size.y(), drawn.channels(), drawn.type());
    const float* from = drawn.pixels<float>().data();
    float* to = picture.pixels<float>().data();
    parallel_for(map.source.size(), 1 << 14, [&](size_t i) {
        std::copy_n(from + map.nearest(i) * channels, channels, to + i * channels);
    });
    return picture;
}

Image warp(const Image& drawn, const LensMap& map, const Image* exact) {
    if (map.is_identity()) return drawn;
    if (drawn.channels() != 4) throw std::logic_error("warp: expected RGBA");
    Image picture(map.size.x(), map.size.y(), drawn.channels(), drawn.type());
    switch (drawn.type()) {
        case PixelType::u8:
            warp_pixels<uint8_t>(drawn, map, exact, picture);
            break;
        case PixelType::u16:
            warp_pixels<uint16_t>(drawn, map, exact, picture);
            break;
        case PixelType::f32:
            warp_pixels<float>(drawn, map, exact, picture);
            break;
    }
    return picture;
}

const std::shared_ptr<const LensMap>& LensCache::get(const Camera& camera, Vec2i size) {
    std::vector<double> key = {double(size.x()), double(size.y())};
    if (camera.is_warped()) {
        const Intrinsics& k = *camera.intrinsics;
        key.insert(key.end(), {k.fx, k.fy, k.cx, k.cy, double(k.width), double(k.height), k.skew});
        if (camera.distortion) {
            key.push_back(double(camera.distortion->model));
            key.insert(key.end(), camera.distortion->k.begin(), camera.distortion->k.end());
        }
    }
    if (key != key_) {
        map_ = std::make_shared<const LensMap>(lens_map(camera, size));
        key_ = std::move(key);
    }
    return map_;
}

}  // namespace easypbr::app
