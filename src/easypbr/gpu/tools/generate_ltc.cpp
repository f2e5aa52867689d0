// Writes the table of gpu/ltc.h as a C++ array. Usage: generate_ltc OUTPUT
//
// Linearly transformed cosines (Heitz et al. 2016): for each angle of view and roughness the matrix M for
// which the distribution of M applied to cosine-distributed directions is nearest to that of the light that
// GGX reflects, with F = 1 and height-correlated masking.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <thread>
#include <vector>

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int nodes = 32;                  // as ltc_size in gpu/ltc.h
constexpr int samples_per_axis = 24;       // of each of the two distributions
constexpr double least_roughness = 0.045;  // as shaders/lighting_surface.frag

double squared(double x) {
    return x * x;
}

/// The lobe of one angle of view: BRDF times cosine over its albedo, and its sampling.
struct Lobe {
    Vector3d view;
    double alpha;

    double masked(double cosine) const {
        return std::sqrt(squared(alpha) + (1 - squared(alpha)) * squared(cosine));
    }
    /// GGX (Walter et al. 2007) with height-correlated Smith masking (Heitz 2014), times the cosine.
    double value(const Vector3d& l) const {
        if (l.z() <= 0) return 0;
        const Vector3d h = (view + l).normalized();
        const double a2 = squared(alpha),
                     d = a2 / (std::numbers::pi * squared(squared(h.z()) * (a2 - 1) + 1));
        const double v = 0.5 / (l.z() * masked(view.z()) + view.z() * masked(l.z()));
        return d * v * l.z();
    }
    double density(const Vector3d& l) const {
        const Vector3d h = (view + l).normalized();
        if (h.z() <= 0) return 0;
        const double a2 = squared(alpha),
                     d = a2 / (std::numbers::pi * squared(squared(h.z()) * (a2 - 1) + 1));
        return d / (2 * (view.z() + masked(view.z())));
    }
    /// By visible normals (Heitz 2018).
    Vector3d sample(double u1, double u2) const {
        const Vector3d v = Vector3d(alpha * view.x(), 0, view.z()).normalized();
        const Vector3d t1 = Vector3d::UnitY(), t2 = v.cross(t1);
        const double r = std::sqrt(u1), phi = 2 * std::numbers::pi * u2, p1 = r * std::cos(phi),
                     s = 0.5 * (1 + v.z());
        const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
        const Vector3d n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * v;
        const Vector3d h = Vector3d(alpha * n.x(), alpha * n.y(), std::max(1e-12, n.z())).normalized();
        return 2 * view.dot(h) * h - view;
    }
};

/// ln m11, ln m22, m13 / m11 of the matrix, in the frame of the lobe's mean direction.
using Parameters = std::array<double, 3>;

Matrix3d matrix_of(const Parameters& p, const Vector3d& mean) {
    Matrix3d frame, shape = Matrix3d::Identity();
    const Vector3d x(mean.z(), 0, -mean.x());
    frame << x, Vector3d::UnitY(), mean;
    shape(0, 0) = std::exp(p[0]);
    shape(1, 1) = std::exp(p[1]);
    shape(0, 2) = p[2] * shape(0, 0);
    return frame * shape;
}

/// A transformed cosine.
struct Transformed {
    Matrix3d M, inverse;
    double determinant;

    explicit Transformed(const Matrix3d& m)
        : M(m), inverse(m.inverse()), determinant(std::abs(m.determinant())) {}
    double density(const Vector3d& l) const {
        const Vector3d before = inverse * l;
        const double length = before.norm();
        return std::max(before.z() / length, 0.0) / std::numbers::pi /
               (determinant * length * length * length);
    }
    Vector3d sample(double u1, double u2) const {
        const double r = std::sqrt(u1), phi = 2 * std::numbers::pi * u2;
        return (M * Vector3d(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u1))).normalized();
    }
};

struct Target {
    Lobe lobe;
    double albedo = 0;
    Vector3d mean = Vector3d::UnitZ();
    std::vector<Vector3d> directions = {};  ///< of the lobe
};

Target target_of(const Lobe& lobe) {
    Target target{.lobe = lobe};
    Vector3d sum(0, 0, 0);
    for (int i = 0; i < samples_per_axis; ++i)
        for (int j = 0; j < samples_per_axis; ++j) {
            const Vector3d l = lobe.sample((i + 0.5) / samples_per_axis, (j + 0.5) / samples_per_axis);
            const double density = lobe.density(l);
            if (density <= 0) continue;
            target.directions.push_back(l);
            const double weight = lobe.value(l) / density;
            target.albedo += weight / (samples_per_axis * samples_per_axis);
            sum += weight * l;
        }
    sum.y() = 0;
    target.mean = sum.normalized();
    return target;
}

