#include "easypbr/scene/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "easypbr/core/error.h"

namespace easypbr::camera_path_test {
namespace {

using Keys = std::vector<CameraKey>;

/// Keys with positions within a few units and turns of any size, some above 90 degrees.
Keys random_keys(int count, unsigned seed, bool even_times = false) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    Keys keys;
    for (int i = 0; i < count; ++i) {
        CameraKey key;
        const Vec3d axis(number(random), number(random), number(random));
        const Eigen::AngleAxisd turn(2 * number(random), axis.normalized());
        key.T_world_cam.linear() =
            (keys.empty() ? Mat3d(Mat3d::Identity()) : Mat3d(keys.back().T_world_cam.linear())) * turn;
        key.T_world_cam.translation() = 5 * Vec3d(number(random), number(random), number(random));
        key.segment_s = even_times ? 1 : 1.5 + number(random);
        keys.push_back(key);
    }
    return keys;
}

double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

double unitarity(const Eigen::Isometry3d& T) {
    return (T.linear() * T.linear().transpose() - Mat3d::Identity()).cwiseAbs().maxCoeff();
}

/// How far velocity and acceleration from before and after a time differ. Differences over `h` on either side
/// have errors of order h (one-sided second differences: h times the third derivative) and of rounding,
/// 1e-16 / h^2.
std::pair<double, double> jumps(const CameraPath& path, double time, double h) {
    const auto at = [&](double t) { return path.pose(t).matrix(); };
    const Mat4d before1 = at(time - h), before2 = at(time - 2 * h), before3 = at(time - 3 * h);
    const Mat4d after1 = at(time + h), after2 = at(time + 2 * h), after3 = at(time + 3 * h), here = at(time);
    // One-sided differences of second order for velocity, of second order for acceleration.
    const Mat4d velocity_before = (3 * here - 4 * before1 + before2) / (2 * h),
                velocity_after = (-3 * here + 4 * after1 - after2) / (2 * h);
    const Mat4d acceleration_before = (2 * here - 5 * before1 + 4 * before2 - before3) / (h * h),
                acceleration_after = (2 * here - 5 * after1 + 4 * after2 - after3) / (h * h);
    return {(velocity_before - velocity_after).cwiseAbs().maxCoeff(),
            (acceleration_before - acceleration_after).cwiseAbs().maxCoeff()};
}

class CameraPaths : public testing::TestWithParam<std::tuple<PathMode, bool, PathEase>> {
  protected:
    CameraPathOptions options() const {
        const auto [mode, closed, ease] = GetParam();
        return {mode, ease, closed};
    }
};

INSTANTIATE_TEST_SUITE_P(
    All, CameraPaths,
    testing::Combine(testing::Values(PathMode::smooth, PathMode::linear), testing::Bool(),
                     testing::Values(PathEase::none, PathEase::in, PathEase::out, PathEase::in_out)));

TEST_P(CameraPaths, PassThroughTheirKeys) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Keys keys = random_keys(2 + int(seed % 7), seed);
        const CameraPath path(keys, options());
        const std::vector<double> times = path.key_times_s();
        ASSERT_EQ(times.size(), keys.size());
        for (size_t i = 0; i < keys.size(); ++i)
            EXPECT_LT(difference(path.pose(times[i]), keys[i].T_world_cam), 1e-9) << "key " << i;
        for (const double t : path.times(101)) EXPECT_LT(unitarity(path.pose(t)), 1e-14);
    }
}

// A world that is moved and turned moves and turns the whole path: nothing depends on where zero is.
TEST_P(CameraPaths, DoNotDependOnTheWorldsFrame) {
    Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
    move.linear() = Eigen::AngleAxisd(2.3, Vec3d(1, -2, 0.5).normalized()).toRotationMatrix();
    move.translation() = Vec3d(10, -20, 30);
    const Keys keys = random_keys(6, 5);
    Keys moved = keys;
    for (CameraKey& key : moved) key.T_world_cam = move * key.T_world_cam;
    const CameraPath path(keys, options()), other(moved, options());
    for (const double t : path.times(50))
        EXPECT_LT(difference(move * path.pose(t), other.pose(t)), 1e-12) << t;
}

