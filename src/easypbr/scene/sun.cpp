#include "easypbr/scene/sun.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/environment.h"

namespace easypbr {
namespace {

/// How bright the sun is at least, and what around it still belongs to it, in means of the picture.
constexpr double sun_brightness = 50, halo_brightness = 10;
/// Least part of the picture's light.
constexpr double least_part = 0.05;
/// Angles around the sun's brightest pixel: what may belong to it, and what surrounds it.
constexpr double sun_deg = 5, surroundings_deg = 7;
/// The sun seen from the earth: no picture resolves less.
constexpr double least_radius_deg = 0.265;

double luminance_of(const float* p) {
    return 0.2126 * double(p[0]) + 0.7152 * double(p[1]) + 0.0722 * double(p[2]);
}

/// Solid angle of the pixels of a row.
double pixel_solid_angle(const Image& image, int y) {
    const double top = pi * y / image.height(), bottom = pi * (y + 1) / image.height();
    return (std::cos(top) - std::cos(bottom)) * 2 * pi / image.width();
}

Vec3d direction_of(const Image& image, int x, int y) {
    return equirect_direction((float(x) + 0.5f) / float(image.width()),
                              (float(y) + 0.5f) / float(image.height()))
        .cast<double>();
}

struct Brightness {
    double mean = 0, peak = 0;
    int x = 0, y = 0;  ///< of the peak
};

Brightness brightness_of(const Image& image) {
    std::vector<Brightness> rows(size_t(image.height()));
    parallel_for(rows.size(), 16, [&](size_t y) {
        Brightness& row = rows[y];
        row.y = int(y);
        const float* p = image.at<float>(0, int(y));
        for (int x = 0; x < image.width(); ++x, p += 3) {
            const double luminance = luminance_of(p);
            row.mean += luminance;
            if (luminance > row.peak) row.peak = luminance, row.x = x;
        }
        row.mean *= pixel_solid_angle(image, int(y)) / (4 * pi);
    });
    Brightness all;
    for (const Brightness& row : rows) {
        all.mean += row.mean;
        if (row.peak > all.peak) all.peak = row.peak, all.x = row.x, all.y = row.y;
    }
    return all;
}

/// Calls visit(pixel, direction, solid angle, cosine) for all pixels within an angle of a direction.
template <class SomeImage, class Visit>
void for_each_around(SomeImage& image, const Vec3d& centre, double angle_deg, Visit&& visit) {
    const double elevation = std::acos(std::clamp(centre.y(), -1.0, 1.0)), angle = radians(angle_deg);
    const auto row_of = [&](double theta) {
        return std::clamp(int(theta / pi * image.height()), 0, image.height() - 1);
    };
    for (int y = row_of(elevation - angle); y <= row_of(elevation + angle); ++y) {
        const double solid_angle = pixel_solid_angle(image, y);
        for (int x = 0; x < image.width(); ++x) {
            const Vec3d direction = direction_of(image, x, y);
            const double cosine = direction.dot(centre);
            if (cosine >= std::cos(angle))
                visit(image.template at<float>(x, y), direction, solid_angle, cosine);
        }
    }
}

/// Mean luminance of the ring around the sun.
double surroundings_of(const Image& image, const Vec3d& centre) {
    double sum = 0, weight = 0;
    for_each_around(image, centre, surroundings_deg,
                    [&](const float* p, const Vec3d&, double solid_angle, double cosine) {
                        if (cosine > std::cos(radians(sun_deg))) return;
                        sum += luminance_of(p) * solid_angle;
                        weight += solid_angle;
                    });
    return weight > 0 ? sum / weight : 0;
}

}  // namespace

std::optional<SunSplit> split_sun(const Image& image) {
    const Brightness brightness = brightness_of(image);
    if (!(brightness.peak > 0 && brightness.peak >= sun_brightness * brightness.mean)) return std::nullopt;
    const Vec3d centre = direction_of(image, brightness.x, brightness.y);
    const double level = surroundings_of(image, centre),
                 least = std::max(level, halo_brightness * brightness.mean);

    // The vector irradiance of what is taken: exact for every surface that sees all of it.
    Eigen::Matrix3d flux = Eigen::Matrix3d::Zero();  // columns: channels
    double power = 0;
    for_each_around(image, centre, sun_deg, [&](const float* p, const Vec3d& d, double solid_angle, double) {
        const double luminance = luminance_of(p);
        if (luminance <= least) return;
        const double part = 1 - level / luminance;
        flux += part * solid_angle * d * Vec3d(p[0], p[1], p[2]).transpose();
        power += part * solid_angle * luminance;
    });
    if (!(power >= least_part * pi * brightness.mean)) return std::nullopt;
    const Vec3d towards = (flux * Vec3d(0.2126, 0.7152, 0.0722)).normalized();
    SunSplit split{{}, image};
    double spread = 0;
    for_each_around(split.rest, centre, sun_deg, [&](float* p, const Vec3d& d, double solid_angle, double) {
        const double luminance = luminance_of(p);
        if (luminance <= least) return;
        spread += (luminance - level) * solid_angle * d.cross(towards).squaredNorm();
        for (int c = 0; c < 3; ++c) p[c] *= float(level / luminance);
    });
    Sun& sun = split.sun;
    sun.towards = towards.cast<float>();
    for (int c = 0; c < 3; ++c) sun.irradiance[c] = float(std::max(0.0, flux.col(c).dot(towards)));
    // An even disc of radius a has the mean squared distance a^2 / 2.
    sun.angular_radius_deg =
        float(std::max(least_radius_deg, degrees(std::asin(std::min(1.0, std::sqrt(2 * spread / power))))));
    return split;
}

}  // namespace easypbr
