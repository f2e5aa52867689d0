// Volumes of glass that stand on a floor or a ground.
#include <algorithm>
#include <cmath>

#include "glass_scenes.h"
#include "lobe_reference.h"

namespace easypbr::transmission_test {
namespace {

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

}  // namespace
}  // namespace easypbr::transmission_test
