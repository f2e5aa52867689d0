// Ground truth of surfels that overlap: each pixel sees the nearest one alone.
#include <gtest/gtest.h>

#include <cmath>

#include "dataset/placed_meshes.h"
#include "easypbr/dataset/ground_truth.h"
#include "render/render_test.h"

namespace easypbr::dataset::surfel_truth_test {
namespace {

const Vec2i size(200, 150);
constexpr double f = 180, cx = 99.5, cy = 74.5;

Mesh surfel(const Vec3& place, float radius, const Vec3& normal, const Vec3& color) {
    MeshData mesh;
    mesh.V = Array3f::Dense(place.transpose());
    mesh.N = Array3f::Dense(normal.transpose());
    mesh.T = Array3f::Dense(radius * normal.unitOrthogonal().transpose());
    mesh.B = Array1f::Dense::Constant(1, radius);
    Material material;
    material.base_color = color;
    mesh.materials = {material};
    return Mesh(mesh);
}

const Vec3 red_place(0, 0, -5), blue_place(0.7f, 0, -5.4f);
const Vec3 red_normal = Vec3(0.5f, 0.2f, 1).normalized(), blue_normal(0, 0, 1);

/// The depth at which a ray from the camera's centre meets a surfel's plane; OpenGL's axes.
double plane_depth(const Vec3& place, const Vec3& normal, const Vec2d& slopes) {
    const Vec3d n = normal.cast<double>();
    return n.dot(place.cast<double>()) / n.dot(Vec3d(slopes.x(), -slopes.y(), -1));
}

// Bands of a surfel's size behind the nearest are one surface in pictures: here the blue surfel is in the
// band of the red one, and smaller. Depths are floats, 6e-8, of places and normals that are. Normals are held
// in 2 x 16 bits, albedos in 16.
TEST(SurfelTruth, EveryLayerIsOfTheNearestSurfelAlone) {
    Scene scene;
    scene.show(surfel(red_place, 0.8f, red_normal, Vec3(1, 0, 0)), "red");
    scene.show(surfel(blue_place, 0.6f, blue_normal, Vec3(0, 0, 1)), "blue");
    for (const bool native : {true, false})
        for (const bool through_lens : {false, true}) {
            app::Session session = plain_session(scene);
            session.allow_native_geometry(native);
            Camera camera = opencv_camera((Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished(), size);
            if (through_lens)
                camera.distortion =
                    Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.2, 0, 0, 0});
            session.set_camera(camera);
            TruthOptions options;
            options.size = size;
            options.instances = true;
            const GroundTruth truth = ground_truth(
                session, {"depth", "position", "albedo", "normal_world", "instance_id"}, options);
            const int red_id = std::ranges::find(truth.instances, "red", &Instance::name)->id;
            const auto ids = truth.layers.at("instance_id").integers();
            int reds = 0, blues = 0;
            for (size_t i = 0; i < ids.size(); ++i) {
                if (ids[i] == 0) continue;
                const bool is_red = ids[i] == red_id;
                (is_red ? reds : blues) += 1;
                const Vec3 place = is_red ? red_place : blue_place,
                           normal = is_red ? red_normal : blue_normal;
                const float *p = &truth.layers.at("position").floats()[3 * i],
                            *albedo = &truth.layers.at("albedo").floats()[3 * i],
                            *n = &truth.layers.at("normal_world").floats()[3 * i];
                const Vec2d slopes(p[0] / -p[2], p[1] / p[2]);
                const double depth = double(truth.layers.at("depth").floats()[i]);
                ASSERT_NEAR(depth, plane_depth(place, normal, slopes), 3e-6) << native << i;
                ASSERT_EQ(Vec3(albedo[0], albedo[1], albedo[2]), is_red ? Vec3(1, 0, 0) : Vec3(0, 0, 1)) << i;
                ASSERT_NEAR((Vec3(n[0], n[1], n[2]) - normal).norm(), 0, 1e-4) << i;
                // No pixel of the other's that is nearer.
                if (is_red || through_lens) continue;
                const Vec3d at_red =
                    plane_depth(red_place, red_normal, slopes) * Vec3d(slopes.x(), -slopes.y(), -1);
                ASSERT_TRUE(depth < -at_red.z() || (at_red - red_place.cast<double>()).norm() > 0.8 - 0.02)
                    << i;
            }
            EXPECT_GT(reds, 1000);
            EXPECT_GT(blues, 200);
        }
}

// What one frame shows is the same whether its ground truth is asked for or not: there surfels are blended.
TEST(SurfelTruth, LeavesThePictureAsItIs) {
    Scene scene;
    scene.show(surfel(red_place, 0.8f, red_normal, Vec3(1, 0, 0)), "red");
    scene.show(surfel(blue_place, 0.6f, blue_normal, Vec3(0, 0, 1)), "blue");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera((Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished(), size));
    TruthOptions options;
    options.size = size;
    const GroundTruth truth = ground_truth(session, {"hdr", "depth"}, options);
    const Image picture = session.render({size, 1, app::Encoding::scene_linear});
    const std::span<const float> expected = picture.pixels<float>();
    EXPECT_TRUE(std::ranges::equal(truth.layers.at("hdr").floats(), expected));
}

}  // namespace
}  // namespace easypbr::dataset::surfel_truth_test
