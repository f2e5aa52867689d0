// Point clouds: eye-dome lighting, independence of order and scale, and the two ways to draw them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "easypbr/app/output.h"
#include "easypbr/core/color.h"
#include "easypbr/gl/context.h"
#include "easypbr/render/pipeline/renderer.h"
#include "easypbr/scene/settings.h"
#include "easypbr/scene/spacing.h"
#include "render_test.h"

namespace easypbr::render::point_test {
namespace {

/// A grid of n x n points over [-half, half]^2 at height z(x, y).
template <class Height>
Array3f::Dense grid(int n, double half, Height&& z) {
    Array3f::Dense V(n * n, 3);
    for (int i = 0; i < n * n; ++i) {
        const double x = (2.0 * (i % n) / (n - 1) - 1) * half, y = (2.0 * (i / n) / (n - 1) - 1) * half;
        V.row(i) << float(x), float(y), float(z(x, y));
    }
    return V;
}

Mesh cloud(const Array3f::Dense& V) {
    MeshData data;
    data.V = Array3f(V);
    return Mesh(data);
}

Scene scene_of(const Mesh& mesh) {
    Scene scene;
    scene.show(mesh, "cloud");
    return scene;
}

Image picture(const Scene& scene, const Settings& settings, Vec2i size, bool native = true, int samples = 1) {
    app::Session session(scene);
    session.settings() = settings;
    session.allow_native_geometry(native);
    return session.render({size, samples, app::Encoding::srgb8});
}

bool same(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes());
}

/// White, because what eye-dome lighting leaves of it is then the picture itself.
Mesh white(Mesh mesh) {
    Material material;
    material.base_color = Vec3(1, 1, 1);
    mesh.set_material(material);
    return mesh;
}

TEST(EyeDome, LeavesAFrontoParallelPlaneAsItIs) {
    Scene scene = scene_of(white(cloud(grid(200, 1, [](double, double) { return 0.0; }))));
    app::Session session = plain_session(scene, 128);
    look_from(session, Vec3d(0, 0, 3));
    const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
    int covered = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const uint8_t* p = image.at<uint8_t>(x, y);
            if (p[3] == 0) continue;
            ++covered;
            ASSERT_EQ(int(p[0]), 255) << x << ' ' << y;
        }
    EXPECT_GT(covered, 128 * 128 / 2);
}

// Left half near, right half far: of the pixels at the step only those of the right are darkened.
TEST(EyeDome, DarkensOnlyTheFarSideOfAStep) {
    for (const double step : {0.02, 0.05, 0.2}) {
        Scene scene =
            scene_of(white(cloud(grid(400, 1, [&](double x, double) { return x < 0 ? step : 0.0; }))));
        app::Session session = plain_session(scene, 129);
        look_from(session, Vec3d(0, 0, 3));
        const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
        const auto layers = session.render_layers({"depth"}, Vec2i(129, 129));
        float nearest = 1e30f;
        for (const float d : layers.at("depth").pixels<float>())
            if (d > 0) nearest = std::min(nearest, d);
        int dark = 0;
        for (int y = 10; y < 119; ++y)
            for (int x = 10; x < 119; ++x) {
                const bool is_near = *layers.at("depth").at<float>(x, y) < nearest + step / 2;
                if (is_near) {
                    ASSERT_EQ(int(image.at<uint8_t>(x, y)[0]), 255) << x << ' ' << y;
                }
                dark += image.at<uint8_t>(x, y)[0] < 250;
            }
        // Rings of one, two and four pixels: the far side is darkened up to four pixels from the step.
        EXPECT_GE(dark, 109 * 3) << step;
        EXPECT_LE(dark, 109 * 5) << step;
    }
}

TEST(EyeDome, GrowsWithTheStep) {
    int last = 256;
    for (const double step : {0.0, 0.005, 0.02, 0.08}) {
        Scene scene =
            scene_of(white(cloud(grid(400, 1, [&](double x, double) { return x < 0 ? step : 0.0; }))));
        app::Session session = plain_session(scene, 129);
        look_from(session, Vec3d(0, 0, 3));
        const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
        int darkest = 255;
        for (int x = 50; x < 80; ++x) darkest = std::min(darkest, int(image.at<uint8_t>(x, 64)[0]));
        EXPECT_LT(darkest, last) << step;
        last = darkest;
    }
}