TEST(CameraPath, SmoothModeHasNoJumpInVelocityOrAcceleration) {
    for (const bool closed : {false, true})
        for (unsigned seed = 0; seed < 5; ++seed) {
            const CameraPath path(random_keys(6, seed), {PathMode::smooth, PathEase::none, closed});
            std::vector<double> times = path.key_times_s();
            if (closed) times.push_back(path.duration_s());
            for (size_t i = closed ? 0 : 1; i + 1 < times.size(); ++i) {
                const double time = closed && i == 0 ? path.duration_s() : times[i];
                const auto [velocity, acceleration] = jumps(path, time, 1e-4);
                EXPECT_LT(velocity, 1e-5);
                EXPECT_LT(acceleration, 1e-2);
            }
        }
}

// The test above sees the corners of the linear mode, whose velocity changes at a key by units per second.
TEST(CameraPath, LinearModeHasCorners) {
    const CameraPath path(random_keys(6, 1), {PathMode::linear});
    EXPECT_GT(jumps(path, path.key_times_s()[2], 1e-4).first, 0.1);
}

TEST(CameraPath, LinearModeIsALineAndTheShorterArc) {
    Keys keys(2);
    keys[1].T_world_cam.translation() = Vec3d(4, 0, -8);
    // 270 degrees one way are 90 the other way.
    keys[1].T_world_cam.linear() = Eigen::AngleAxisd(1.5 * pi, Vec3d::UnitY()).toRotationMatrix();
    const CameraPath path(keys, {PathMode::linear});
    EXPECT_LT((path.pose(0.25).translation() - Vec3d(1, 0, -2)).norm(), 1e-15);
    const Mat3d expected = Eigen::AngleAxisd(-pi / 8, Vec3d::UnitY()).toRotationMatrix();
    EXPECT_LT((path.pose(0.25).linear() - expected).cwiseAbs().maxCoeff(), 1e-15);
}

// A natural cubic spline through 0, 1, 0 at 0, 1, 2 has the acceleration -3 in the middle (solved on paper:
// 4 M = 6 (-1 - 1)), so at 0.5 it is at 0.5 + (0.125 - 0.5) * -3 / 6 = 0.6875.
TEST(CameraPath, SmoothPositionsAreTheNaturalSpline) {
    Keys keys(3);
    keys[1].T_world_cam.translation().x() = 1;
    EXPECT_NEAR(CameraPath(keys).pose(0.5).translation().x(), 0.6875, 1e-15);
}

// Four quarter turns in a closed path are one turn: by symmetry every key has the same speed, the axis stays,
// and half way between two keys the camera is half way.
TEST(CameraPath, ClosedQuarterTurnsAreOneTurn) {
    Keys keys(4);
    for (int i = 0; i < 4; ++i)
        keys[size_t(i)].T_world_cam.linear() =
            Eigen::AngleAxisd(i * pi / 2, Vec3d::UnitY()).toRotationMatrix();
    const CameraPath path(keys, {PathMode::smooth, PathEase::none, true});
    EXPECT_EQ(path.duration_s(), 4);
    for (const double t : {0.5, 1.5, 3.5, 4.5, -0.5}) {
        const Mat3d expected = Eigen::AngleAxisd(t * pi / 2, Vec3d::UnitY()).toRotationMatrix();
        EXPECT_LT((path.pose(t).linear() - expected).cwiseAbs().maxCoeff(), 1e-12) << t;
    }
}

