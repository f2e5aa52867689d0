// Pictures that get better call by call, and what is seen where in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::live_picture_test {
namespace {

Session ball_session() {
    Scene scene;
    scene.show(make_sphere(1, 16), "ball");
    Session session(scene);
    session.settings().image.size = Vec2i(64, 48);
    session.settings().image.samples = 4;
    return session;
}

bool same(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes());
}

/// Refined to the end.
Drawn complete(Session& session, const Session::RefinedMotion& motion = {}) {
    Session::Refinement done;
    do done = session.refine({}, true, motion);
    while (done.frames < done.total);
    return done.drawn;
}

TEST(Refine, EndsAtTheStillBitForBit) {
    const Image still = ball_session().render();
    Session session = ball_session();
    for (int frame = 1; frame <= 4; ++frame) {
        const Session::Refinement done = session.refine();
        EXPECT_EQ(done.frames, frame);
        EXPECT_EQ(done.total, 4);
        EXPECT_EQ(done.began, frame == 1);
        EXPECT_TRUE(done.drew);
        EXPECT_EQ(same(done.drawn.picture(), still), frame == 4);
    }
    EXPECT_FALSE(session.refine().drew);
    EXPECT_TRUE(same(session.refine().drawn.picture(), still));
}

TEST(Refine, EveryFrameOnTheWayIsThePictureOfItsOwnFrames) {
    Session session = ball_session();
    session.settings().background.mode = BackgroundMode::color;
    session.settings().background.color = Vec3(1, 0, 0);
    session.refine();
    const Drawn two = session.refine().drawn;
    // A sum that is divided by the wrong number of frames darkens or lets the background through.
    const Image half = two.picture(), still = ball_session().render();
    const uint8_t *middle = half.at<uint8_t>(32, 24), *expected = still.at<uint8_t>(32, 24);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[c], expected[c], 6);  // noise of two frames against four
    EXPECT_EQ(half.at<uint8_t>(0, 0)[0], 255);
}

TEST(Refine, BeginsAnewWhenAnythingChanges) {
    Session session = ball_session();
    const auto began_after = [&](auto&& change) {
        session.refine();
        session.refine();
        change();
        return session.refine().began;
    };
    EXPECT_FALSE(began_after([] {}));
    EXPECT_TRUE(began_after([&] { session.settings().tonemap.exposure_compensation = 1; }));
    EXPECT_TRUE(began_after([&] { session.scene().show(make_box(), "box"); }));
    EXPECT_TRUE(began_after([&] {
        session.scene().get("box").set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(1, 0, 0)));
    }));
    EXPECT_TRUE(began_after([&] { session.scene().set_light("lamp", {}); }));
    EXPECT_TRUE(began_after([&] { session.render(); }));
    EXPECT_TRUE(began_after([&] { session.refine({Vec2i(32, 32), std::nullopt}); }));
    EXPECT_TRUE(began_after([&] { session.pick({1, 1}); }));
}

void distort(Session& session) {
    Camera camera = Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0));
    camera.intrinsics = Intrinsics{80, 80, 32, 24, 64, 48, 4};
    camera.distortion =
        Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.3, 0.1, 0.01, 0.02});
    session.set_camera(camera);
}

TEST(Refine, ShowsTheLensAsTheStillDoes) {
    Session session = ball_session(), plain = ball_session();
    distort(session);
    const Image still = session.render();
    const Drawn refined = complete(session);
    EXPECT_EQ(refined.picture().width(), 64);
    EXPECT_TRUE(same(refined.picture(), still));
    EXPECT_FALSE(session.refine().drew);
    // Also when something is looked up meanwhile, and when the lens is taken off again.
    session.pick({32, 24});
    EXPECT_TRUE(same(refined.picture(), still));
    EXPECT_FALSE(session.refine().drew);
    const Camera pinhole = Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0));
    session.set_camera(pinhole);
    plain.set_camera(pinhole);
    EXPECT_TRUE(same(complete(session).picture(), plain.render()));
}

TEST(Refine, ShowsMotionAsTheStillDoes) {
    const auto blurred_session = [] {
        Session session = ball_session();
        session.settings().motion_blur.enabled = true;
        session.settings().motion_blur.shutter = 1;
        session.set_camera(Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0)));
        return session;
    };
    Session session = blurred_session(), other = blurred_session();
    const Camera from = Camera::look_at(Vec3d(0.5, 0, 5), Vec3d(0.5, 0, 0));
    other.begin_motion(from);
    const Image still = other.render(), sharp = other.render();
    ASSERT_FALSE(same(still, sharp));
    const auto motion = std::make_shared<const Motion>(session.scene().snapshot(), from);
    EXPECT_TRUE(same(complete(session, motion).picture(), still));
    EXPECT_FALSE(session.refine({}, true, motion).drew);
    EXPECT_TRUE(session.refine({}, true).began);
    EXPECT_TRUE(same(complete(session).picture(), sharp));
    session.settings().motion_blur.enabled = false;
    EXPECT_TRUE(same(complete(session, motion).picture(), sharp));
}

