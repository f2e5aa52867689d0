// Writes the tables of gpu/dfg.h as C++ arrays. Usage: generate_dfg OUTPUT
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>
#include <vector>

namespace {

constexpr int size = 64;     // as dfg_size in gpu/dfg.h
constexpr int samples = 72;  // per axis; with strata that are finest in the tail the error is below 2e-4
constexpr double pi = 3.14159265358979323846;

enum class Model { height_correlated, separable, ue4 };

double lambda(double cosine, double alpha) {
    const double c2 = cosine * cosine;
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - c2) / c2) - 1.0);
}

double masking_shadowing(Model model, double n_dot_v, double n_dot_l, double alpha) {
    if (model == Model::ue4) {
        // Karis 2013: k = alpha / 2 for image-based lighting.
        const double k = alpha / 2;
        return n_dot_v / (n_dot_v * (1 - k) + k) * (n_dot_l / (n_dot_l * (1 - k) + k));
    }
    const double v = lambda(n_dot_v, alpha), l = lambda(n_dot_l, alpha);
    return model == Model::separable ? 1.0 / ((1.0 + v) * (1.0 + l)) : 1.0 / (1.0 + v + l);
}

/// A visible normal of GGX for a view direction in the xz plane (Heitz 2018).
Eigen::Vector3d visible_normal(const Eigen::Vector3d& view, double alpha, double u1, double u2) {
    const Eigen::Vector3d v = Eigen::Vector3d(alpha * view.x(), 0, view.z()).normalized();
    const Eigen::Vector3d t1 = Eigen::Vector3d::UnitY();
    const Eigen::Vector3d t2 = v.cross(t1);
    const double r = std::sqrt(u1), phi = 2 * pi * u2;
    const double p1 = r * std::cos(phi), s = 0.5 * (1 + v.z());
    const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * r * std::sin(phi);
    const Eigen::Vector3d n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2)) * v;
    return Eigen::Vector3d(alpha * n.x(), alpha * n.y(), std::max(1e-12, n.z())).normalized();
}

/// A and B by importance sampling: the weight of a visible normal is F G2 / G1.
Eigen::Vector2d integrate(Model model, double n_dot_v, double roughness) {
    const double alpha = std::max(roughness * roughness, 1e-4);
    const Eigen::Vector3d view(std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v);
    Eigen::Vector2d sum(0, 0);
    double total = 0;
    for (int i = 0; i < samples; ++i) {
        // Equal strata would miss GGX's long tail, which is what falls below the horizon.
        const double rest = 1 - (i + 0.5) / samples, stratum = 3 * rest * rest;
        for (int j = 0; j < samples; ++j) {
            total += stratum;
            const Eigen::Vector3d h =
                visible_normal(view, alpha, 1 - rest * rest * rest, (j + 0.5) / samples);
            const double v_dot_h = std::max(0.0, view.dot(h));
            const double n_dot_l = (2 * v_dot_h * h - view).z();
            if (n_dot_l <= 0) continue;
            const double weight =
                masking_shadowing(model, n_dot_v, n_dot_l, alpha) * (1 + lambda(n_dot_v, alpha));
            const double fresnel = std::pow(1 - v_dot_h, 5);
            sum += stratum * weight * Eigen::Vector2d(1 - fresnel, fresnel);
        }
    }
    return sum / total;
}

std::vector<uint16_t> table(Model model) {
    std::vector<uint16_t> halves(2 * size * size);
    const auto rows = [&](int first) {
        for (int j = first; j < size; j += 2)
            for (int i = 0; i < size; ++i) {
                const double root = std::max(double(i), 0.25) / (size - 1);
                const Eigen::Vector2d ab = integrate(model, root * root, double(j) / (size - 1));
                for (int c = 0; c < 2; ++c)
                    halves[2 * (j * size + i) + c] = Eigen::half_impl::float_to_half_rtne(float(ab[c])).x;
            }
    };
    std::thread odd(rows, 1);
    rows(0);
    odd.join();
    return halves;
}

/// Fit of the sheen's shadowing by Estevez and Kulla 2017, in the words of shaders/common_lobes.glsl.
double charlie_fit(double x, double smooth2) {
    const auto mix = [&](double rough, double smooth) { return rough + (smooth - rough) * smooth2; };
    return mix(21.5473, 25.3245) / (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
           mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
}

double charlie_lambda(double cosine, double roughness) {
    const double smooth2 = std::pow(1 - roughness * roughness, 2);
    return cosine < 0.5 ? std::exp(charlie_fit(cosine, smooth2))
                        : std::exp(2 * charlie_fit(0.5, smooth2) - charlie_fit(1 - cosine, smooth2));
}

/// Integral of the sheen's lobe times the cosine; steps are finest towards the horizon, where the lobe is.
double sheen_albedo(double n_dot_v, double roughness) {
    constexpr int steps = 96;
    const double inverse = 1 / (roughness * roughness), lambda_v = charlie_lambda(n_dot_v, roughness);
    const double sine_v = std::sqrt(1 - n_dot_v * n_dot_v);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double u = (i + 0.5) / steps, n_dot_l = u * u, sine_l = std::sqrt(1 - n_dot_l * n_dot_l);
        const double visibility =
            1 / ((1 + lambda_v + charlie_lambda(n_dot_l, roughness)) * 4 * n_dot_v * n_dot_l);
        for (int j = 0; j < steps; ++j) {
            const double phi = pi * (j + 0.5) / steps;
            const Eigen::Vector3d h(sine_l * std::cos(phi) + sine_v, sine_l * std::sin(phi),
                                    n_dot_l + n_dot_v);
            const double sine2 = std::max(1 - h.z() * h.z() / h.squaredNorm(), 1e-8);
            const double d = (2 + inverse) * std::pow(sine2, 0.5 * inverse) / (2 * pi);
            // dcos = 2 u du, and the half circle stands for the whole.
            sum += d * visibility * n_dot_l * 2 * u * 2 * pi;
        }
    }
    return sum / (double(steps) * steps);
}

std::vector<uint16_t> sheen_table() {
    std::vector<uint16_t> halves(size * size);
    const auto rows = [&](int first) {
        for (int j = first; j < size; j += 2)
            for (int i = 0; i < size; ++i) {
                const double root = std::max(double(i), 0.25) / (size - 1);
                // Smoother than this the fit does not hold.
                const double roughness = std::max(0.07, double(j) / (size - 1));
                halves[j * size + i] =
                    Eigen::half_impl::float_to_half_rtne(float(sheen_albedo(root * root, roughness))).x;
            }
    };
    std::thread odd(rows, 1);
    rows(0);
    odd.join();
    return halves;
}

void write(std::FILE* out, const char* name, const std::vector<uint16_t>& halves) {
    std::fprintf(out, "constexpr uint16_t %s[%zu] = {", name, halves.size());
    for (size_t i = 0; i < halves.size(); ++i)
        std::fprintf(out, "%s%u,", i % 16 ? "" : "\n", unsigned(halves[i]));
    std::fprintf(out, "};\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::FILE* out = std::fopen(argv[1], "w");
    if (!out) return 1;
    write(out, "dfg_height_correlated", table(Model::height_correlated));
    write(out, "dfg_separable", table(Model::separable));
    write(out, "dfg_ue4", table(Model::ue4));
    write(out, "sheen_albedo", sheen_table());
    return std::fclose(out);
}
