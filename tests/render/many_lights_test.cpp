// Path traced light of more lights than one block of a shader holds, 64.
#include <cmath>
#include <string>

#include "render_test.h"

namespace easypbr::many_lights_test {
namespace {

constexpr int size = 16, of_block = 64;

/// Parallel light that brings `irradiance` to what faces up.
void add_light(Scene& scene, int number, const Vec3& direction, const Vec3& irradiance) {
    Light light;
    light.type = LightType::directional;
    light.direction = direction;
    light.angular_radius_deg = 0;
    light.intensity = irradiance.maxCoeff() / std::abs(direction.normalized().y());
    light.color = irradiance / irradiance.maxCoeff();
    scene.set_light("light " + std::to_string(100 + number), light);  // in the order of their names
}

app::Session session_of(const Scene& scene) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.shadows.enabled = true;
    return session;
}

Vec4 mean_of(app::Session& session, int samples) {
    const Image image = render_linear(session, samples);
    Vec4 sum = Vec4::Zero();
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) sum += Eigen::Map<const Vec4>(image.at<float>(x, y));
    return sum / float(size * size);
}

// A white box reflects the irradiance over pi: 1 of 64 lights, and 0.5 in luminance of each of two more.
// 0.05: a coloured light is chosen with a probability of 1/4, so that the standard error of 65536 independent
// samples is 0.7 % of the red and of the green, which are 2.35 and 0.7.
TEST(ManyLights, ShineAsBrightInWhicheverBlock) {
    const Vec3 red(0.5f / 0.2126f, 0, 0), green(0, 0.5f / 0.7152f, 0);
    for (const auto& [before, last] : {std::pair(red, green), std::pair(green, red)}) {
        Material white;
        white.base_color = Vec3::Ones();
        white.specular = 0;
        white.roughness = 1;
        Scene scene;
        Mesh box = make_box(Vec3(4, 1, 4));
        box.set_material(white);
        scene.show(box, "box");
        for (int i = 0; i < of_block; ++i)
            add_light(scene, i, Vec3(0, -1, 0), Vec3::Constant(float(pi) / of_block));
        add_light(scene, of_block, Vec3(0, -1, 0), float(pi) * before);
        add_light(scene, of_block + 1, Vec3(0, -1, 0), float(pi) * last);
        app::Session session = session_of(scene);
        look_from(session, Vec3d(0, 4, 1), 10);
        const Vec4 seen = mean_of(session, 256);
        const Vec3 expected = Vec3::Ones() + red + green;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], 0.05) << c;
    }
}

// Two lights of a second block, each of a quarter of all light, throw shadows to either side of a ball: the
// ground is a quarter dark in both. 0.02: the standard error of 16384 independent samples is 0.003, and the
// shadow's rim is far from what is looked at.
TEST(ManyLights, ThrowAllTheirShadows) {
    Scene scene;
    scene.show(make_sphere(1, 64), "ball");
    for (int i = 0; i < of_block; ++i)
        add_light(scene, i, Vec3(0, -1, 0), Vec3::Constant(2 * float(pi) / of_block));
    for (int i = 0; i < 2; ++i)
        add_light(scene, of_block + i, Vec3(i == 0 ? 1.0f : -1.0f, -1, 0), Vec3::Constant(float(pi)));
    app::Session session = session_of(scene);
    session.settings().ground.mode = GroundMode::shadow;
    session.settings().ground.height = -2;
    for (const double side : {1.0, -1.0}) {
        look_from(session, Vec3d(side * 4, 0, 0), 1);
        session.settings().camera.target = Vec3d(side * 2, -2, 0);
        EXPECT_NEAR(mean_of(session, 64)[3], 0.25, 0.02) << side;
    }
}

}  // namespace
}  // namespace easypbr::many_lights_test