Array3f::Dense random_points(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    Array3f::Dense V(n, 3);
    for (Eigen::Index i = 0; i < V.size(); ++i) V.data()[i] = uniform(random);
    return V;
}

// Lengths enter as multiples of the content's own, and a power of two changes no mantissa.
TEST(Points, LookTheSameAtAnyScale) {
    const Array3f::Dense V = random_points(3000, 1);
    const Image small = picture(scene_of(cloud(V)), {}, Vec2i(200, 150));
    const Image large = picture(scene_of(cloud(V * 1024)), {}, Vec2i(200, 150));
    EXPECT_TRUE(same(small, large));
}

/// Points of random colours, each place taken by two of them.
MeshData coincident(int n) {
    MeshData data;
    const Array3f::Dense V = random_points(n, 2);
    Array3f::Dense twice(2 * n, 3);
    twice << V, V;
    data.V = Array3f(twice);
    data.C = ArrayXf(ArrayXf::Dense((random_points(2 * n, 3).array() / 2 + 0.5f).matrix()));
    return data;
}

TEST(Points, LookTheSameInAnyOrder) {
    const MeshData data = coincident(4000);
    std::vector<int> order(size_t(data.V.rows()));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(4));
    MeshData shuffled = data;
    shuffled.V = Array3f(Array3f::Dense(data.V(order, Eigen::all)));
    shuffled.C = ArrayXf(ArrayXf::Dense(data.C(order, Eigen::all)));
    for (const bool native : {true, false})
        for (const int samples : {1, 4})
            EXPECT_TRUE(same(picture(scene_of(Mesh(data)), {}, Vec2i(200, 150), native, samples),
                             picture(scene_of(Mesh(shuffled)), {}, Vec2i(200, 150), native, samples)))
                << native << ' ' << samples;
}

TEST(Points, HaveTheSizeThatIsAskedFor) {
    Scene scene = scene_of(white(cloud(Array3f::Dense::Zero(1, 3))));
    app::Session session = plain_session(scene, 64);
    look_from(session, Vec3d(0, 0, 4), 45);
    const auto area = [&](bool native) {
        session.allow_native_geometry(native);
        const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
        int covered = 0;
        for (size_t i = 3; i < image.pixels<uint8_t>().size(); i += 4)
            covered += image.pixels<uint8_t>()[i] > 0;
        return covered;
    };
    Style& style = session.settings().style;
    for (const bool native : {true, false}) {
        style.point_shape = PointShape::square;
        style.point_size_unit = SizeUnit::pixels;
        style.point_size = 10.0f;
        EXPECT_EQ(area(native), 100);
        style.point_shape = PointShape::round;
        // Pixel centres in a disc of radius 5 around a pixel corner: 80, counted on paper.
        EXPECT_EQ(area(native), 80);
        // One unit at distance 4 under 45 degrees: 64 / (2 * 4 tan 22.5) = 19.3 pixels.
        style.point_shape = PointShape::square;
        style.point_size_unit = SizeUnit::world;
        style.point_size = 1.0f;
        EXPECT_NEAR(std::sqrt(area(native)), 19.3, 1.0);
    }
}

// A cloud before, in and behind a square: whatever way draws which, the nearer one is seen.
TEST(Points, AndMeshesHideEachOther) {
    Material textured;
    auto texels = std::make_shared<Image>(2, 2, 3, PixelType::u8);
    std::ranges::fill(texels->pixels<uint8_t>(), uint8_t(255));
    textured.base_color_texture.image = texels;
    for (const bool with_texture : {false, true})
        for (const bool native : {true, false}) {
            Scene scene;
            scene.show(facing_square(1, with_texture ? textured : Material{}), "square");
            Array3f::Dense V(2, 3);
            V << -0.5f, 0, 0.2f, 0.5f, 0, -0.2f;
            scene.show(cloud(V), "points");
            app::Session session = plain_session(scene, 64);
            session.allow_native_geometry(native);
            session.settings().style.point_size = 6.0f;
            look_from(session, Vec3d(0, 0, 4));
            const Image id = session.render_layers({"object_id"}).at("object_id");
            // "points" comes before "square" in the order of names. x of 0.5 at depth 3.8 and 4.2.
            EXPECT_EQ(*id.at<float>(32 - 16, 32), 1.0f) << with_texture << native;
            EXPECT_EQ(*id.at<float>(32 + 14, 32), 2.0f) << with_texture << native;
        }
}