/// The mean of |difference|^3 over both distributions' samples, combined by MIS (Heitz et al. 2016).
double error(const Parameters& p, const Target& target) {
    const Transformed cosine(matrix_of(p, target.mean));
    double sum = 0;
    const auto add = [&](const Vector3d& l) {
        const double brdf = target.lobe.value(l) / target.albedo, ltc = cosine.density(l);
        const double both = target.lobe.density(l) + ltc;
        if (both > 0) sum += std::pow(std::abs(brdf - ltc), 3) / both;
    };
    for (const Vector3d& l : target.directions) add(l);
    for (int i = 0; i < samples_per_axis; ++i)
        for (int j = 0; j < samples_per_axis; ++j)
            add(cosine.sample((i + 0.5) / samples_per_axis, (j + 0.5) / samples_per_axis));
    return sum;
}

/// Nelder and Mead 1965, over the first `count` parameters.
template <class Function>
Parameters least(Parameters start, int count, double step, Function&& function) {
    struct Vertex {
        Parameters at;
        double value;
    };
    std::vector<Vertex> simplex{{start, function(start)}};
    for (int i = 0; i < count; ++i) {
        Parameters at = start;
        at[size_t(i)] += step;
        simplex.push_back({at, function(at)});
    }
    const auto along = [&](const Parameters& centre, const Parameters& worst, double by) {
        Parameters at = centre;
        for (size_t k = 0; k < size_t(count); ++k) at[k] += by * (centre[k] - worst[k]);
        return Vertex{at, function(at)};
    };
    for (int iteration = 0; iteration < 120; ++iteration) {
        std::ranges::sort(simplex, {}, &Vertex::value);
        if (simplex.back().value - simplex.front().value <= 1e-6 * simplex.front().value) break;
        Parameters centre = simplex.front().at;
        for (size_t k = 0; k < size_t(count); ++k) {
            centre[k] = 0;
            for (size_t v = 0; v < size_t(count); ++v) centre[k] += simplex[v].at[k] / count;
        }
        Vertex& worst = simplex.back();
        const Vertex reflected = along(centre, worst.at, 1);
        if (reflected.value < simplex.front().value) {
            const Vertex expanded = along(centre, worst.at, 2);
            worst = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < simplex[size_t(count) - 1].value) {
            worst = reflected;
        } else {
            const Vertex contracted = along(centre, worst.at, -0.5);
            if (contracted.value < worst.value) {
                worst = contracted;
                continue;
            }
            for (size_t v = 1; v < simplex.size(); ++v) {
                for (size_t k = 0; k < size_t(count); ++k)
                    simplex[v].at[k] = 0.5 * (simplex[v].at[k] + simplex[0].at[k]);
                simplex[v].value = function(simplex[v].at);
            }
        }
    }
    return std::ranges::min_element(simplex, {}, &Vertex::value)->at;
}

/// The entries of one row of roughness, from the view along the normal on: each fit starts from the one
/// before it.
void fit_row(int row, std::vector<float>& table) {
    const double roughness = std::max(double(row) / (nodes - 1), least_roughness);
    Parameters p{2 * std::log(roughness), 2 * std::log(roughness), 0};
    for (int i = nodes - 1; i >= 0; --i) {
        const double root = std::max(double(i), 0.25) / (nodes - 1), n_dot_v = root * root;
        const Target target =
            target_of({Vector3d(std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v), squared(roughness)});
        if (i == nodes - 1) {
            // Along the normal the lobe is isotropic.
            p = least(p, 1, 0.1, [&](Parameters one) { return error({one[0], one[0], 0}, target); });
            p[1] = p[0];
        } else {
            p = least(p, 3, 0.1, [&](const Parameters& all) { return error(all, target); });
        }
        Matrix3d inverse = matrix_of(p, target.mean).inverse();
        inverse /= inverse(1, 1);
        float* to = &table[size_t(4) * size_t(row * nodes + i)];
        to[0] = float(inverse(0, 0));
        to[1] = float(inverse(0, 2));
        to[2] = float(inverse(2, 0));
        to[3] = float(inverse(2, 2));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::vector<float> table(size_t(4) * size_t(nodes * nodes));
    const auto rows = [&](int first) {
        for (int row = first; row < nodes; row += 2) fit_row(row, table);
    };
    std::thread odd(rows, 1);
    rows(0);
    odd.join();
    std::FILE* out = std::fopen(argv[1], "w");
    if (!out) return 1;
    std::fprintf(out, "constexpr float ltc_inverse[%zu] = {", table.size());
    for (size_t i = 0; i < table.size(); ++i)
        std::fprintf(out, "%s%.8ef,", i % 8 ? "" : "\n", double(table[i]));
    std::fprintf(out, "};\n");
    return std::fclose(out);
}
