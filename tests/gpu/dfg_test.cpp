#include "easypbr/gpu/dfg.h"
#include "easypbr/scene/settings.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace easypbr::gpu::dfg_test {
namespace {

/// A and B as the shader reads them: bilinear between the nodes.
Eigen::Vector2d look_up(Brdf brdf, double n_dot_v, double roughness) {
    const auto table = dfg_table(brdf);
    const double x = std::sqrt(n_dot_v) * (dfg_size - 1), y = roughness * (dfg_size - 1);
    const int x0 = std::min(int(x), dfg_size - 2), y0 = std::min(int(y), dfg_size - 2);
    const auto node = [&](int i, int j) {
        const uint16_t* p = table.data() + 2 * (j * dfg_size + i);
        const auto value = [](uint16_t half) {
            return double(Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(half)));
        };
        return Eigen::Vector2d(value(p[0]), value(p[1]));
    };
    const double fx = x - x0, fy = y - y0;
    return (node(x0, y0) * (1 - fx) + node(x0 + 1, y0) * fx) * (1 - fy) +
           (node(x0, y0 + 1) * (1 - fx) + node(x0 + 1, y0 + 1) * fx) * fy;
}

// Quadrature with 2000 x 400 nodes of the height-correlated form, good to 1e-4. The table interpolates 64 x
// 64 nodes of 11-bit floats: 0.002 is what a picture of 8 bits cannot show.
TEST(Dfg, MatchesQuadrature) {
    const double views[] = {0.05, 0.10, 0.25, 0.50, 0.75, 1.00};
    struct Row {
        double roughness;
        double ab[6][2];
    };
    const Row rows[] = {
        {0.10,
         {{.2426, .7337}, {.4158, .5784}, {.7629, .2362}, {.9683, .0314}, {.9989, .0010}, {.9999, .0000}}},
        {0.25,
         {{.4493, .4448}, {.5051, .3916}, {.7580, .2035}, {.9557, .0326}, {.9923, .0015}, {.9957, .0000}}},
        {0.50,
         {{.7688, .1643}, {.7519, .1397}, {.7593, .0808}, {.8349, .0223}, {.8888, .0027}, {.9158, .0000}}},
        {0.75,
         {{.8398, .0651}, {.7958, .0526}, {.7165, .0279}, {.6547, .0085}, {.6312, .0016}, {.6268, .0000}}},
        {1.00,
         {{.8157, .0321}, {.7363, .0239}, {.5868, .0109}, {.4477, .0030}, {.3639, .0006}, {.3068, .0000}}}};
    for (const Row& row : rows)
        for (int i = 0; i < 6; ++i) {
            const Eigen::Vector2d ab = look_up(Brdf::height_correlated, views[i], row.roughness);
            EXPECT_NEAR(ab.x(), row.ab[i][0], 0.002)
                << "A at NoV " << views[i] << " roughness " << row.roughness;
            EXPECT_NEAR(ab.y(), row.ab[i][1], 0.002)
                << "B at NoV " << views[i] << " roughness " << row.roughness;
        }
}

// The same quadrature with the other two geometry terms.
TEST(Dfg, OtherGeometryTerms) {
    EXPECT_NEAR(look_up(Brdf::ue4, 0.1, 0.25).x(), .3913, 0.002);
    EXPECT_NEAR(look_up(Brdf::ue4, 0.5, 0.50).x(), .7285, 0.002);
    EXPECT_NEAR(look_up(Brdf::ue4, 0.5, 1.00).x(), .4067, 0.002);
    EXPECT_NEAR(look_up(Brdf::separable, 0.5, 0.5).x(), .8329, 0.002);
    EXPECT_NEAR(look_up(Brdf::separable, 0.1, 1.0).x(), .5444, 0.002);
}

}  // namespace
}  // namespace easypbr::gpu::dfg_test
