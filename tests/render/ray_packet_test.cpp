// Rays that Embree traces in packets, beside single ones.
#include <cmath>

#include "render_test.h"

namespace easypbr::ray_packet_test {
namespace {

// Rays of neighbours are traced in packets, and alone where some surface has holes: a mask that has none,
// within the ball, changes nothing but roundings. Light and shadow of a lamp, and of a sky that is bright on
// one side.
TEST(RayPackets, FindWhatSingleRaysFind) {
    const auto drawn = [](bool alone) {
        Scene scene;
        Material matt;
        matt.base_color = Vec3::Constant(0.7f);
        matt.roughness = 0.4f;
        Mesh ball = make_sphere(1, 64);
        ball.set_material(matt);
        scene.show(ball, "ball");
        Material masked = matt;
        masked.alpha_mode = alone ? AlphaMode::mask : AlphaMode::opaque;
        scene.show(facing_square(0.1f, masked), "inside");
        Image sky(64, 32, 3, PixelType::f32);
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                Eigen::Map<Vec3>(sky.at<float>(x, y)) = Vec3::Constant(x < 16 ? 2.0f : 0.2f);
        scene.set_environment(Environment(sky));
        Light lamp;
        lamp.type = LightType::point;
        lamp.position = Vec3d(3, 3, 1);
        lamp.intensity = 50;
        lamp.radius = 0.5f;
        scene.set_light("lamp", lamp);
        app::Session session = plain_session(scene, 64);
        session.settings().path.enabled = true;
        session.settings().path.clamp = 0;
        session.settings().shadows.enabled = true;
        session.settings().environment.enabled = true;
        session.settings().ground.mode = GroundMode::plane;
        session.settings().path.denoise = Denoising::off;
        look_from(session, Vec3d(3, 2, 4), 40);
        return render_linear(session, 2);
    };
    const Image packets = drawn(false), single = drawn(true);
    // A path of a hundred may find another surface at an edge, by the last bit of its direction.
    int other = 0;
    double difference = 0, light = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) {
                const float apart = std::abs(packets.at<float>(x, y)[c] - single.at<float>(x, y)[c]);
                other += apart > 1e-3f;
                difference += apart;
                light += packets.at<float>(x, y)[c];
            }
    EXPECT_LT(other, 3 * 64 * 64 / 100);
    EXPECT_LT(difference / (3 * 64 * 64), 1e-3);
    EXPECT_GT(light / (3 * 64 * 64), 0.05);
}

}  // namespace
}  // namespace easypbr::ray_packet_test
