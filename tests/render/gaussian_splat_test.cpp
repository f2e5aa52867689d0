// 3D Gaussian splats: their projection, colour and light.
#include <algorithm>
#include <cmath>
#include <random>

#include "easypbr/core/color.h"
#include "easypbr/render/pipeline/tiles.h"
#include "easypbr/scene/merge.h"
#include "shadow_test.h"
#include "single_splats.h"

namespace easypbr::render::gaussian_splat_test {
namespace {

using namespace single_splats;

/// sRGB-encoded colour, premultiplied, as splats are composed.
Eigen::Vector4d encoded(const float* light) {
    const double a = double(light[3]);
    Eigen::Vector4d result(0, 0, 0, a);
    if (a > 0)
        for (int c = 0; c < 3; ++c) result[c] = a * double(srgb_from_linear(float(double(light[c]) / a)));
    return result;
}

double sum_of_alpha(const Image& image) {
    double sum = 0;
    for (size_t i = 3; i < image.pixels<float>().size(); i += 4) sum += double(image.pixels<float>()[i]);
    return sum;
}

/// Pixels per unit at the distance of the origin, times that distance.
double focal(int size) {
    return size / 2.0 / std::tan(radians(fov_y_deg / 2));
}

double gaussian(const Eigen::Matrix2d& covariance, const Vec2d& d) {
    return std::exp(-0.5 * d.dot(covariance.inverse() * d));
}

double least_seen(double alpha) {
    return alpha < 1.0 / 255 ? 0 : alpha;
}

// A style asks for what a mesh has no data for: the mesh is drawn as points by every kind of light.
TEST(GaussianSplats, WithoutDataArePoints) {
    const auto picture = [](DrawMode mode, bool rays, bool paths) {
        Mesh ball = make_sphere(0.5f, 16);
        ball.edit([&](MeshData& data) { data.style.mode = mode; });
        Scene scene;
        scene.show(ball, "ball");
        scene.show(rectangle(-2, -2, 2, 2, -0.6f), "behind");
        app::Session session = session_of(scene, 32);
        session.settings().environment.enabled = true;
        session.settings().ssao.enabled = true;
        session.settings().rays.enabled = rays;
        session.settings().path.enabled = paths;
        return render_linear(session, paths ? 4 : 1);
    };
    for (const bool rays : {false, true})
        for (const bool paths : {false, true}) {
            const Image splats = picture(DrawMode::splats, rays, paths),
                        points = picture(DrawMode::points, rays, paths);
            EXPECT_TRUE(std::ranges::equal(splats.bytes(), points.bytes())) << rays << paths;
        }
}

// The closed form: before the camera's axis the projection scales by f / z, and 0.3 square pixels are added.
TEST(GaussianSplats, OneIsItsProjectedGaussian) {
    constexpr int size = 96;
    Splat splat;
    splat.scales = Vec3d(0.25, 0.1, 0.4);
    splat.rotation = Eigen::AngleAxisd(radians(30.0), Vec3d::UnitZ());
    const Vec3d color(0.9, 0.5, 0.2);
    splat.sh = sh_of(color);
    Scene scene;
    scene.show(Mesh(mesh_of({splat})), "splat");
    app::Session session = session_of(scene, size);
    const Image image = render_linear(session);
    const double scale = focal(size) / distance;
    Eigen::Matrix2d axes = Eigen::Rotation2Dd(radians(30.0)).toRotationMatrix() *
                           Eigen::Vector2d(0.25, 0.1).asDiagonal() * scale;
    axes.row(1) *= -1;  // Rows count downwards.
    const Eigen::Matrix2d covariance = axes * axes.transpose() + 0.3 * Eigen::Matrix2d::Identity();
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const Vec2d d(x + 0.5 - size / 2.0, y + 0.5 - size / 2.0);
            const double alpha = least_seen(0.8 * gaussian(covariance, d));
            const Eigen::Vector4d seen = encoded(image.at<float>(x, y));
            ASSERT_NEAR(seen.w(), alpha, code) << x << " " << y;
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(seen[c], alpha * color[c], code) << x << " " << y;
        }
}

/// Real spherical harmonics from the standard library's associated Legendre functions.
double harmonic(int l, int m, const Vec3d& d) {
    const double theta = std::acos(std::clamp(d.z(), -1.0, 1.0)), phi = std::atan2(d.y(), d.x());
    const double value = std::sph_legendre(unsigned(l), unsigned(std::abs(m)), theta);
    if (m == 0) return value;
    return std::sqrt(2.0) * value * (m > 0 ? std::cos(m * phi) : std::sin(-m * phi));
}

Vec3d color_of(const Splat& splat, const Vec3d& direction) {
    Vec3d color(0.5, 0.5, 0.5);
    Eigen::Index k = 0;
    for (int l = 0; k < splat.sh.rows(); ++l)
        for (int m = -l; m <= l; ++m, ++k) color += harmonic(l, m, direction) * splat.sh.row(k).transpose();
    return color.cwiseMax(0.0);
}

std::vector<Splat> random_splats(size_t count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Splat> splats(count);
    for (Splat& s : splats) {
        s.mean = Vec3d(uniform(random), uniform(random), uniform(random));
        for (double& scale : s.scales) scale = 0.02 * std::exp(1.5 * uniform(random));
        s.rotation = Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random));
        s.rotation.normalize();
        s.opacity = 0.5 + 0.5 * uniform(random);
        s.sh.resize(16, 3);
        for (double& value : s.sh.reshaped()) value = 0.4 * uniform(random);
    }
    return splats;
}