TEST(CameraPath, EasingStartsAndEndsAtRest) {
    Keys keys(2);
    keys[1].T_world_cam.translation().x() = 1;
    const auto x = [&](PathEase ease, double t) {
        return CameraPath(keys, {PathMode::linear, ease}).pose(t).translation().x();
    };
    EXPECT_EQ(x(PathEase::in_out, 0.5), 0.5);
    // 10 x^3 - 15 x^4 + 6 x^5 and 2 x^3 - x^4 at 1/4.
    EXPECT_NEAR(x(PathEase::in_out, 0.25), 10.0 / 64 - 15.0 / 256 + 6.0 / 1024, 1e-15);
    EXPECT_NEAR(x(PathEase::in, 0.25), 2.0 / 64 - 1.0 / 256, 1e-15);
    EXPECT_NEAR(x(PathEase::out, 0.75), 1 - (2.0 / 64 - 1.0 / 256), 1e-15);
    for (const PathEase ease : {PathEase::in, PathEase::in_out}) EXPECT_LT(x(ease, 1e-3), 1e-7);
    EXPECT_GT(x(PathEase::out, 1e-3), 1e-3);
}

TEST(CameraPath, RestsOutsideOfItsTimeUnlessClosed) {
    const Keys keys = random_keys(3, 9, true);
    const CameraPath open(keys), closed(keys, {PathMode::smooth, PathEase::none, true});
    EXPECT_LT(difference(open.pose(-1), keys[0].T_world_cam), 1e-14);
    EXPECT_LT(difference(open.pose(99), keys[2].T_world_cam), 1e-14);
    EXPECT_LT(difference(closed.pose(3.25), closed.pose(0.25)), 1e-14);
}

// Zooming from 20 to 60 degrees: half way the picture's half height is the geometric mean.
TEST(CameraPath, ZoomsEvenly) {
    Keys keys(2);
    keys[0].fov_y_deg = 20;
    keys[1].fov_y_deg = 60;
    const double expected = 2 * std::atan(std::sqrt(std::tan(radians(10)) * std::tan(radians(30))));
    for (const PathMode mode : {PathMode::smooth, PathMode::linear}) {
        const CameraPath path(keys, {mode});
        EXPECT_NEAR(*path.fov_y_deg(0.5), degrees(expected), 1e-12);
        EXPECT_NEAR(path.camera(1).fov_y_deg, 60, 1e-12);
    }
    Camera like;
    like.fov_y_deg = 44;
    EXPECT_EQ(CameraPath(random_keys(2, 1)).camera(0, like).fov_y_deg, 44);
}

// tan(45 / 2) and tan(90 / 2) = 1 have the geometric mean sqrt(tan(22.5)) half way.
TEST(CameraPath, KeysWithoutAnAngleOfViewGetOne) {
    Keys keys = random_keys(5, 3, true);
    keys[1].fov_y_deg = 45;
    keys[3].fov_y_deg = 90;
    const double middle = degrees(2 * std::atan(std::sqrt(std::tan(radians(22.5)))));
    for (const PathMode mode : {PathMode::smooth, PathMode::linear}) {
        const CameraPath path(keys, {mode});
        const std::vector<double> expected{45, 45, middle, 90, 90};
        for (size_t i = 0; i < keys.size(); ++i) {
            EXPECT_NEAR(*path.fov_y_deg(double(i)), expected[i], 1e-9) << i;
            EXPECT_NEAR(*path.keys()[i].fov_y_deg, expected[i], 1e-9) << i;
        }
    }
}