// The driver and the native way agree but where a splat's edge runs through a pixel's centre.
TEST(Points, AreDrawnAlikeByBothWays) {
    MeshData data;
    const Array3f::Dense V = random_points(2000, 7).rowwise().normalized();
    data.V = Array3f(V);
    data.C = ArrayXf(ArrayXf::Dense((V.array() / 2 + 0.5f).matrix()));
    for (const bool with_normals : {false, true}) {
        if (with_normals) data.N = data.V;
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Settings settings;
            settings.camera.projection = projection;
            const Image a = picture(scene_of(Mesh(data)), settings, Vec2i(200, 200), true);
            const Image b = picture(scene_of(Mesh(data)), settings, Vec2i(200, 200), false);
            int differ = 0;
            for (size_t i = 0; i < a.pixels<uint8_t>().size(); i += 4) {
                int most = 0;
                for (size_t c = 0; c < 4; ++c)
                    most = std::max(most,
                                    std::abs(int(a.pixels<uint8_t>()[i + c]) - b.pixels<uint8_t>()[i + c]));
                differ += most > 2;
            }
            // 2000 splats, of each of which a few edge pixels lie within the 1/256 pixel that the driver
            // rounds to.
            EXPECT_LT(differ, 200 * 200 / 100) << with_normals << int(projection);
        }
    }
}

// A normal of the sphere itself gives the lit sphere's shading; its sign does not matter.
TEST(Points, WithNormalsAreLit) {
    MeshData data;
    data.V = Array3f(Array3f::Dense(random_points(60000, 8).rowwise().normalized()));
    data.N = Array3f(Array3f::Dense(-data.V));
    Material material;
    material.base_color = Vec3(0.5f, 0.5f, 0.5f);
    material.metallic = 0;
    data.materials = {material};
    Scene points;
    points.show(Mesh(data), "a");
    Mesh sphere = make_sphere(1, 128);
    sphere.set_material(material);
    Scene surface;
    surface.show(sphere, "a");
    const auto shade = [](const Scene& scene) {
        app::Session session = plain_session(scene, 65);
        session.settings().environment.enabled = true;
        session.scene().set_environment(constant_environment(1));
        look_from(session, Vec3d(0, 0, 5));
        return render_linear(session);
    };
    const Image a = shade(points), b = shade(surface);
    // A splat is flat, its normal that of its centre: off by half a splat at most.
    for (const auto& [x, y] : {std::pair{32, 32}, {20, 32}, {40, 44}})
        EXPECT_NEAR(a.at<float>(x, y)[0], b.at<float>(x, y)[0], 0.02) << x << ' ' << y;
}

/// Relative luminance of a grey of 8 bits.
double luminance_of(uint8_t code) {
    return double(linear_from_srgb(Vec3::Constant(float(code) / 255)).x());
}

// Three points without colours before the default background and the dark preset's, whose contrast is 7.4
// (WCAG 2.2): a grey between them has one of 2.7 to both.
TEST(Points, WithoutColorsAreToldFromThePage) {
    for (const char* preset : {"studio", "dark"})
        for (const bool native : {true, false}) {
            app::Session session(scene_of(cloud(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}})));
            app::apply_preset(session, preset);
            session.settings().image.size = Vec2i(64, 64);
            session.settings().style.point_size = 8.0f;
            session.allow_native_geometry(native);
            const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
            const double page = luminance_of(image.at<uint8_t>(0, 0)[0]);
            double most = 0;
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x) {
                    const double point = luminance_of(image.at<uint8_t>(x, y)[0]);
                    const auto [dark, light] = std::minmax(page, point);
                    most = std::max(most, (light + 0.05) / (dark + 0.05));
                }
            EXPECT_GT(most, 2.5) << preset << ", " << native;
        }
}

TEST(Points, OddCloudsGiveAPicture) {
    const auto covered = [](const Array3f::Dense& V) {
        app::Session session = plain_session(scene_of(cloud(V)), 64);
        const Image image = session.render({std::nullopt, 1, app::Encoding::srgb8});
        int count = 0;
        for (size_t i = 3; i < image.pixels<uint8_t>().size(); i += 4)
            count += image.pixels<uint8_t>()[i] > 0;
        return count;
    };
    EXPECT_GT(covered(Array3f::Dense::Ones(1, 3)), 0);
    EXPECT_GT(covered(Array3f::Dense::Ones(1000, 3)), 0);
    Array3f::Dense line(100, 3);
    for (int i = 0; i < 100; ++i) line.row(i) << float(i), 0, 0;
    EXPECT_GT(covered(line), 50);
}

