// 3D Gaussian splats among surfaces, layers and lines: what is before and behind them.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "single_splats.h"

namespace easypbr::render::gaussian_splat_order_test {
namespace {

using namespace single_splats;

TEST(GaussianSplatOrder, AreHiddenBySurfacesBeforeThem) {
    for (const bool native : {true, false})
        for (const int samples : {1, 4}) {
            Scene scene;
            scene.show(unlit_square(Vec3(0, 1, 0)), "square");
            scene.show(Mesh(mesh_of({wide_splat(-0.5)})), "splat");
            EXPECT_LT((middle_of(scene, native, samples) - Eigen::Vector4f(0, 1, 0, 1)).norm(), 1e-3f);
        }
}

// Surfaces behind show by what splats let through, 1/4.
TEST(GaussianSplatOrder, LetSurfacesBehindThrough) {
    for (const bool native : {true, false})
        for (const int samples : {1, 4}) {
            Scene scene;
            scene.show(unlit_square(Vec3(0, 1, 0)), "square");
            scene.show(Mesh(mesh_of({wide_splat(0.5)})), "splat");
            // The middle is half a pixel beside the splat's, which is hundreds of pixels wide.
            EXPECT_LT((middle_of(scene, native, samples) - Eigen::Vector4f(0.75f, 0.25f, 0, 1)).norm(), 2e-3f)
                << native << samples;
        }
}

// A half-opaque square between two splats: red, then green over it, then red.
TEST(GaussianSplatOrder, AreBeforeAndBehindLayers) {
    Scene scene;
    scene.show(unlit_square(Vec3(0, 1, 0), 0.5f), "square");
    scene.show(Mesh(mesh_of({wide_splat(0.5), wide_splat(-0.5)})), "splats");
    const float behind = 0.75f * 0.5f, red = 0.75f + 0.25f * behind, green = 0.25f * 0.5f;
    EXPECT_LT((middle_of(scene) - Eigen::Vector4f(red, green, 0, red + green)).norm(), 4e-3f);
}

/// A splat that is thick along the view, `deviations` standard deviations before the plane z = 0.
Splat thick_splat(double deviations, double thickness) {
    Splat splat = wide_splat(deviations * thickness);
    splat.scales.z() = thickness;
    return splat;
}

double normal_cdf(double deviations) {
    return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

// A surface hides the part of a splat's density along the ray that is behind it: of a medium that lets 1/4
// through, the part p before the surface lets 4^-p through.
TEST(GaussianSplatOrder, AreCutBySurfaces) {
    for (const bool native : {true, false})
        for (const bool resort : {false, true})
            for (const double deviations : {-4.0, -1.5, -0.5, 0.0, 0.5, 1.5, 4.0}) {
                Scene scene;
                scene.show(unlit_square(Vec3(0, 1, 0)), "square");
                const double thickness = resort ? 0.02 : 0.5;
                scene.show(Mesh(mesh_of({thick_splat(deviations, thickness)})), "splat");
                const double through = std::pow(0.25, normal_cdf(deviations));
                for (const bool soft : {true, false}) {
                    app::Session session = session_of(scene, 32);
                    session.settings().splats.resort = resort;
                    session.settings().splats.soft = soft;
                    session.allow_native_geometry(native);
                    session.allow_native_shading(native);
                    const Image image = render_linear(session);
                    // Without soft cuts all of it is seen, or nothing; in its middle that is a rounding.
                    const double green = soft ? through : deviations > 0 ? 0.25 : 1;
                    if (!soft && deviations == 0) continue;
                    EXPECT_NEAR(image.at<float>(16, 16)[1], green, code)
                        << native << resort << soft << deviations;
                    EXPECT_NEAR(image.at<float>(16, 16)[0], 1 - green, code) << native << resort << soft;
                }
            }
}

// A ball beside the camera's axis, whose density along each ray is that of the Gaussian in space: densest
// where the ray is nearest to the mean, with the ball's standard deviation. Its opacity is that of the
// picture without the square, the same to a code. By the depth to first order in the pixel it would be up to
// 0.16 off.
TEST(GaussianSplatOrder, AreCutWhereTheyAreDensestAlongTheRay) {
    constexpr int size = 48;
    constexpr double eye = 4, wall = 0.27, deviation = 0.1;
    const Vec3d mean(0.1, 0.05, 0.2);  // x, y and depth
    Splat ball;
    ball.mean = Vec3d(mean.x(), mean.y(), eye - mean.z());
    ball.scales = Vec3d::Constant(deviation);
    ball.opacity = 0.99;
    ball.sh = sh_of(Vec3d(1, 0, 0));
    Scene alone, cut;
    for (Scene* scene : {&alone, &cut}) scene->show(Mesh(mesh_of({ball})), "splat");
    Mesh square = unlit_square(Vec3(0, 1, 0));
    square.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, eye - wall)));
    cut.show(square, "square");
    for (const bool native : {true, false})
        for (const bool resort : {false, true}) {
            const auto draw = [&](const Scene& scene) {
                app::Session session = session_of(scene, size);
                look_from(session, Vec3d(0, 0, eye), 60);
                session.settings().camera.near = 0.01;
                session.settings().splats.resort = resort;
                session.allow_native_geometry(native);
                session.allow_native_shading(native);
                return render_linear(session, 1);
            };
            const Image whole = draw(alone), image = draw(cut);
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const double slope = std::tan(radians(30.0)) / (size / 2.0);
                    const Vec3d ray((x + 0.5 - size / 2.0) * slope, (size / 2.0 - y - 0.5) * slope, 1);
                    const double depth = ray.dot(mean) / ray.squaredNorm(),
                                 before = normal_cdf((wall - depth) * ray.norm() / deviation),
                                 through = std::pow(1 - double(whole.at<float>(x, y)[3]), before);
                    ASSERT_NEAR(double(image.at<float>(x, y)[1]), through, code)
                        << native << resort << " " << x << " " << y;
                }
        }
}