// A height of 200 pixels at a focal length of 100: tan(fov / 2) = 1.
TEST(CameraPath, CalibratedCamerasHaveTheAngleOfTheirMatrix) {
    Mat3d K;
    K << 150, 0, 40, 0, 100, 30, 0, 0, 1;
    const Camera calibrated = Camera::from_opencv(K, Mat4d::Identity(), 320, 200);
    Camera plain = Camera::look_at(Vec3d(0, 0, 5), Vec3d::Zero());
    plain.fov_y_deg = 20;
    const CameraPath mixed({CameraKey::at(calibrated), CameraKey::at(plain)});
    EXPECT_NEAR(*mixed.fov_y_deg(0), 90, 1e-9);
    EXPECT_NEAR(*mixed.fov_y_deg(1), 20, 1e-9);
    // Alone they leave the camera its own.
    const CameraPath alone({CameraKey::at(calibrated), CameraKey::at(calibrated), CameraKey()});
    EXPECT_FALSE(alone.fov_y_deg(0.5).has_value());
    EXPECT_TRUE(alone.camera(0.5, calibrated).opencv_K(320, 200).isApprox(K, 1e-12));
    Camera flat = plain;
    flat.projection = Projection::orthographic;
    EXPECT_THROW(CameraPath({CameraKey::at(flat), CameraKey::at(plain)}), ArgumentError);
    EXPECT_THROW(CameraPath({CameraKey::at(flat), CameraKey::at(calibrated)}), ArgumentError);
    EXPECT_FALSE(CameraPath({CameraKey::at(flat), CameraKey::at(flat)}).fov_y_deg(0).has_value());
}

TEST(CameraPath, OrbitsKeepTheDistanceAndTheView) {
    const Vec3d center(1, 2, 3);
    const Camera start = Camera::look_at(Vec3d(4, 3, 7), center);
    const CameraPath path = CameraPath::orbit(start, center, Vec3d(0, 2, 0), 360, 8);
    EXPECT_TRUE(path.is_closed());
    const double distance = (start.position() - center).norm();
    for (const double t : path.times(37)) {
        const Eigen::Isometry3d pose = path.pose(t);
        EXPECT_NEAR((pose.translation() - center).norm(), distance, 1e-14 * 10);
        EXPECT_LT((-pose.linear().col(2) * distance - (center - pose.translation())).norm(), 1e-13);
    }
    // A quarter of the time: x goes to -z, z to x.
    EXPECT_LT((path.pose(2).translation() - Vec3d(1 + 4, 3, 3 - 3)).norm(), 1e-14);
    EXPECT_FALSE(CameraPath::orbit(start, center, Vec3d::UnitY(), 90, 1).is_closed());
}

TEST(CameraPath, FrameTimesCoverThePath) {
    const Keys keys = random_keys(3, 2, true);
    const std::vector<double> open = CameraPath(keys).frame_times(30);
    EXPECT_EQ(open.size(), 61u);
    EXPECT_EQ(open.front(), 0);
    EXPECT_EQ(open.back(), 2);
    const CameraPath closed(keys, {PathMode::smooth, PathEase::none, true});
    EXPECT_EQ(closed.frame_times(30).size(), 90u);
    EXPECT_NEAR(closed.frame_times(30)[1], 1 / 30.0, 1e-15);
    // Both ends of an open path are in it, however short the path is.
    EXPECT_EQ(CameraPath(keys).frame_times(0.1), (std::vector<double>{0, 2}));
    EXPECT_EQ(closed.frame_times(0.1), (std::vector<double>{0}));
    EXPECT_THROW(closed.frame_times(0), ArgumentError);
    EXPECT_THROW(closed.times(0), ArgumentError);
}

// Three keys a second apart: two seconds, and three around. The last frame of the open path is at its end.
TEST(CameraPath, FramesLastAsLongAsThePath) {
    const Keys keys = random_keys(3, 2, true);
    const CameraPath open(keys), closed(keys, {PathMode::smooth, PathEase::none, true});
    EXPECT_EQ(open.frame_rate(21), 10);
    EXPECT_EQ(closed.frame_rate(30), 10);
    EXPECT_EQ(open.times(21)[1], 0.1);
    EXPECT_EQ(closed.times(30)[1], 0.1);
    EXPECT_EQ(open.frame_rate(1), 0.5);
    EXPECT_THROW(open.frame_rate(0), ArgumentError);
}

