// Layers of surfels that overlap: the same in layers and in ground truth, with a lens and without.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "easypbr/dataset/ground_truth.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::surfel_truth_test {
namespace {

const Vec2i size(200, 150);

/// Surfels strewn about a unit sphere, a hundredth off it, each of which overlaps several others; their
/// normals are the sphere's. Three units before an OpenCV camera at the origin.
Scene rough_ball() {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    constexpr int count = 4000;
    Array3f::Dense V(count, 3), N(count, 3), C(count, 3);
    for (int i = 0; i < count; ++i) {
        N.row(i) = Vec3(normal(random), normal(random), normal(random)).normalized();
        V.row(i) = (1 + 0.01f * normal(random)) * N.row(i) + Eigen::RowVector3f(0, 0, 3);
        C.row(i) = (N.row(i).array() + 1) / 2;
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.C = Array3f(C);
    data.style.mode = DrawMode::surfels;
    Scene scene;
    scene.show(Mesh(data), "ball");
    return scene;
}

app::Session session_of(bool native, double k1) {
    app::Session session = plain_session(rough_ball());
    session.allow_native_geometry(native);
    session.settings().image.size = size;
    Mat3d K;
    K << 200, 0, 99.5, 0, 200, 74.5, 0, 0, 1;
    Camera camera = Camera::from_opencv(K, Mat4d::Identity(), size.x(), size.y());
    if (k1 != 0)
        camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {k1, 0, 0, 0});
    session.set_camera(camera);
    return session;
}

/// How many pixels of two depths differ by more than float32 explains: the place in a disc is found in pixels
/// of a picture of 200, which rounds it to 1e-5 of the disc, more where that is slanted.
int count_different(std::span<const float> a, std::span<const float> b) {
    int different = 0;
    for (size_t i = 0; i < a.size(); ++i) different += !(std::abs(a[i] - b[i]) <= 1e-4f * a[i]);
    return different;
}

/// On rims of discs rounding decides which disc a pixel sees: a few of the ball's 16000 pixels.
constexpr int most_on_rims = 20;

TEST(SurfelTruth, IsWhatLayersHold) {
    for (const bool native : {true, false})
        for (const double k1 : {0.0, -0.05}) {
            app::Session session = session_of(native, k1);
            const auto layers =
                session.render_layers({"albedo", "normal_world", "depth", "roughness", "element_id"});
            const GroundTruth truth =
                ground_truth(session, {"albedo", "normal_world", "depth", "roughness", "face_id"}, {});
            const auto of = [&](const char* name) -> const std::vector<float>& {
                return truth.layers.at(name).floats();
            };
            EXPECT_LE(count_different(of("depth"), layers.at("depth").pixels<float>()), most_on_rims)
                << native << k1;
            const std::span<const float> true_albedo = of("albedo"), true_normal = of("normal_world"),
                                         true_roughness = of("roughness");
            const std::span<const float> albedo = layers.at("albedo").pixels<float>(),
                                         normal = layers.at("normal_world").pixels<float>(),
                                         element = layers.at("element_id").pixels<float>(),
                                         roughness = layers.at("roughness").pixels<float>();
            const auto faces = truth.layers.at("face_id").integers();
            int seen = 0;
            for (size_t i = 0; i < faces.size(); ++i) {
                // Both read the same targets.
                ASSERT_EQ(element[i], float(faces[i] + 1)) << i;
                ASSERT_EQ(roughness[i], true_roughness[i]) << i;
                for (size_t c = 0; c < 3; ++c) {
                    ASSERT_EQ(albedo[4 * i + c], true_albedo[3 * i + c]) << i;
                    ASSERT_EQ(normal[3 * i + c], true_normal[3 * i + c]) << i;
                }
                seen += faces[i] >= 0;
            }
            EXPECT_GT(seen, 15000);
        }
}

// A lens that moves no pixel by more than 1e-7 of one changes nothing.
TEST(SurfelTruth, DepthDoesNotJumpWithALens) {
    for (const bool native : {true, false}) {
        app::Session plain = session_of(native, 0), bent = session_of(native, 1e-9);
        const Image without = plain.render_layers({"depth"}).at("depth"),
                    with = bent.render_layers({"depth"}).at("depth");
        EXPECT_LE(count_different(without.pixels<float>(), with.pixels<float>()), most_on_rims) << native;
    }
}

}  // namespace
}  // namespace easypbr::dataset::surfel_truth_test
