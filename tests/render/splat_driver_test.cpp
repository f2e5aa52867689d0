// Gaussian splats that the driver projects, sorts and blends, beside those that the CPU does.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "render_test.h"

namespace easypbr::render::splat_driver_test {
namespace {

std::mt19937& generator() {
    static std::mt19937 random(7);
    return random;
}

float number(float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(generator());
}

template <class Dense>
Dense numbers(Eigen::Index rows, Eigen::Index columns, float least, float most) {
    return Dense::NullaryExpr(rows, columns, [&] { return number(least, most); });
}

Mesh splats(Eigen::Index count, int degree, const Vec3& centre = Vec3::Zero()) {
    MeshData mesh;
    Array3f::Dense V = numbers<Array3f::Dense>(count, 3, -1, 1);
    V.rowwise() += centre.transpose();
    mesh.V = std::move(V);
    mesh.splats.scales = numbers<Array3f::Dense>(count, 3, 0.005f, 0.15f);
    mesh.splats.rotations = numbers<Array4f::Dense>(count, 4, -1, 1);
    mesh.splats.opacities = numbers<Array1f::Dense>(count, 1, 0, 1);
    mesh.splats.sh = numbers<ArrayXf::Dense>(count, 3 * (degree + 1) * (degree + 1), -0.5f, 0.5f);
    return Mesh(mesh);
}

app::Session session_of(const Scene& scene) {
    app::Session session = plain_session(scene, 90);
    session.settings().image.size = Vec2i(130, 90);
    look_from(session, Vec3d(0.3, -0.2, 4));
    return session;
}

std::vector<float> picture_of(app::Session& session) {
    const Image image = session.render({std::nullopt, 1, app::Encoding::scene_linear});
    return {image.pixels<float>().begin(), image.pixels<float>().end()};
}

std::vector<float> picture(app::Session& session, bool native) {
    if (native) {  // on machines with a GPU too
        app::Session by_cpu(session.scene());
        by_cpu.use_device(DrawDevice::cpu);
        by_cpu.settings() = session.settings();
        return picture_of(by_cpu);
    }
    session.use_device(DrawDevice::gl);
    session.allow_native_geometry(false);
    session.allow_native_shading(false);
    return picture_of(session);
}

struct Difference {
    size_t changed = 0, large = 0, pixels = 0;
};

/// Light is displayed, so that a code of an image is at most 1/255 of it. Harmonics are 16-bit floats here.
Difference difference_of(app::Session& session) {
    const std::vector<float> native = picture(session, true), driven = picture(session, false);
    Difference difference{.pixels = native.size() / 4};
    for (size_t i = 0; i < native.size(); ++i) {
        difference.changed += native[i] != driven[i];
        difference.large += std::abs(native[i] - driven[i]) > 1.0f / 255;
    }
    return difference;
}

enum class Blended { by_driver, natively, somehow };

/// What the driver blends is never the same to the last bit: else the CPU did.
void expect_the_same(app::Session& session, Blended blended, const char* what) {
    const Difference difference = difference_of(session);
    EXPECT_EQ(difference.large, 0u) << what;
    const bool differs = difference.changed > difference.pixels / 4;
    if (blended == Blended::somehow) return;
    EXPECT_EQ(differs, blended == Blended::by_driver) << what;
}

TEST(SplatDriver, DrawsWhatTheCpuDraws) {
    for (int degree = 0; degree <= 3; ++degree) {
        Scene scene;
        scene.show(splats(1000, degree), "splats");
        app::Session session = session_of(scene);
        expect_the_same(session, Blended::by_driver, "perspective");
        session.settings().camera.projection = Projection::orthographic;
        expect_the_same(session, Blended::by_driver, "orthographic");
        session.settings().style.splat_antialias = true;
        expect_the_same(session, Blended::by_driver, "antialiased");
    }
}

// Matrices of floats hold places far from the origin to a hundredth of a splat.
TEST(SplatDriver, DrawsSplatsFarFromTheOrigin) {
    const Vec3 centre(4000, -9000, 2000);
    Scene scene;
    scene.show(splats(500, 1, centre), "splats");
    app::Session session = session_of(scene);
    session.settings().camera.position = Vec3d(centre.cast<double>() + Vec3d(0.3, -0.2, 4));
    session.settings().camera.target = Vec3d(centre.cast<double>());
    expect_the_same(session, Blended::by_driver, "far");
}

// A stray splat leaves the others as exact as they are.
TEST(SplatDriver, DrawsSplatsBesideAStrayOne) {
    MeshData mesh = *splats(500, 1).snapshot();
    Array3f::Dense V = mesh.V;
    V.row(0) << 3e6f, 3e6f, 3e6f;
    mesh.V = std::move(V);
    Scene scene;
    scene.show(Mesh(mesh), "splats");
    app::Session session = session_of(scene);
    session.settings().camera.near = 0.1;
    expect_the_same(session, Blended::by_driver, "stray");
}

TEST(SplatDriver, SortsTheSplatsOfAllObjects) {
    Scene scene;
    scene.show(splats(400, 1), "first");
    Mesh second = splats(300, 0);
    second.rotate_axis_angle(Vec3d(1, 2, 3), 57);
    scene.show(second, "second");
    app::Session session = session_of(scene);
    expect_the_same(session, Blended::by_driver, "two");
}

TEST(SplatDriver, HidesWhatIsBehindSurfaces) {
    Material unlit;
    unlit.unlit = true;
    Scene scene;
    scene.show(splats(1000, 0), "splats");
    scene.show(facing_square(0.5f, unlit), "square");
    app::Session session = session_of(scene);
    for (const bool soft : {true, false}) {
        session.settings().splats.soft = soft;
        expect_the_same(session, Blended::by_driver, soft ? "soft" : "hard");
    }
}

// The light of each side is the same byte.
TEST(SplatDriver, DarkensWhatSurfacesHideLightFrom) {
    Scene scene;
    Mesh turned = splats(1001, 1);
    turned.rotate_axis_angle(Vec3d(1, -2, 1), 40);
    scene.show(turned, "splats");
    scene.show(facing_square(0.7f), "square");
    Light lamp;
    lamp.type = LightType::directional;
    lamp.direction = Vec3(0.3f, -0.5f, -1);
    scene.set_light("lamp", lamp);
    app::Session session = session_of(scene);
    session.settings().shadows.enabled = true;
    session.settings().splats.receive = false;
    const std::vector<float> plain = picture(session, true);
    session.settings().splats.receive = true;
    EXPECT_NE(picture(session, true), plain);
    for (int frame = 0; frame < 17; ++frame) picture(session, false);
    expect_the_same(session, Blended::by_driver, "darkened");
}

TEST(SplatDriver, LeavesWhatItCannotToTheCpu) {
    Scene scene;
    scene.show(splats(500, 0), "splats");
    app::Session session = session_of(scene);
    session.settings().splats.resort = true;
    expect_the_same(session, Blended::natively, "resorted");
    session.settings().splats.resort = false;
    Material half;
    half.unlit = true;
    half.opacity = 0.5f;
    half.alpha_mode = AlphaMode::blend;
    scene.show(facing_square(0.5f, half), "layer");
    app::Session layered = session_of(scene);  // the layer differs too
    expect_the_same(layered, Blended::somehow, "layered");
}

TEST(SplatDriver, FollowsChanges) {
    Scene scene;
    scene.show(splats(300, 0), "splats");
    app::Session session = session_of(scene);
    expect_the_same(session, Blended::by_driver, "before");
    session.scene().show(splats(700, 2), "splats");
    expect_the_same(session, Blended::by_driver, "after");
    session.scene().hide("splats");
    const std::vector<float> nothing = picture(session, false);
    EXPECT_EQ(std::ranges::count(nothing, 0.0f), std::ptrdiff_t(nothing.size()));
}

}  // namespace
}  // namespace easypbr::render::splat_driver_test
