// 3D Gaussian splats: their projection, colour, order, and what hides them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "easypbr/core/color.h"
#include "easypbr/render/pipeline/tiles.h"
#include "easypbr/scene/merge.h"
#include "render_test.h"

namespace easypbr::render::gaussian_splat_test {
namespace {

constexpr double distance = 4, fov_y_deg = 30;
constexpr float code = 1.0f / 255;
constexpr double constant = 0.28209479177387814;

struct Splat {
    Vec3d mean{0, 0, 0}, scales{0.1, 0.1, 0.1};
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    double opacity = 0.8;
    Eigen::Matrix<double, Eigen::Dynamic, 3> sh = Eigen::Matrix<double, 1, 3>::Zero();
};

Eigen::Matrix<double, 1, 3> sh_of(const Vec3d& color) {
    return (color.transpose().array() - 0.5) / constant;
}

MeshData mesh_of(const std::vector<Splat>& splats) {
    const auto n = Eigen::Index(splats.size());
    Array3f::Dense V(n, 3), scales(n, 3);
    Array4f::Dense rotations(n, 4);
    Array1f::Dense opacities(n);
    ArrayXf::Dense sh(n, splats.front().sh.size());
    for (Eigen::Index i = 0; i < n; ++i) {
        const Splat& s = splats[size_t(i)];
        V.row(i) = s.mean.transpose().cast<float>();
        scales.row(i) = s.scales.transpose().cast<float>();
        rotations.row(i) << float(s.rotation.w()), float(s.rotation.x()), float(s.rotation.y()),
            float(s.rotation.z());
        opacities(i) = float(s.opacity);
        for (Eigen::Index k = 0; k < s.sh.rows(); ++k)
            for (Eigen::Index c = 0; c < 3; ++c) sh(i, 3 * k + c) = float(s.sh(k, c));
    }
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    return mesh;
}

app::Session session_of(const Scene& scene, int size) {
    app::Session session = plain_session(scene, size);
    look_from(session, Vec3d(0, 0, distance), float(fov_y_deg));
    return session;
}

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

/// One wide splat whose opacity in the middle of the picture is known.
Splat wide_splat(double z) {
    Splat splat;
    splat.mean = Vec3d(0, 0, z);
    splat.scales = Vec3d(5, 5, 0.01);
    splat.opacity = 0.75;
    splat.sh = sh_of(Vec3d(1, 0, 0));
    return splat;
}

Mesh unlit_square(const Vec3& color, float opacity = 1) {
    Material material;
    material.unlit = true;
    material.emissive = Vec3::Zero();
    material.base_color = color;
    material.opacity = opacity;
    if (opacity < 1) material.alpha_mode = AlphaMode::blend;
    return facing_square(0.5f, material);
}

Eigen::Vector4f middle_of(const Scene& scene, bool native = true, int samples = 1) {
    app::Session session = session_of(scene, 32);
    session.allow_native_geometry(native);
    session.allow_native_shading(native);
    const Image image = render_linear(session, samples);
    return Eigen::Map<const Eigen::Vector4f>(image.at<float>(16, 16));
}

TEST(GaussianSplats, AreHiddenBySurfacesBeforeThem) {
    for (const bool native : {true, false})
        for (const int samples : {1, 4}) {
            Scene scene;
            scene.show(unlit_square(Vec3(0, 1, 0)), "square");
            scene.show(Mesh(mesh_of({wide_splat(-0.5)})), "splat");
            EXPECT_LT((middle_of(scene, native, samples) - Eigen::Vector4f(0, 1, 0, 1)).norm(), 1e-3f);
        }
}

// Surfaces behind show by what splats let through, 1/4.
TEST(GaussianSplats, LetSurfacesBehindThrough) {
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
TEST(GaussianSplats, AreBeforeAndBehindLayers) {
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
TEST(GaussianSplats, AreCutBySurfaces) {
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

// Half of a splat is before a half-transparent square, and half behind it: both let sqrt(1/4) through.
TEST(GaussianSplats, AreCutByLayers) {
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
TEST(GaussianSplats, AreBehindAndBeforeLines) {
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
TEST(GaussianSplats, AreInOrderWithLinesAndLayers) {
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

TEST(GaussianSplats, AreDrawnOverEverythingWhereAsked) {
    Mesh splat(mesh_of({wide_splat(-0.5)}));
    splat.edit([](MeshData& data) { data.style.overlay = true; });
    Scene scene;
    scene.show(unlit_square(Vec3(0, 1, 0)), "square");
    scene.show(splat, "splat");
    for (const bool native : {true, false})
        EXPECT_LT((middle_of(scene, native) - Eigen::Vector4f(0.75f, 0.25f, 0, 1)).norm(), 2e-3f);
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
