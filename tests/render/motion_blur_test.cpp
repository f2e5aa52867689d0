// Motion blur against the profiles of what moves evenly.
#include <cmath>
#include <cstring>

#include "easypbr/scene/motion.h"
#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::motion_blur_test {
namespace {

constexpr int size = 128;
constexpr double width = 20;  // of the square, pixels

/// A white square, 20 pixels wide, and an orthographic camera with a pixel to the unit, whose row 64 it
/// crosses.
struct Moving {
    Scene scene;
    Mesh mesh;
    app::Session session{scene};

    Moving() {
        Material white;
        white.base_color = Vec3::Zero();
        white.emissive = Vec3::Ones();
        mesh = facing_square(float(width / 2), white);
        scene.show(mesh, "square");
        session = plain_session(scene, size);
        CameraSettings& camera = session.settings().camera;
        camera.projection = Projection::orthographic;
        camera.ortho_height = size;
        camera.position = Vec3d(0, 0, 100);
        camera.target = Vec3d(0, 0, 0);
        session.settings().motion_blur.enabled = true;
    }
    void move(double x) { mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0))); }
    Image draw(int samples) { return render_linear(session, samples); }
};

/// Mean over the open shutter of the square's light at a pixel: its middle runs evenly from `from` to `to`.
double trapezoid(double pixel, double from, double to) {
    constexpr int steps = 4000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double middle = size / 2.0 + from + (to - from) * (i + 0.5) / steps;
        const double left = std::max(pixel, middle - width / 2),
                     right = std::min(pixel + 1, middle + width / 2);
        sum += std::max(right - left, 0.0) / steps;
    }
    return sum;
}

// 64 samples: each edge passes a pixel in steps of 1/64 at places in the pixel that are evenly spread: 2/64
// off at most, and where an edge stays longer in a pixel, the error of 64 places on a slanted edge.
void expect_profile(const Image& picture, double from, double to) {
    double worst = 0, sum = 0;
    for (int x = 0; x < size; ++x) {
        const double error = std::abs(picture.at<float>(x, size / 2)[1] - trapezoid(x, from, to));
        worst = std::max(worst, error);
        sum += error / size;
    }
    EXPECT_LT(worst, 0.05);
    EXPECT_LT(sum, 0.01);
}

TEST(MotionBlur, OfAMovingSquareIsATrapezoid) {
    for (float shutter : {0.5f, 1.0f}) {
        Moving moving;
        moving.session.settings().motion_blur.shutter = shutter;
        moving.move(-20);
        moving.draw(1);
        moving.move(20);
        expect_profile(moving.draw(64), 20 - 40 * shutter, 20);
        // Nothing has moved since.
        expect_profile(moving.draw(64), 20, 20);
    }
}

TEST(MotionBlur, OfAMovingCameraIsTheSame) {
    Moving moving;
    moving.draw(1);
    moving.session.settings().camera.position = Vec3d(-30, 0, 100);
    moving.session.settings().camera.target = Vec3d(-30, 0, 0);
    expect_profile(moving.draw(64), 15, 30);
}

TEST(MotionBlur, IsNotThereWithoutShutterTimeOrMemory) {
    for (const char* reason : {"off", "closed", "forgotten", "one sample"}) {
        Moving moving;
        const std::string why = reason;
        if (why == "off") moving.session.settings().motion_blur.enabled = false;
        if (why == "closed") moving.session.settings().motion_blur.shutter = 0;
        moving.move(-20);
        moving.draw(1);
        if (why == "forgotten") moving.session.forget_motion();
        moving.move(20);
        const int samples = why == "one sample" ? 1 : 16;
        const Image moved = moving.draw(samples), still = moving.draw(samples);
        EXPECT_EQ(std::memcmp(moved.bytes().data(), still.bytes().data(), still.bytes().size()), 0) << why;
    }
}

// A jump from -40 to 20, of which the last 10 units are motion: by itself, and by what it hangs from.
TEST(MotionBlur, OfWhatJumpsIsTheMotionThatItIsSaidToHave) {
    const Eigen::Affine3d before(Eigen::Translation3d(-10, 0, 0));
    for (const bool hangs : {false, true}) {
        Moving moving;
        moving.session.settings().motion_blur.shutter = 1;
        Mesh parent;
        if (hangs) {
            parent.add_child(moving.mesh);
            moving.scene.show(parent, "square");
        }
        Mesh& moved = hangs ? parent : moving.mesh;
        const auto move = [&](double x) {
            moved.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
        };
        move(-40);
        moving.draw(1);
        move(20);
        moving.session.replace_motion({{moved, before}});
        expect_profile(moving.draw(64), 10, 20);
        // It was for one picture.
        move(0);
        expect_profile(moving.draw(64), 20, 0);
    }
}

// What a jumping child hangs from moved meanwhile, which counts as well.
TEST(MotionBlur, OfAJumpOnWhatMoves) {
    Moving moving;
    moving.session.settings().motion_blur.shutter = 1;
    Mesh parent;
    parent.add_child(moving.mesh);
    moving.scene.show(parent, "square");
    parent.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-10, 0, 0)));
    moving.move(-40);
    moving.draw(1);
    parent.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(5, 0, 0)));
    moving.move(20);
    moving.session.replace_motion({{moving.mesh, Eigen::Affine3d(Eigen::Translation3d(-10, 0, 0))}});
    // The parent by 15, the child by 10; it is at 25.
    expect_profile(moving.draw(64), 0, 25);
}

TEST(MotionBlur, SiblingsOfOneNameAreTwoObjects) {
    Moving moving;
    Mesh other = moving.mesh.clone(), parent;
    other.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 40, 0)));
    parent.add_child(moving.mesh);
    parent.add_child(other);
    moving.scene.show(parent, "square");
    moving.move(-20);
    moving.draw(1);
    expect_profile(moving.draw(64), -20, -20);
    moving.move(20);
    expect_profile(moving.draw(64), 0, 20);
}

