#include "easypbr/scene/environment.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <vector>

#include "easypbr/core/hash.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/scene/sun.h"

namespace easypbr {

namespace {

/// Integrals over the sphere of radiance times 1, x, y, z, xy, yz, xz, 3y^2 - 1, x^2 - z^2.
using Moments = std::array<Vec3d, 9>;

/// cos and sin of phi and of 2 phi, integrated over each column, where phi = 2 pi (u - 1/2).
struct ColumnTable {
    explicit ColumnTable(int width)
        : step(2 * pi / width), cos1(width), sin1(width), cos2(width), sin2(width) {
        const double chord1 = 2 * std::sin(step / 2), chord2 = std::sin(step);
        for (int x = 0; x < width; ++x) {
            const double phi = (x + 0.5) * step - pi;
            cos1[x] = chord1 * std::cos(phi);
            sin1[x] = chord1 * std::sin(phi);
            cos2[x] = chord2 * std::cos(2 * phi);
            sin2[x] = chord2 * std::sin(2 * phi);
        }
    }
    double step;
    std::vector<double> cos1, sin1, cos2, sin2;
};

/// Integrals over theta0 .. theta1 of the polar factors of the moments, sin(theta) of the solid angle
/// included.
struct RowIntegrals {
    RowIntegrals(double theta0, double theta1) {
        const double c0 = std::cos(theta0), c1 = std::cos(theta1), s0 = std::sin(theta0),
                     s1 = std::sin(theta1);
        const double cubes = (c0 * c0 * c0 - c1 * c1 * c1) / 3;
        one = c0 - c1;
        cos = (s1 * s1 - s0 * s0) / 2;
        sin = (theta1 - theta0 - (s1 * c1 - s0 * c0)) / 2;
        zonal = 3 * cubes - one;
        sin_cos = (s1 * s1 * s1 - s0 * s0 * s0) / 3;
        sin_sin = one - cubes;
    }
    double one, cos, sin, zonal, sin_cos, sin_sin;
};

/// A pixel is taken as a patch of constant radiance and integrated exactly, so that no energy is lost at any
/// size.
Moments row_moments(const Image& image, const ColumnTable& columns, int y) {
    Vec3d sum = Vec3d::Zero(), cos1 = sum, sin1 = sum, cos2 = sum, sin2 = sum;
    const float* pixel = image.at<float>(0, y);
    for (int x = 0; x < image.width(); ++x, pixel += 3) {
        const Vec3d radiance(pixel[0], pixel[1], pixel[2]);
        sum += radiance;
        cos1 += columns.cos1[x] * radiance;
        sin1 += columns.sin1[x] * radiance;
        cos2 += columns.cos2[x] * radiance;
        sin2 += columns.sin2[x] * radiance;
    }
    sum *= columns.step;
    const RowIntegrals row(pi * y / image.height(), pi * (y + 1) / image.height());
    return {sum * row.one,
            sin1 * row.sin,
            sum * row.cos,
            -cos1 * row.sin,
            sin1 * row.sin_cos,
            -cos1 * row.sin_cos,
            -0.5 * sin2 * row.sin_sin,
            sum * row.zonal,
            -cos2 * row.sin_sin};
}

/// Coefficients of E/pi as a polynomial of the normal: the moments times the basis' squared norm and the
/// cosine lobe's factors A_l / pi = 1, 2/3, 1/4 (Ramamoorthi and Hanrahan 2001, equation 8).
std::array<Vec3, 9> project(const Image& image) {
    const ColumnTable columns(image.width());
    std::vector<Moments> rows(image.height());
    parallel_for(rows.size(), 16, [&](size_t y) { rows[y] = row_moments(image, columns, int(y)); });

    constexpr double band1 = 1 / (2 * pi), band2 = 15 / (16 * pi);
    constexpr std::array<double, 9> factors{1 / (4 * pi), band1, band1,      band1,    band2,
                                            band2,        band2, band2 / 12, band2 / 4};
    std::array<Vec3, 9> coefficients;
    for (size_t i = 0; i < coefficients.size(); ++i) {
        Vec3d total = Vec3d::Zero();
        for (const Moments& row : rows) total += row[i];
        coefficients[i] = (factors[i] * total).cast<float>();
    }
    return coefficients;
}

/// Puts 0 where a value is no radiance; returns how many there were.
size_t clean(Image& image) {
    const auto values = image.pixels<float>();
    constexpr size_t grain = size_t(1) << 18;
    std::vector<size_t> replaced((values.size() + grain - 1) / grain);
    parallel_chunks(values.size(), grain, [&](size_t begin, size_t end) {
        size_t count = 0;
        for (size_t i = begin; i < end; ++i) {
            const bool valid = values[i] >= 0 && values[i] <= std::numeric_limits<float>::max();
            if (valid) continue;
            values[i] = 0;
            ++count;
        }
        replaced[begin / grain] = count;
    });
    return std::accumulate(replaced.begin(), replaced.end(), size_t(0));
}

Image as_radiance(Image image) {
    if (image.type() != PixelType::f32) image = to_linear_f32(image);
    return image.channels() == 3 ? std::move(image) : with_channels(image, 3);
}

/// Pictures of equal bytes and unequal shape are not the same environment.
std::string hash_of(const Image& image) {
    const std::string key =
        fmt::format("{}x{} {}", image.width(), image.height(), content_hash(image.bytes()));
    return content_hash(std::as_bytes(std::span(key)));
}

}  // namespace

Vec3 equirect_direction(float u, float v) {
    const float phi = float(2 * pi) * (u - 0.5f), theta = float(pi) * v;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

Vec2 equirect_uv(const Vec3& direction) {
    // atan2 keeps its precision near the poles, where acos(y) loses half of the digits.
    const float theta = std::atan2(std::hypot(direction.x(), direction.z()), direction.y());
    const float phi = std::atan2(direction.x(), -direction.z());
    return {0.5f + phi * float(0.5 / pi), theta * float(1 / pi)};
}

struct Environment::Data {
    Image image;
    std::string name, hash;
    std::array<Vec3, 9> sh;
    std::shared_ptr<Split> split;
};

/// Sun and rest, found when they are first asked for.
struct Environment::Split {
    std::once_flag once;
    std::optional<Sun> sun;
    Environment rest;  ///< empty without a sun
};

Environment::Environment(Image equirect, std::string name) {
    if (equirect.empty())
        throw ArgumentError(fmt::format("environment '{}': expected a picture, got an empty image", name));
    auto data = std::make_shared<Data>();
    data->image = as_radiance(std::move(equirect));
    data->name = std::move(name);
    if (const size_t replaced = clean(data->image))
        log_warning(
            fmt::format("environment '{}': {} values that are NaN, infinite or negative were replaced by 0",
                        data->name, replaced));
    data->hash = hash_of(data->image);
    data->sh = project(data->image);
    data->split = std::make_shared<Split>();
    data_ = std::move(data);
}

const Environment::Data& Environment::data() const {
    static const Data none;
    return empty() ? none : *data_;
}

const Image& Environment::image() const {
    return data().image;
}

const std::string& Environment::name() const {
    return data().name;
}

const std::string& Environment::hash() const {
    return data().hash;
}

const Environment::Split& Environment::split() const {
    static const Split none;
    if (empty()) return none;
    Split& split = *data_->split;
    // Isolated: while the loops inside wait, this thread must not take up a task that asks for the same.
    tbb::this_task_arena::isolate([&] {
        std::call_once(split.once, [&] {
            auto found = split_sun(data_->image);
            if (!found) return;
            split.sun = found->sun;
            split.rest = Environment(std::move(found->rest), data_->name + " without its sun");
        });
    });
    return split;
}

const std::optional<Sun>& Environment::sun() const {
    return split().sun;
}

Environment Environment::without_sun() const {
    return split().sun ? split().rest : *this;
}

Vec3 Environment::irradiance_over_pi(const Vec3& n) const {
    if (empty()) return Vec3::Zero();
    const auto& sh = data_->sh;
    const float x = n.x(), y = n.y(), z = n.z();
    const Vec3 sum = sh[0] + sh[1] * x + sh[2] * y + sh[3] * z + sh[4] * (x * y) + sh[5] * (y * z) +
                     sh[6] * (x * z) + sh[7] * (3 * y * y - 1) + sh[8] * (x * x - z * z);
    return sum.cwiseMax(0.0f);
}

}  // namespace easypbr
