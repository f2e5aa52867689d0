#include "easypbr/render/raytrace/bright_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "easypbr/core/luminance.h"
#include "easypbr/render/raytrace/cdf.h"

namespace easypbr::render {
namespace {

/// Of the light: less is a rounding.
constexpr double least_bright_part = 1e-3;

}  // namespace

Vec2i pixel_at(const Vec2& uv, Vec2i size) {
    const auto pixel = [](float at, int count) { return std::clamp(int(at * float(count)), 0, count - 1); };
    return {pixel(uv.x(), size.x()), pixel(uv.y(), size.y())};
}

void BrightSky::prepare(const Image& map) {
    const int w = map.width(), h = map.height();
    size_ = {w, h};
    const auto light_of = [&](int x, int y) {
        const float* p = map.at<float>(x, y);
        return double(p[0]) + p[1] + p[2];
    };
    const auto solid_angle_of = [&](int y) {
        return 2 * pi / w * (std::cos(pi * y / h) - std::cos(pi * (y + 1) / h));
    };
    double all = 0, bright = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) all += light_of(x, y) * solid_angle_of(y);
    const double mean = all / (4 * pi);
    texels_.assign(size_t(w) * size_t(h), Vec4::Zero());
    row_ends_.assign(size_t(h), 0);
    pixel_ends_.assign(texels_.size(), 0);
    for (int y = 0; y < h; ++y) {
        double row = 0;
        const size_t first = size_t(y) * size_t(w);
        for (size_t i = first; i < first + size_t(w); ++i) {
            texels_[i].head<3>() = Eigen::Map<const Vec3>(map.at<float>(int(i - first), y));
            texels_[i].w() = float(std::max(light_of(int(i - first), y) - mean, 0.0));
            row += texels_[i].w() * solid_angle_of(y);
            pixel_ends_[i] = float(row);
        }
        bright += row;
        row_ends_[size_t(y)] = float(bright);
        for (size_t i = first; i < first + size_t(w) && row > 0; ++i) pixel_ends_[i] /= float(row);
    }
    bright_part_ = bright > least_bright_part * all ? float(bright / all) : 0;
    brightness_ = bright_part_ > 0 ? float(bright / 3) : 0;
    for (Vec4& texel : texels_) texel.w() /= float(std::max(bright, 1e-30));
    for (float& value : row_ends_) value /= float(std::max(bright, 1e-30));
    row_guide_.clear();
    pixel_guide_.clear();
    row_cosines_.clear();
    add_guide(row_ends_, row_guide_);
    for (int y = 0; y < h; ++y)
        add_guide(std::span<const float>(pixel_ends_).subspan(size_t(y) * size_t(w), size_t(w)),
                  pixel_guide_);
    for (int y = 0; y <= h; ++y) row_cosines_.push_back(std::cos(pi * y / h));
}

float BrightSky::light_on(const Vec3& normal) const {
    const int w = size_.x(), h = size_.y();
    std::vector<Vec2> across;  // of the columns
    for (int x = 0; x < w; ++x) {
        const double phi = 2 * pi * ((x + 0.5) / w - 0.5);
        across.emplace_back(float(std::sin(phi)), float(-std::cos(phi)));
    }
    const Vec2 level(normal.x(), normal.z());
    double sum = 0;
    for (int y = 0; y < h; ++y) {
        const double cosine = (row_cosines_[size_t(y)] + row_cosines_[size_t(y) + 1]) / 2;
        const auto sine = float(std::sqrt(1 - cosine * cosine));
        float row = 0;
        for (int x = 0; x < w; ++x)
            row += luminance(texels_[size_t(y) * size_t(w) + size_t(x)].head<3>()) *
                   std::max(0.0f, normal.y() * float(cosine) + sine * level.dot(across[size_t(x)]));
        sum += row * (row_cosines_[size_t(y)] - row_cosines_[size_t(y) + 1]);
    }
    return float(sum * 2 / w);
}

const Vec4& BrightSky::texel(const Vec2& uv) const {
    const Vec2i at = pixel_at(uv, size_);
    return texels_[size_t(at.y()) * size_t(size_.x()) + size_t(at.x())];
}

void BrightSky::sample(std::span<const Vec2> points, std::span<Sample> samples) const {
    constexpr size_t together = 64;
    const auto w = size_t(size_.x());
    struct Found {
        size_t y, x;
        float within_row, within_pixel;
    };
    std::array<Found, together> found;
    for (size_t begin = 0; begin < points.size(); begin += together) {
        const size_t count = std::min(together, points.size() - begin);
        const auto each = [&](auto&& visit) {
            for (size_t i = 0; i < count; ++i) visit(points[begin + i], found[i]);
        };
        each([&](const Vec2& u, Found& at) {
            at.y = step_of(row_ends_, row_guide_, u.y(), at.within_row);
            __builtin_prefetch(&pixel_guide_[at.y * w + guide_place(w, u.x())]);
        });
        each([&](const Vec2& u, Found& at) {
            __builtin_prefetch(&pixel_ends_[at.y * w + pixel_guide_[at.y * w + guide_place(w, u.x())]]);
        });
        each([&](const Vec2& u, Found& at) {
            const size_t first = at.y * w;
            at.x = step_of(std::span(pixel_ends_).subspan(first, w),
                           std::span(pixel_guide_).subspan(first, w), u.x(), at.within_pixel);
            __builtin_prefetch(&texels_[first + at.x]);
        });
        for (size_t i = 0; i < count; ++i) {
            const Found& at = found[i];
            // Even over the sphere within a row.
            const double top = row_cosines_[at.y], bottom = row_cosines_[at.y + 1];
            const Vec4& texel = texels_[at.y * w + at.x];
            samples[begin + i] = {(float(at.x) + at.within_pixel) / float(w),
                                  top + (bottom - top) * at.within_row, texel.head<3>(), texel.w()};
        }
    }
}

float BrightSky::Sample::sin_theta() const {
    return float(std::sqrt(std::max(0.0, (1 - cos_theta) * (1 + cos_theta))));
}

Vec3 BrightSky::Sample::direction() const {
    const float phi = float(2 * pi) * (u - 0.5f), sine = sin_theta();
    return {sine * std::sin(phi), float(cos_theta), -sine * std::cos(phi)};
}

}  // namespace easypbr::render