// The first one leaves; the other one stays where it is, and is sharp.
TEST(MotionBlur, IsNotThatOfASiblingThatLeft) {
    Moving moving;
    Mesh other = moving.mesh.clone(), parent;
    other.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 40, 0)));
    parent.add_child(other);
    parent.add_child(moving.mesh);
    moving.scene.show(parent, "square");
    moving.move(20);
    moving.draw(1);
    parent.remove_child(other);
    expect_profile(moving.draw(64), 20, 20);
}

// Of meshes that are made anew for each picture the name tells which is which.
TEST(MotionBlur, OfAReplacedMeshIsThatOfItsName) {
    Moving moving;
    moving.session.settings().motion_blur.shutter = 1;
    moving.move(-20);
    moving.draw(1);
    moving.mesh = moving.mesh.clone();
    moving.scene.show(moving.mesh, "square");
    moving.move(20);
    expect_profile(moving.draw(64), -20, 20);
}

TEST(MotionBlur, LeavesLayersAlone) {
    Moving moving;
    moving.move(-20);
    moving.draw(4);
    moving.move(20);
    const Image depth = moving.session.render_layers({"depth"}).at("depth");
    EXPECT_GT(depth.at<float>(size / 2 + 20, size / 2)[0], 0);
    EXPECT_EQ(depth.at<float>(size / 2 - 5, size / 2)[0], 0);
    // A layer is no picture: the next one still knows where things were.
    expect_profile(moving.draw(64), 0, 20);
}

TEST(Motion, TurnsEvenlyTheShorterWay) {
    Eigen::Affine3d a = Eigen::Affine3d::Identity(), b = a;
    a.translate(Vec3d(1, 2, 3)).rotate(Eigen::AngleAxisd(radians(350), Vec3d::UnitY())).scale(2);
    b.translate(Vec3d(3, 2, 1)).rotate(Eigen::AngleAxisd(radians(30), Vec3d::UnitY())).scale(4);
    Eigen::Affine3d expected = Eigen::Affine3d::Identity();
    expected.translate(Vec3d(1.5, 2, 2.5)).rotate(Eigen::AngleAxisd(radians(0), Vec3d::UnitY())).scale(2.5);
    EXPECT_LT((between(a, b, 0.25).matrix() - expected.matrix()).norm(), 1e-12);
    EXPECT_LT((between(a, b, 0).matrix() - a.matrix()).norm(), 1e-12);
    EXPECT_LT((between(a, b, 1).matrix() - b.matrix()).norm(), 1e-12);
}

// A picture of 100 pixels a side becomes one of 200: in the units of the second one the skew was 4, and the
// middle at 99.5.
TEST(Motion, OfIntrinsicsIsInTheUnitsOfTheSecondPicture) {
    Camera from, to;
    from.intrinsics = Intrinsics{50, 60, 49.5, 49.5, 100, 100, 2};
    to.intrinsics = Intrinsics{140, 120, 99.5, 103.5, 200, 200, 8};
    const Intrinsics k = *between(from, to, 0.25).intrinsics;
    EXPECT_EQ(k.fx, 110);
    EXPECT_EQ(k.fy, 120);
    EXPECT_EQ(k.cx, 99.5);
    EXPECT_EQ(k.cy, 100.5);
    EXPECT_EQ(k.skew, 5);
    EXPECT_EQ(k.width, 200);
}

TEST(Motion, OfMirroredObjectsTurnsToo) {
    const auto pose = [](double angle_deg, const Vec3d& scale, const Vec3d& axis) {
        return Eigen::Affine3d(Eigen::Translation3d(angle_deg, 2, 3) *
                               Eigen::AngleAxisd(radians(angle_deg), axis.normalized()) *
                               Eigen::Scaling(scale));
    };
    for (const Vec3d& scale : {Vec3d(1, 1, -1), Vec3d(-1, 1, 1), Vec3d(-1, 2, 1), Vec3d(3, -0.5, 1),
                               Vec3d(-1, -1, -1), Vec3d(-1, -2, -3)})
        for (const Vec3d& axis : {Vec3d(0, 0, 1), Vec3d(1, 2, 3)}) {
            const Eigen::Affine3d from = pose(30, scale, axis), to = pose(50, scale, axis);
            // Rounding of a decomposition of numbers up to 50.
            for (const double t : {0.0, 0.25, 0.5, 1.0})
                EXPECT_LT((between(from, to, t).matrix() - pose(30 + 20 * t, scale, axis).matrix()).norm(),
                          1e-12)
                    << scale.transpose() << " about " << axis.transpose() << " at " << t;
        }
}

// A negative factor that grows: the stretch changes linearly.
TEST(Motion, OfAMirroredObjectThatGrows) {
    const Eigen::Affine3d from(Eigen::Scaling(-1.0, 1.0, 1.0)), to(Eigen::Scaling(-3.0, 2.0, 1.0));
    EXPECT_LT((between(from, to, 0.5).linear() - Mat3d(Vec3d(-2, 1.5, 1).asDiagonal())).norm(), 1e-12);
}

TEST(Motion, IntoTheMirrorImageIsLinear) {
    const Eigen::Affine3d from(Eigen::AngleAxisd(radians(20), Vec3d::UnitZ())),
        to(Eigen::Scaling(-1.0, 1.0, 1.0));
    const Mat3d expected = 0.75 * from.linear() + 0.25 * to.linear();
    EXPECT_LT((between(from, to, 0.25).linear() - expected).norm(), 1e-15);
}

}  // namespace
}  // namespace easypbr::motion_blur_test