/// To one step of 8 bits: a pose that is mixed with itself differs in the last bit.
bool alike(const Image& a, const Image& b) {
    return std::ranges::equal(a.bytes(), b.bytes(), [](std::byte x, std::byte y) {
        return std::abs(std::to_integer<int>(x) - std::to_integer<int>(y)) <= 1;
    });
}

// What is drawn for a lens is wider than the picture: that is no motion.
TEST(Refine, ALensAtRestIsNotBlurred) {
    Session session = ball_session();
    distort(session);
    const Camera camera = session.camera();
    const Image sharp = session.render();
    session.settings().motion_blur.enabled = true;
    session.settings().motion_blur.shutter = 1;
    session.forget_motion();
    session.begin_motion();
    EXPECT_TRUE(alike(session.render(), sharp)) << "begun";
    EXPECT_TRUE(alike(session.render(), sharp)) << "remembered";
    session.render({Vec2i(128, 96), 1});
    EXPECT_TRUE(alike(session.render(), sharp)) << "after a larger picture";
    const auto motion = std::make_shared<const Motion>(session.scene().snapshot(), camera);
    EXPECT_TRUE(alike(complete(session, motion).picture(), sharp)) << "refined";
    EXPECT_FALSE(session.refine({}, true, motion).drew);
    // Nor is another lens, or one that is put on or taken off.
    Camera other = camera, pinhole = camera;
    other.distortion->k[0] = 0.2;
    pinhole.distortion.reset();
    pinhole.intrinsics->skew = 0;
    for (const Camera& before : {other, pinhole}) {
        session.begin_motion(before);
        EXPECT_TRUE(alike(session.render(), sharp)) << "from another lens";
    }
    session.set_camera(pinhole);
    const Image taken_off = session.render();
    session.forget_motion();
    EXPECT_TRUE(alike(session.render(), taken_off));
}

TEST(Refine, ShowsMotionThroughALensAsTheStillDoes) {
    Session session = ball_session();
    distort(session);
    session.settings().motion_blur.enabled = true;
    session.settings().motion_blur.shutter = 1;
    Camera from = session.camera();
    from.T_world_cam.translation().x() += 0.5;
    session.begin_motion(from);
    const Image still = session.render(), sharp = session.render();
    EXPECT_FALSE(alike(still, sharp));
    const auto motion = std::make_shared<const Motion>(session.scene().snapshot(), from);
    EXPECT_TRUE(same(complete(session, motion).picture(), still));
    EXPECT_FALSE(session.refine({}, true, motion).drew);
}

TEST(Refine, PickingLeavesAFinishedPictureAlone) {
    Session session = ball_session();
    const Drawn refined = complete(session);
    const Image before = refined.picture();
    session.pick({32, 24});
    EXPECT_FALSE(session.refine().drew);
    EXPECT_TRUE(same(refined.picture(), before));
}

TEST(Pick, FindsTheFaceAndThePositionOnTheBall) {
    Session session = ball_session();
    session.set_view_point({Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
    const Vec2i size(65, 65);  // the middle pixel's centre is on the optical axis
    const std::optional<Pick> pick = session.pick({32.5, 32.5}, size);
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->object, "ball");
    EXPECT_TRUE(pick->is_face);
    // The axis goes through the ball's face before the vertex circle, or through a vertex: between the sphere
    // of radius 1 and the plane of its largest face, at most 1 - cos^2(pi / 32) below it.
    EXPECT_NEAR(pick->position.z(), 1, 0.02);
    EXPECT_NEAR(pick->position.head<2>().norm(), 0, 1e-6);
    EXPECT_NEAR(pick->depth, 5 - pick->position.z(), 1e-5);
    const Mesh ball = session.scene().get("ball");
    ASSERT_LT(pick->element, ball.F().rows());
    Eigen::AlignedBox3f face;
    for (int corner = 0; corner < 3; ++corner)
        face.extend(Vec3(ball.V().row(ball.F()(pick->element, corner))));
    const Vec3 p = pick->position.cast<float>();
    const Vec3 outside = p - p.cwiseMax(face.min()).cwiseMin(face.max());
    EXPECT_LT(outside.norm(), 1e-5);
    EXPECT_FALSE(session.pick({1, 1}, size));
    EXPECT_FALSE(session.pick({-5, 900}, size));
}

// The plane z = 0 is 5 before the camera everywhere: what is picked has to lie where the lens's own formula
// brings it back to the pixel's centre from.
TEST(Pick, FindsPositionsThroughTheLens) {
    Session session;
    session.scene().show(make_plane(20), "plane");
    session.scene().get("plane").set_T_parent_mesh(
        Eigen::Affine3d(Eigen::AngleAxisd(pi / 2, Vec3d::UnitX())));
    distort(session);
    const Camera camera = session.camera();
    int picked = 0;
    for (const Vec2d& pixel : {Vec2d(32, 24), Vec2d(3.5, 2.5), Vec2d(60.5, 40.5), Vec2d(10.5, 44.5)}) {
        const std::optional<Pick> pick = session.pick(pixel, Vec2i(64, 48));
        ASSERT_TRUE(pick);
        ++picked;
        EXPECT_NEAR(pick->position.z(), 0, 1e-5);  // the depth's float32
        const Vec2d seen =
            camera.distortion->distort(pick->position.head<2>().cwiseProduct(Vec2d(1, -1)) / 5);
        // 80 pixels of focal length, a skew of 4; from pixel centres at integers to our count.
        const Vec2d back(80 * seen.x() + 4 * seen.y() + 32.5, 80 * seen.y() + 24.5);
        const Vec2d centre(std::floor(pixel.x()) + 0.5, std::floor(pixel.y()) + 0.5);
        EXPECT_LT((back - centre).norm(), 1e-3) << pixel.transpose();
        EXPECT_LT((pixel_of(camera, pick->position, Vec2i(64, 48)).head<2>() - centre).norm(), 1e-6);
    }
    EXPECT_EQ(picked, 4);
}

// Faces turned away from the camera: the depth of the nearest drawn pixel is not that of the pixel's own ray.
TEST(Pick, FindsPositionsOnSlantedFacesThroughTheLens) {
    Session session = ball_session();
    distort(session);
    const Mesh ball = session.scene().get("ball");
    const Camera camera = session.camera();
    const PickBuffer buffer = session.pick_buffer(Vec2i(64, 48));
    int slanted = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec2d centre(x + 0.5, y + 0.5);
            const std::optional<Pick> pick = buffer.at(centre);
            if (!pick) continue;
            Vec3d corner[3];
            for (int k = 0; k < 3; ++k)
                corner[k] = Vec3(ball.V().row(ball.F()(pick->element, k))).cast<double>();
            const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
            const double cosine = normal.dot((camera.position() - pick->position).normalized());
            // Flatter ones may be met further beyond their edges than the depth's tolerance, 1 %.
            if (cosine < 0.75 || cosine > 0.95) continue;
            ++slanted;
            EXPECT_NEAR(normal.dot(pick->position - corner[0]), 0, 1e-9) << "computed in double precision";
            EXPECT_LT((pixel_of(camera, pick->position, Vec2i(64, 48)).head<2>() - centre).norm(), 1e-6);
        }
    EXPECT_GT(slanted, 100);
}

