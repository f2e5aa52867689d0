// The lobes of glTF's material extensions in double precision, from the papers and the extensions' texts, for
// tests.
#pragma once

#include <cmath>

#include "easypbr/core/math.h"

namespace easypbr::reference {

inline double schlick(double cosine, double f0, double f90 = 1) {
    return f0 + (f90 - f0) * std::pow(1 - cosine, 5);
}

/// GGX with height-correlated Smith masking, D V, for directions in a frame whose z is the normal.
inline double ggx(const Vec3d& v, const Vec3d& l, double alpha_x, double alpha_y) {
    const Vec3d h = (v + l).normalized();
    const auto stretched = [&](const Vec3d& d) {
        return std::sqrt(alpha_x * alpha_x * d.x() * d.x() + alpha_y * alpha_y * d.y() * d.y() +
                         d.z() * d.z());
    };
    const double q = std::pow(h.x() / alpha_x, 2) + std::pow(h.y() / alpha_y, 2) + h.z() * h.z();
    const double D = 1 / (pi * alpha_x * alpha_y * q * q);
    return D * 0.5 / (l.z() * stretched(v) + v.z() * stretched(l));
}

/// Estevez and Kulla 2017, D V.
inline double charlie(const Vec3d& v, const Vec3d& l, double roughness) {
    const double alpha = roughness * roughness, s = (1 - alpha) * (1 - alpha);
    const auto mix = [&](double a, double b) { return a * (1 - s) + b * s; };
    const auto fit = [&](double x) {
        return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
               mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
    };
    const auto lambda = [&](double c) {
        return c < 0.5 ? std::exp(fit(c)) : std::exp(2 * fit(0.5) - fit(1 - c));
    };
    const double h_z = (v + l).normalized().z();
    const double D = (2 + 1 / alpha) * std::pow(1 - h_z * h_z, 0.5 / alpha) / (2 * pi);
    return D / ((1 + lambda(v.z()) + lambda(l.z())) * 4 * v.z() * l.z());
}

/// Integral over the hemisphere of f(l) cos(l) for a view with cosine n_dot_v; steps get finer to the
/// horizon.
template <class Lobe>
double albedo(double n_dot_v, Lobe&& lobe, int steps = 300) {
    const Vec3d v(std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double u = (i + 0.5) / steps, c = u * u, sine = std::sqrt(1 - c * c);
        for (int j = 0; j < steps; ++j) {
            const double phi = 2 * pi * (j + 0.5) / steps;
            sum += lobe(v, Vec3d(sine * std::cos(phi), sine * std::sin(phi), c)) * c * 2 * u * 2 * pi;
        }
    }
    return sum / (double(steps) * steps);
}

/// Reflectance of a thin film in air by the Airy series of the extension (Belcour and Barla 2017), linear
/// Rec.709.
inline Vec3d film(double cosine, double film_ior, double thickness_nm, double f0) {
    const auto between = [](double a, double b) { return std::pow((a - b) / (a + b), 2); };
    const double inner = std::sqrt(1 - (1 - cosine * cosine) / (film_ior * film_ior));
    const double base_ior = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
    const double R12 = schlick(cosine, between(film_ior, 1)),
                 R23 = schlick(inner, between(base_ior, film_ior));
    const double shift = pi + (base_ior < film_ior ? pi : 0), path = 2 * film_ior * thickness_nm * inner;
    const double T = 1 - R12, R123 = R12 * R23, Rs = T * T * R23 / (1 - R123);
    Vec3d sum = Vec3d::Constant(R12 + Rs);
    double C = Rs - T;
    Mat3d rgb_from_xyz;
    rgb_from_xyz << 3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434,
        -0.2040259, 1.0572252;
    for (int m = 1; m <= 2; ++m) {
        C *= std::sqrt(R123);
        const double phase = 2 * pi * m * path * 1e-9;
        const auto gauss = [&](double val, double pos, double var) {
            return val * std::sqrt(2 * pi * var) * std::cos(pos * phase + m * shift) *
                   std::exp(-var * phase * phase);
        };
        const Vec3d xyz(gauss(5.4856e-13, 1.6810e6, 4.3278e9) + gauss(9.7470e-14, 2.2399e6, 4.5282e9),
                        gauss(4.4201e-13, 1.7953e6, 9.3046e9), gauss(5.2481e-13, 2.2084e6, 6.6121e9));
        sum += 2 * C * (rgb_from_xyz * xyz) / 1.0685e-7;
    }
    return sum.cwiseMax(0.0).cwiseMin(1.0);
}

}  // namespace easypbr::reference