/// A splat's covariance on the screen, by the derivative of the projection.
Eigen::Matrix2d covariance_of(const Splat& s, double f) {
    const double z = distance - s.mean.z();
    Eigen::Matrix<double, 2, 3> J;
    J << f / z, 0, f * s.mean.x() / (z * z), 0, -f / z, -f * s.mean.y() / (z * z);
    const Eigen::Matrix<double, 2, 3> axes = J * s.rotation.toRotationMatrix() * s.scales.asDiagonal();
    return axes * axes.transpose() + 0.3 * Eigen::Matrix2d::Identity();
}

/// All of them for each pixel, from the nearest on, in double precision.
std::vector<Eigen::Vector4d> brute_force(std::vector<Splat> splats, int size) {
    std::ranges::sort(splats, std::greater{}, [](const Splat& s) { return s.mean.z(); });
    const double f = focal(size);
    std::vector<Eigen::Vector4d> pixels(size_t(size) * size_t(size), Eigen::Vector4d::Zero());
    for (const Splat& s : splats) {
        const Eigen::Matrix2d covariance = covariance_of(s, f);
        const double z = distance - s.mean.z();
        const Vec2d centre(size / 2.0 + f * s.mean.x() / z, size / 2.0 - f * s.mean.y() / z);
        const Vec3d color = color_of(s, (s.mean - Vec3d(0, 0, distance)).normalized());
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                Eigen::Vector4d& pixel = pixels[size_t(y) * size_t(size) + size_t(x)];
                const double alpha = std::min(
                    0.99, least_seen(s.opacity * gaussian(covariance, Vec2d(x + 0.5, y + 0.5) - centre)));
                pixel += (1 - pixel.w()) * alpha * Eigen::Vector4d(color.x(), color.y(), color.z(), 1);
            }
    }
    return pixels;
}