TEST(Points, ZeroNormalsFaceTheViewer) {
    MeshData data;
    data.V = Array3f(grid(50, 1, [](double, double) { return 0.0; }));
    data.N = Array3f(Array3f::Dense::Zero(data.V.rows(), 3));
    Scene scene = scene_of(Mesh(data));
    for (const bool native : {true, false}) {
        app::Session session = plain_session(scene, 64);
        session.allow_native_geometry(native);
        look_from(session, Vec3d(0, 0, 3));
        const Image normal = session.render_layers({"normal_world"}).at("normal_world");
        EXPECT_GT(normal.at<float>(32, 32)[2], 0.99f) << native;
    }
}

TEST(Spacing, OfRegularClouds) {
    // A square grid has one point per spacing squared; counting in cells is right within a third.
    const Array3f plane(grid(300, 1, [](double, double) { return 0.0; }));
    EXPECT_NEAR(point_spacing(plane) / (2.0 / 299), 1, 0.33);
    Array3f::Dense line(1000, 3);
    for (int i = 0; i < 1000; ++i) line.row(i) << float(i) * 0.5f, 0, 0;
    EXPECT_NEAR(point_spacing(Array3f(line)) / 0.5, 1, 0.33);
    Array3f::Dense cube(40 * 40 * 40, 3);
    for (int i = 0; i < 64000; ++i) cube.row(i) << float(i % 40), float(i / 40 % 40), float(i / 1600);
    EXPECT_NEAR(point_spacing(Array3f(cube)), 1, 0.33);
    EXPECT_EQ(point_spacing(Array3f(Array3f::Dense::Ones(50, 3))), 0);
    EXPECT_EQ(point_spacing(Array3f(Array3f::Dense::Ones(1, 3))), 0);
}

TEST(AutomaticDiscs, AreAtMostAPartOfTheCloud) {
    const auto diagonal = [](const Array3f& V) { return trimmed_bounds(V).diagonal().norm(); };
    const Array3f few(random_points(300, 9)), many(random_points(20000, 9));
    EXPECT_NEAR(automatic_discs(few).diameter / diagonal(few), 0.015, 1e-9);
    EXPECT_EQ(automatic_discs(few).least, 1);
    // Half in a volume; 4 %: its dimension is that of counted cells, 2.95 at least.
    EXPECT_NEAR(automatic_discs(many).diameter / diagonal(many), 0.0075, 0.0003);
    EXPECT_NEAR(automatic_discs(many).least, 0.5, 0.02);
    // A cloud that becomes thin outwards is a volume as well.
    std::mt19937 random(10);
    std::normal_distribution<float> normal;
    Array3f::Dense V(20000, 3);
    for (Eigen::Index i = 0; i < V.size(); ++i) V.data()[i] = normal(random);
    EXPECT_NEAR(automatic_discs(Array3f(V)).diameter / diagonal(Array3f(V)), 0.0075, 0.0003);
}

TEST(AutomaticDiscs, CloseTheHolesOfDenseSurfaces) {
    const Array3f plane(grid(300, 1, [](double, double) { return 0.0; }));
    const AutomaticDiscs discs = automatic_discs(plane);
    EXPECT_EQ(discs.diameter, 1.5 * point_spacing(plane));
    EXPECT_EQ(discs.diameter, discs.closing);
    EXPECT_EQ(discs.least, 0);
    EXPECT_EQ(automatic_discs(Array3f(Array3f::Dense::Ones(9, 3))).diameter, 0);
    EXPECT_EQ(automatic_discs(Array3f(Array3f::Dense::Ones(1, 3))).centre, Vec3d(1, 1, 1));
}

TEST(Spacing, OutliersAreTrimmed) {
    Array3f::Dense V = random_points(5000, 9);
    V.row(17) << 1e6f, -1e6f, 3e5f;
    const Box3d box = trimmed_bounds(Array3f(V));
    EXPECT_LT(box.sizes().maxCoeff(), 20);
    EXPECT_TRUE(box.contains(Box3d(Vec3d(-0.99, -0.99, -0.99), Vec3d(0.99, 0.99, 0.99))));
    EXPECT_EQ(trimmed_bounds(Array3f(random_points(5000, 9))).sizes().maxCoeff() < 2.001, true);
}

}  // namespace
}  // namespace easypbr::render::point_test
