// Cameras all around the content.
#include "easypbr/app/orbit_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "easypbr/core/error.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/settings.h"

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

}  // namespace
}  // namespace easypbr::app::orbit_grid_test