TEST(GaussianSplats, AreThoseOfABruteForceCompositor) {
    constexpr int size = 96;
    const std::vector<Splat> splats = random_splats(600);
    Scene scene;
    scene.show(Mesh(mesh_of(splats)), "splats");
    app::Session session = session_of(scene, size);
    const Image image = render_linear(session);
    const std::vector<Eigen::Vector4d> expected = brute_force(splats, size);
    double most = 0, covered = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
        const Eigen::Vector4d seen = encoded(&image.pixels<float>()[4 * i]);
        most = std::max(most, (seen - expected[i]).cwiseAbs().maxCoeff());
        covered += expected[i].w();
    }
    EXPECT_LT(most, 2.0 / 255);
    EXPECT_GT(covered, 0.3 * size * size);  // The scene shows something.
}

TEST(GaussianSplats, DoNotDependOnTheirOrder) {
    std::vector<Splat> splats = random_splats(400);
    // Some are equally deep.
    for (size_t i = 0; i < 100; ++i) splats[i].mean.z() = 0.25;
    std::vector<Splat> others = splats;
    std::ranges::shuffle(others, std::mt19937(3));
    const auto picture_of = [](const std::vector<Splat>& shown) {
        Scene scene;
        // In two sets, which are one order.
        const size_t half = shown.size() / 2;
        scene.show(Mesh(mesh_of({shown.begin(), shown.begin() + long(half)})), "first");
        scene.show(Mesh(mesh_of({shown.begin() + long(half), shown.end()})), "second");
        app::Session session = session_of(scene, 96);
        session.use_device(DrawDevice::cpu);  // A GPU keeps the order of splats that are equally deep.
        return render_linear(session);
    };
    EXPECT_TRUE(std::ranges::equal(picture_of(splats).bytes(), picture_of(others).bytes()));
}

// A power of two leaves the bits of all numbers but their exponents.
TEST(GaussianSplats, AreTheSameAtAnyScale) {
    const auto picture_at = [](double scale) {
        std::vector<Splat> splats = random_splats(300);
        for (Splat& s : splats) {
            s.mean *= scale;
            s.scales *= scale;
        }
        Scene scene;
        scene.show(Mesh(mesh_of(splats)), "splats");
        app::Session session = session_of(scene, 96);
        session.settings().camera.position = Vec3d(0, 0, distance * scale);
        return render_linear(session);
    };
    EXPECT_TRUE(std::ranges::equal(picture_at(1).bytes(), picture_at(1024).bytes()));
}

// A pose does to a set what the same map does to its data.
TEST(GaussianSplats, FollowTheirPose) {
    const MeshData data = mesh_of(random_splats(300));
    const Eigen::Affine3d T = Eigen::Translation3d(0.1, -0.2, 0.3) *
                              Eigen::AngleAxisd(0.7, Vec3d(1, 2, 3).normalized()) * Eigen::Scaling(1.25);
    const auto picture_of = [](const Mesh& mesh) {
        Scene scene;
        scene.show(mesh, "splats");
        app::Session session = session_of(scene, 96);
        return render_linear(session);
    };
    Mesh posed(data), moved(transformed(data, T));
    posed.set_T_parent_mesh(T);
    const Image a = picture_of(posed), b = picture_of(moved);
    // Means of single precision are off by 1e-7, and so is what is seen of them, but for a splat that is at
    // the least opacity that is seen: 1/255.
    for (size_t i = 0; i < a.pixels<float>().size(); ++i)
        ASSERT_NEAR(a.pixels<float>()[i], b.pixels<float>()[i], 1.5f * code) << i;
}

TEST(GaussianSplats, AreTheSameNativelyAndThroughTheDriver) {
    Scene scene;
    scene.show(Mesh(mesh_of(random_splats(300))), "splats");
    scene.show(unlit_square(Vec3(0, 0.5f, 1)), "square");
    const auto picture = [&](bool native) {
        app::Session session = session_of(scene, 96);
        session.allow_native_geometry(native);
        session.allow_native_shading(native);
        return render_linear(session);
    };
    const Image a = picture(true), b = picture(false);
    for (size_t i = 0; i < a.pixels<float>().size(); ++i)
        ASSERT_NEAR(a.pixels<float>()[i], b.pixels<float>()[i], code) << i;
}

