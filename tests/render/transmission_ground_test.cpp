// Volumes of glass that stand on a floor or a ground.
#include <algorithm>
#include <cmath>

#include "glass_scenes.h"
#include "lobe_reference.h"

namespace easypbr::transmission_ground_test {
namespace {

using namespace transmission_test;
using namespace reference;

// A block of glass on a floor, in the plane of the picture's middle column. A ray that enters its front at an
// elevation a goes on at b with sin a = 1.5 sin b. It meets the bottom if it enters below d tan b, d being
// the block's depth. There it is reflected: cos b > 1 / 1.5. It goes up to the environment of radiance 1.
// Else it leaves through the back to the floor. So there is one edge, although the floor touches the bottom.
TEST(Transmission, AFloorIsNotSeenThroughABottomThatReflects) {
    const double side = 0.8, floor = 0.2;
    Mesh ground = facing_square(8, glowing(Vec3::Constant(float(floor))));
    ground.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(-pi / 2, Vec3d::UnitX())));
    Mesh block = make_box(Vec3::Constant(float(side)));
    block.set_material(glass([](Material& m) { m.thickness = 1; }));
    Scene scene;
    scene.show(ground, "ground");
    scene.show(moved(block, Vec3d(0, side / 2, 0)), "block");
    scene.set_environment(constant_environment(1));
    for (const bool native : {true, false}) {
        app::Session session = session_of(scene, Vec3d(0, 1.2, 4));
        session.settings().environment.enabled = true;
        session.allow_native_geometry(native);
        session.allow_native_shading(native);
        const Image image = render_linear(session);
        int bottom = 0, back = 0;
        for (int y = 0; y < size; ++y) {
            const Ray ray = ray_of(session.camera(), size / 2, y);
            const Vec3d p = ray.origin + ray.direction * ((side / 2 - ray.origin.z()) / ray.direction.z());
            const double edge = side * std::tan(std::asin(-ray.direction.y() / 1.5));
            // Two pixels around each edge, each of 0.02, are left out.
            if (p.y() < 0.04 || p.y() > 0.6 || std::abs(p.y() - edge) < 0.04) continue;
            const bool reflects = p.y() < edge;
            const double F = schlick(-ray.direction.z(), 0.04);
            // 0.01: as that of WhatIsWithinIsSeen, for the index of 8 bits.
            EXPECT_NEAR(image.at<float>(size / 2, y)[0], reflects ? 1 : F + (1 - F) * floor, 0.01)
                << y << " " << native;
            ++(reflects ? bottom : back);
        }
        EXPECT_GT(bottom, 3);
        EXPECT_GT(back, 6);
    }
}

/// On a plane under an environment of radiance 1, which is seen as far as 0.4 of 20 as it is.
constexpr float plane_radiance = 0.05f;

app::Session on_plane(Scene& scene, bool native) {
    scene.set_environment(constant_environment(1));
    app::Session session = session_of(scene, Vec3d(0, 0.8, 4));
    Settings& s = session.settings();
    s.environment.enabled = true;
    s.ground.mode = GroundMode::plane;
    s.ground.plane_color = Vec3::Constant(srgb_from_linear(plane_radiance));
    s.ground.plane_roughness = 1.0f;
    s.ground.height = -1.0f;
    s.ground.radius = 20.0f;
    session.allow_native_geometry(native);
    session.allow_native_shading(native);
    return session;
}

// What a ball of glass shows of a plane that is larger than the content. What ball and plane mirror is not
// told from what they do not: F and a tenth are left for it.
TEST(TransmissionOfGround, ABallShowsAPlaneFarBehindIt) {
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(ball(glass([](Material& m) { m.thickness = 2; })), "ball");
        app::Session session = on_plane(scene, native);
        const Image image = render_linear(session);
        int far = 0, sky = 0;
        for (int y = 0; y < size; ++y) {
            const Ray ray = ray_of(session.camera(), size / 2, y);
            const double b = ray.origin.dot(ray.direction), c = b * b - ray.origin.squaredNorm() + 1;
            if (c < 0) continue;
            const Vec3d n = ray.origin + ray.direction * (-b - std::sqrt(c));
            if (-ray.direction.dot(n) < 0.35) continue;
            const Vec3d inside = refracted(ray.direction, n, 1 / 1.5);
            const Vec3d back = n - 2 * n.dot(inside) * inside, outside = refracted(inside, -back, 1.5);
            const double way = (back.y() + 1) / -outside.y(), F = schlick(-ray.direction.dot(n), 0.04);
            const bool meets = way > 0 && (back + outside * way - Vec3d(0, -1, 0)).norm() < 7.5;
            if (!meets && outside.y() < 0.05) continue;
            EXPECT_NEAR(image.at<float>(size / 2, y)[0], meets ? plane_radiance : 1, F + 0.1)
                << y << " " << native;
            // The camera is 4.1 from the middle, and the content ends 1.7 beyond that.
            far += meets && way > 6;
            sky += !meets;
        }
        EXPECT_GT(far, 0);
        EXPECT_GT(sky, 5);
    }
}

// The lobe of a rough ball is 0.3 wide, and one of 256 rows turns it by 0.02: of the plane's edge no row
// shows a third. The picture is blurred by less than the lobe is wide.
TEST(TransmissionOfGround, ARoughBallShowsNoEdge) {
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(ball(glass([](Material& m) { m.thickness = 2, m.roughness = 0.4f; })), "ball");
        app::Session session = on_plane(scene, native);
        session.settings().image.size = Vec2i(256, 256);
        const Image image = render_linear(session);
        float most = 0, least = 1, step = 0;
        for (int y = 40; y < 210; ++y) {
            const float value = image.at<float>(128, y)[0];
            most = std::max(most, value);
            least = std::min(least, value);
            step = std::max(step, std::abs(image.at<float>(128, y + 1)[0] - value));
        }
        EXPECT_LT(step, 0.3f) << native;
        EXPECT_GT(most - least, 0.7f) << native;
    }
}

}  // namespace
}  // namespace easypbr::transmission_ground_test