TEST(Pick, NamesPartsAndPoints) {
    Session session;
    Mesh quad = make_plane(2);
    quad.edit([](MeshData& data) {
        data.parts = {{"lower", 0, 1, 0}, {"upper", 1, 1, 0}};
        data.materials = {Material()};
    });
    session.scene().show(quad, "quad");
    const PickBuffer buffer = session.pick_buffer(Vec2i(64, 64));
    std::set<std::string> parts;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (const auto pick = buffer.at(Vec2d(x, y))) {
                parts.insert(pick->part);
                EXPECT_EQ(pick->part_index, pick->element);
            }
    EXPECT_EQ(parts, (std::set<std::string>{"lower", "upper"}));

    Array3f::Dense point(1, 3);
    point << 0, 0, 0;
    MeshData cloud;
    cloud.V = point;
    cloud.style.point_size = 9.0f;
    Session points;
    points.scene().show(Mesh(cloud), "cloud");
    points.set_view_point({Camera::look_at(Vec3d(0, 0, 5), Vec3d(0, 0, 0)), Vec3d(0, 0, 0)});
    const std::optional<Pick> pick = points.pick({32.5, 32.5}, Vec2i(65, 65));
    ASSERT_TRUE(pick);
    EXPECT_FALSE(pick->is_face);
    EXPECT_EQ(pick->element, 0);
}

TEST(ViewPoint, ReplacesAPinnedPositionAndComesNear) {
    Session session = ball_session();
    session.settings().camera.position = Vec3d(0, 0, 9);
    session.settings().camera.target = Vec3d(0, 0, 0);
    session.render();
    ViewPoint view = session.view_point();
    EXPECT_LT((view.camera.position() - Vec3d(0, 0, 9)).norm(), 1e-12);
    view = zoomed(view, 1e-3, Vec3d(0, 0, 1));
    session.set_view_point(view);
    const ViewPoint after = session.view_point();
    EXPECT_LT((after.target - view.target).norm(), 1e-9);
    // 8 mm before the ball's surface, and the near plane is nearer still.
    EXPECT_LT(after.camera.near, 0.008);
    ASSERT_TRUE(session.pick({32, 24}));
}

TEST(NearPlane, ComesAlongWithACameraThatSettingsMove) {
    Session session = ball_session();
    CameraSettings& camera = session.settings().camera;
    camera.position = Vec3d(0, 0, 100);
    camera.target = Vec3d(0, 0, 0);
    session.render();
    const double first = *camera.near;
    camera.position = Vec3d(0, 0, 1.1);
    EXPECT_LT(session.resolve().camera.near, 0.1);
    EXPECT_TRUE(session.pick({32, 24}));
    camera.position = Vec3d(0, 0, 100);
    EXPECT_EQ(session.resolve().camera.near, first);
}

}  // namespace
}  // namespace easypbr::app::live_picture_test