std::string error_of(const Keys& keys, const CameraPathOptions& options = {}) {
    try {
        CameraPath(keys, options).pose(0);
    } catch (const ArgumentError& error) {
        return error.what();
    }
    return "no error";
}

TEST(CameraPath, IsThereAfterItWasMovedFrom) {
    CameraPath orbit = CameraPath::orbit(Camera::look_at({0, 0, 3}, {0, 0, 0}), {0, 0, 0});
    CameraPath path({CameraKey{}, CameraKey{}});
    const CameraPath taken_orbit = std::move(orbit), taken_path = std::move(path);
    EXPECT_EQ(orbit.pose(0.5).matrix(), taken_orbit.pose(0.5).matrix());
    EXPECT_EQ(path.pose(0.5).matrix(), taken_path.pose(0.5).matrix());
}

TEST(CameraPath, RefusesWhatIsNoPath) {
    EXPECT_EQ(error_of({}), "camera path: expected at least two keys, got 0");
    EXPECT_EQ(error_of(Keys(1)), "camera path: expected at least two keys, got 1");
    Keys keys(3);
    keys[1].segment_s = 0;
    EXPECT_EQ(error_of(keys), "camera path: expected a time above 0 seconds from key 1 to the next, got 0");
    keys[1].segment_s = 1;
    keys[2].segment_s = -1;
    EXPECT_EQ(error_of(keys), "no error");
    EXPECT_NE(error_of(keys, {PathMode::smooth, PathEase::none, true}), "no error");
    keys[2].segment_s = 1;
    keys[2].T_world_cam.linear() *= 2;
    EXPECT_NE(error_of(keys).find("key 2: camera pose: expected a rotation"), std::string::npos)
        << error_of(keys);
    keys = Keys(3);
    keys[2].fov_y_deg = 30;
    keys[1].is_orthographic = true;
    EXPECT_NE(error_of(keys).find("key 1 is orthographic and key 2 perspective"), std::string::npos);
    keys[2].fov_y_deg.reset();
    EXPECT_EQ(error_of(keys), "no error");
    keys[0].fov_y_deg = 180;
    EXPECT_NE(error_of(keys).find("between 0 and 180"), std::string::npos);
    EXPECT_THROW(CameraPath(Keys(2)).pose(std::numeric_limits<double>::quiet_NaN()), ArgumentError);
    EXPECT_THROW(CameraPath::orbit({}, Vec3d::Zero(), Vec3d::Zero()), ArgumentError);
    EXPECT_THROW(CameraPath::orbit({}, Vec3d::Zero(), Vec3d::UnitY(), 0), ArgumentError);
    EXPECT_THROW(CameraPath::orbit({}, Vec3d::Zero(), Vec3d::UnitY(), 360, 0), ArgumentError);
}

// Half a turn in a millisecond and then seconds of rest: a motion without a jump in acceleration would have
// to swing on, and its quaternions pass zero.
TEST(CameraPath, RefusesToTumble) {
    Keys keys(4);
    keys[1].T_world_cam.linear() = Eigen::AngleAxisd(1.5, Vec3d::UnitY()).toRotationMatrix();
    keys[2].T_world_cam.linear() = Eigen::AngleAxisd(3.0, Vec3d::UnitY()).toRotationMatrix();
    keys[3].T_world_cam.linear() = Eigen::AngleAxisd(1.5, Vec3d::UnitX()).toRotationMatrix();
    keys[1].segment_s = 1e-3;
    EXPECT_NE(error_of(keys).find("tumbles"), std::string::npos) << error_of(keys);
    EXPECT_EQ(error_of(keys, {PathMode::linear}), "no error");
}

TEST(CameraPath, HoldsManyKeys) {
    const CameraPath path(random_keys(2000, 3, true), {PathMode::smooth, PathEase::in_out, true});
    EXPECT_LT(unitarity(path.pose(path.duration_s() / 3)), 1e-14);
}

}  // namespace
}  // namespace easypbr::camera_path_test