// The samples of a pixel are spread evenly over it: their mean is wider by the pixel, and has the same light.
TEST(GaussianSplats, KeepTheirLightWhereSamplesAreAveraged) {
    Splat splat;
    splat.scales = Vec3d(0.05, 0.05, 0.05);
    splat.opacity = 0.9;
    splat.sh = sh_of(Vec3d(1, 1, 1));
    Scene scene;
    scene.show(Mesh(mesh_of({splat})), "splat");
    app::Session session = session_of(scene, 64);
    const double one = sum_of_alpha(render_linear(session)), many = sum_of_alpha(render_linear(session, 16));
    EXPECT_NEAR(many, one, 0.005 * one);  // What is below 1/255 differs.
}

// Widened to the low-pass, a small splat covers more; where the style asks for it, as much as it does itself.
TEST(GaussianSplats, KeepTheirLightWhereAskedFor) {
    constexpr int size = 64;
    Splat splat;
    const double pixels = 0.4;  // standard deviation
    splat.scales = Vec3d::Constant(pixels * distance / focal(size));
    splat.opacity = 0.9;
    splat.sh = sh_of(Vec3d(1, 1, 1));
    Scene scene;
    scene.show(Mesh(mesh_of({splat})), "splat");
    app::Session session = session_of(scene, size);
    const auto sum = [&](bool antialias) {
        session.settings().style.splat_antialias = antialias;
        return sum_of_alpha(render_linear(session));
    };
    // The integral of a Gaussian is 2 pi sigma^2; what is below 1/255 is missing: at most 3 %.
    const double own = 2 * pi * 0.9 * pixels * pixels, widened = 2 * pi * 0.9 * (pixels * pixels + 0.3);
    EXPECT_NEAR(sum(true), own, 0.03 * own);
    EXPECT_NEAR(sum(false), widened, 0.03 * widened);
}

// What is beyond a tile's border is projected as in the whole picture.
TEST(GaussianSplats, AreSeamlessInTiles) {
    std::vector<Splat> splats = random_splats(200);
    // Some are larger than a tile and reach out of the picture.
    for (size_t i = 0; i < 20; ++i) splats[i].scales *= 30;
    Scene scene;
    scene.show(Mesh(mesh_of(splats)), "splats");
    const Vec2i size(720, 420);
    app::Session whole = session_of(scene, 64), parts = session_of(scene, 64);
    for (app::Session* session : {&whole, &parts}) session->settings().image.size = size;
    const int guard = guard_of(parts.scene().snapshot(), parts.resolve(), size).pixels;
    const int side = 2 * guard + 2 * tile_grid;
    const TileLimits limits{side, int64_t(side) * side};
    ASSERT_GT(tiles_of(size, guard, limits).size(), 4u);
    parts.limit_tiles(limits);
    const Image a = render_linear(whole), b = render_linear(parts);
    for (size_t i = 0; i < a.pixels<float>().size(); ++i)
        ASSERT_NEAR(a.pixels<float>()[i], b.pixels<float>()[i], code) << i;
}

TEST(GaussianSplats, MayBeColouredByTheirData) {
    Mesh mesh(mesh_of({wide_splat(0)}));
    mesh.edit([](MeshData& data) {
        ArrayXf::Dense C(1, 3);
        C << 0, 0, 1;
        data.C = std::move(C);
    });
    Scene scene;
    scene.show(mesh, "splat");
    EXPECT_NEAR(middle_of(scene)[0], 0.75f, 2e-3f);
    Style style;
    style.color_by = ColorBy::vertex;
    mesh.set_style(style);
    EXPECT_NEAR(middle_of(scene)[0], 0, 1e-3f);
    EXPECT_NEAR(middle_of(scene)[2], 0.75f, 2e-3f);
}

}  // namespace
}  // namespace easypbr::render::gaussian_splat_test
