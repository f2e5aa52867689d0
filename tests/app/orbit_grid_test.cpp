// Cameras all around the content: on turntables, and in grids of directions.
#include "easypbr/app/orbit_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/recorder.h"
#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"
#include "scene/slide.h"

namespace easypbr::app::orbit_grid_test {
namespace {

using Points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Faces = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Of a long box beside the origin.
Points corners() {
    Points V(8, 3);
    for (int i = 0; i < 8; ++i)
        V.row(i) = Eigen::RowVector3f(float(i & 1) * 4 + 1, float(i >> 1 & 1), float(i >> 2 & 1));
    return V;
}

Mesh box() {
    Faces F(4, 3);
    F << 0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7;
    return {corners(), F};
}

Session session_of(const Mesh& mesh) {
    Session session;
    session.scene().show(mesh, "box");
    session.settings().image.size = {160, 90};
    return session;
}

double elevation_deg(const Camera& camera) {
    return std::asin(camera.T_world_cam.linear()(1, 2)) * 180 / pi;
}

TEST(OrbitGrid, HasTheSessionsCameraInIt) {
    Session session = session_of(box());
    const OrbitGrid grid = orbit_grid(session, 8, 3, 20);
    ASSERT_EQ(grid.cameras.size(), 24u);
    EXPECT_EQ(grid.start_row, 1);
    const Mat3d given = session.camera().T_world_cam.linear();
    EXPECT_TRUE(grid.cameras[8].T_world_cam.linear().isApprox(given, 1e-9));
    for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(grid.elevations_deg[size_t(row)], 15 + 20 * (row - 1), 1e-6);
        for (int column = 0; column < 8; ++column)
            EXPECT_NEAR(elevation_deg(grid.cameras[size_t(8 * row + column)]), 15 + 20 * (row - 1), 1e-6);
    }
}

TEST(OrbitGrid, GoesCounterClockwiseSeenFromAbove) {
    Session session = session_of(box());
    const OrbitGrid grid = orbit_grid(session, 4, 1, 20);
    const Vec3d middle(3, 0.5, 0.5);
    for (size_t i = 0; i < 4; ++i) {
        const Vec3d from = grid.cameras[i].position() - middle,
                    to = grid.cameras[(i + 1) % 4].position() - middle;
        EXPECT_NEAR(from.cross(to).y() / Vec2d(from.x(), from.z()).squaredNorm(), 1, 1e-6);
    }
}

TEST(OrbitGrid, KeepsTheContentInAllPictures) {
    Session session = session_of(box());
    const Points V = corners();
    const OrbitGrid grid = orbit_grid(session, 12, 5, 25);
    double closest = std::numeric_limits<double>::infinity();
    for (const Camera& camera : grid.cameras)
        for (Eigen::Index i = 0; i < V.rows(); ++i) {
            const Vec3d p = camera.T_world_cam.inverse() * Vec3d(V.row(i).transpose().cast<double>());
            const double tangent = std::tan(radians(camera.fov_y_deg) / 2);
            const double x = 1 - std::abs(p.x() / p.z()) / (tangent * 160 / 90),
                         y = 1 - std::abs(p.y() / p.z()) / tangent;
            EXPECT_LT(p.z(), 0);
            closest = std::min({closest, x, y});
        }
    EXPECT_GT(closest, 0);
    EXPECT_LT(closest, 0.2);  // And no further away than that takes.
}

TEST(OrbitGrid, KeepsTheContentInOrthographicPictures) {
    Session session = session_of(box());
    session.settings().camera.projection = Projection::orthographic;
    const Points V = corners();
    double closest = std::numeric_limits<double>::infinity();
    for (const Camera& camera : orbit_grid(session, 12, 5, 25).cameras)
        for (Eigen::Index i = 0; i < V.rows(); ++i) {
            const Vec3d p = camera.T_world_cam.inverse() * Vec3d(V.row(i).transpose().cast<double>()),
                        part = 2 * p / camera.ortho_height;
            EXPECT_LT(p.z(), 0);
            closest = std::min({closest, 1 - std::abs(part.x()) * 90 / 160, 1 - std::abs(part.y())});
        }
    EXPECT_GT(closest, 0);
    EXPECT_LT(closest, 0.2);
}

TEST(OrbitGrid, StaysBelowTheTop) {
    Session session = session_of(box());
    session.settings().camera.elevation_deg = 80;
    const OrbitGrid grid = orbit_grid(session, 1, 4, 30);
    EXPECT_EQ(grid.start_row, 3);
    EXPECT_NEAR(grid.elevations_deg.front(), -10, 1e-6);
    EXPECT_NEAR(grid.elevations_deg.back(), 80, 1e-6);
}

TEST(OrbitGrid, TurnsACameraThatIsPinnedAtItsDistance) {
    Session session = session_of(box());
    Camera camera = session.camera();
    camera.T_world_cam.translation() += Vec3d(1, 2, 3);
    session.set_camera(camera);
    const OrbitGrid grid = orbit_grid(session, 6, 3, 10);
    const Vec3d middle(3, 0.5, 0.5);
    for (const Camera& each : grid.cameras)
        EXPECT_NEAR((each.position() - middle).norm(), (camera.position() - middle).norm(), 1e-6);
}

TEST(OrbitGrid, RefusesWhatIsNoGrid) {
    for (const auto& [columns, rows, step] : {std::tuple(0, 3, 20.0),
                                              {361, 3, 20.0},
                                              {36, 0, 20.0},
                                              {36, 61, 1.0},
                                              {36, 3, 0.0},
                                              {36, 3, 81.0},
                                              {36, 3, std::nan("")}})
        EXPECT_THROW(check_orbit_grid(columns, rows, step), ArgumentError);
    EXPECT_NO_THROW(check_orbit_grid(360, 60, 2.7));
}

/// How far the corners of a mesh stay from the border of pictures of 3 : 2 all the way along a path, as a
/// part of their halves; below 0: outside.
double nearest_border(const CameraPath& path, const Camera& like, const Mesh& mesh) {
    double nearest = 1;
    for (const double t : path.times(24)) {
        const Camera camera = path.camera(t, like);
        const Mat4d P = camera.projection_matrix(1.5) * camera.view();
        for (Eigen::Index i = 0; i < mesh.V().rows(); ++i) {
            const Vec3d world = mesh.T_world_mesh() * mesh.V().row(i).transpose().cast<double>();
            const Eigen::Vector4d clip = P * world.homogeneous();
            if (!(clip.w() > 0)) return -1;
            const double reach = clip.head<2>().cwiseAbs().maxCoeff() / clip.w();
            nearest = std::min(nearest, 1 - reach);
        }
    }
    return nearest;
}

Mesh distant_bar() {
    Mesh bar = make_box(Vec3(0.2f, 0.3f, 4));
    bar.translate({5, 0, 0});
    return bar;
}

Session session_of_bar(const Mesh& bar) {
    Scene scene;
    scene.show(bar, "bar");
    Session session(scene);
    session.settings().image.size = Vec2i(96, 64);
    return session;
}

// Content that is much deeper than wide is seen whole from every side, and touches the picture's border from
// one.
TEST(Turntable, KeepsTheContentInThePicture) {
    const Mesh bar = distant_bar();
    Session session = session_of_bar(bar);
    const CameraPath path = turntable(session, 1);
    const double nearest = nearest_border(path, session.camera(), bar);
    // The margin, 5 % of both sides together, is kept; the cylinder around the bar is a little larger than
    // it.
    EXPECT_GT(nearest, 0.049);
    EXPECT_LT(nearest, 0.09);
    // A camera that was chosen stays where it is.
    session.set_camera(Camera::look_at(Vec3d(5, 0, 9), Vec3d(5, 0, 0)));
    EXPECT_LT((turntable(session, 1).pose(0).translation() - Vec3d(5, 0, 9)).norm(), 1e-12);
}

// The height of an orthographic picture holds the content from every side; one that was chosen stays.
TEST(Turntable, KeepsTheContentInOrthographicPictures) {
    const Mesh bar = distant_bar();
    Session session = session_of_bar(bar);
    session.settings().camera.projection = Projection::orthographic;
    const CameraPath path = turntable(session, 1);
    const double nearest = nearest_border(path, session.camera(), bar);
    EXPECT_GT(nearest, 0.049);
    EXPECT_LT(nearest, 0.09);
    session.settings().camera.ortho_height = 1;
    EXPECT_EQ(turntable(session, 1).camera(0.3, session.camera()).ortho_height, 1);
}

// A small box goes 2 units along x in 4 seconds. A turn while it plays shows it whole wherever it is, around
// the middle of its way; it is afterwards where it was.
TEST(Turntable, KeepsWhatAnAnimationMovesInThePicture) {
    Scene scene;
    Mesh box = make_box(Vec3(0.2f, 0.2f, 0.2f));
    scene.show(box, "box");
    AnimationNode node;
    node.mesh = box;
    Clock clock;
    AnimationPlayer player(clock);
    player.add("box", Animations({{node}, {}, {}, {slide("slide")}}));
    Session session(scene);
    session.settings().image.size = Vec2i(96, 64);
    const Vec3d at_rest = turntable(session, 4).pose(0).translation();
    const auto begin = [&](const CameraPath& path) { return Vec3d(path.pose(0).translation()); };
    EXPECT_EQ(begin(turntable(session, 4, player)), at_rest) << "nothing plays";
    player.play(0);
    // A turn of more than one time around shows no more.
    for (const double duration_s : {4.0, 9.0}) {
        const CameraPath path = turntable(session, duration_s, player);
        EXPECT_EQ(box.T_parent_mesh().translation().x(), 0);
        const Camera like = session.camera();
        double nearest = 1;
        for (const double x : {0.0, 1.0, 2.0}) {
            box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
            nearest = std::min(nearest, nearest_border(path, like, box));
        }
        box.set_T_parent_mesh(Eigen::Affine3d::Identity());
        // The margin, 5 % of both sides together; the cylinder around all poses is a little larger than they.
        EXPECT_GT(nearest, 0.049);
        EXPECT_LT(nearest, 0.15);
        EXPECT_NEAR((path.pose(0).translation() + path.pose(duration_s / 2).translation()).x() / 2, 1, 1e-6);
    }
    player.pause();
    EXPECT_EQ(begin(turntable(session, 4, player)), at_rest) << "it is paused";
}

}  // namespace
}  // namespace easypbr::app::orbit_grid_test