// Half of a splat is before a half-transparent square, and half behind it: both let sqrt(1/4) through.
TEST(GaussianSplatOrder, AreCutByLayers) {
    Scene scene;
    scene.show(unlit_square(Vec3(0, 1, 0), 0.5f), "square");
    scene.show(Mesh(mesh_of({thick_splat(0, 0.02)})), "splat");
    const float red = 0.5f + 0.5f * 0.5f * 0.5f, green = 0.5f * 0.5f;
    EXPECT_LT((middle_of(scene) - Eigen::Vector4f(red, green, 0, red + green)).norm(), 4e-3f);
}

/// A horizontal line through the picture's middle in the plane z.
Mesh blue_line(float z, float width) {
    Array3f::Dense V(2, 3);
    V << -2, 0, z, 2, 0, z;
    Array2i::Dense E(1, 2);
    E << 0, 1;
    MeshData data;
    data.V = std::move(V);
    data.E = std::move(E);
    data.style.line_color = Vec3(0, 0, 1);
    data.style.line_width = width;
    return Mesh(std::move(data));
}

// A line covers the splat behind it, and the splat before it covers a part of the line: red of 0.75.
TEST(GaussianSplatOrder, AreBehindAndBeforeLines) {
    for (const bool native : {true, false})
        for (const float width : {1.0f, 9.0f})
            for (const float z : {-1.0f, 0.0f, 1.0f}) {
                Scene scene;
                scene.show(blue_line(z, width), "line");
                scene.show(Mesh(mesh_of({wide_splat(0.5), wide_splat(-0.5)})), "splats");
                const double before = z > 0.5f ? 0 : z > -0.5f ? 1 : 2;
                app::Session session = session_of(scene, 49);
                session.allow_native_geometry(native);
                session.allow_native_shading(native);
                const Image image = render_linear(session);
                const float* middle = image.at<float>(24, 24);
                const double blue = std::pow(0.25, before);
                EXPECT_NEAR(middle[2], blue, 4e-3) << native << width << z;
                EXPECT_NEAR(middle[0], 1 - blue, 4e-3) << native << width << z;
                // Beside the line, and where it covers a part of a pixel, are no seams: a sixteenth comes
                // through both splats, and at the rim, 0.2 standard deviations from their middles, a
                // fourteenth.
                for (int y = 0; y < 49; ++y)
                    EXPECT_GE(image.at<float>(24, y)[3], 1 - 1 / 13.5) << native << width << z << y;
            }
}

// Of the splats before and behind a line some are behind a half-opaque square too.
TEST(GaussianSplatOrder, AreInOrderWithLinesAndLayers) {
    for (const float z : {-1.0f, -0.25f, 0.25f, 1.0f}) {
        Scene scene;
        scene.show(unlit_square(Vec3(0, 1, 0), 0.5f), "square");
        scene.show(blue_line(z, 9), "line");
        scene.show(Mesh(mesh_of({wide_splat(0.5), wide_splat(-0.5)})), "splats");
        // From the back: red, green, red, and blue in its place.
        std::vector<std::pair<float, Eigen::Vector4f>> parts{{-0.5f, {0.75f, 0, 0, 0.75f}},
                                                             {0.0f, {0, 0.5f, 0, 0.5f}},
                                                             {0.5f, {0.75f, 0, 0, 0.75f}},
                                                             {z, {0, 0, 1, 1}}};
        std::ranges::sort(parts, {}, &std::pair<float, Eigen::Vector4f>::first);
        Eigen::Vector4f expected = Eigen::Vector4f::Zero();
        for (const auto& [place, part] : parts) expected = part + (1 - part.w()) * expected;
        EXPECT_LT((middle_of(scene) - expected).norm(), 6e-3f) << z;
    }
}

TEST(GaussianSplatOrder, AreDrawnOverEverythingWhereAsked) {
    Mesh splat(mesh_of({wide_splat(-0.5)}));
    splat.edit([](MeshData& data) { data.style.overlay = true; });
    Scene scene;
    scene.show(unlit_square(Vec3(0, 1, 0)), "square");
    scene.show(splat, "splat");
    for (const bool native : {true, false})
        EXPECT_LT((middle_of(scene, native) - Eigen::Vector4f(0.75f, 0.25f, 0, 1)).norm(), 2e-3f);
}

}  // namespace
}  // namespace easypbr::render::gaussian_splat_order_test
