// What is cut away, drawn over everything, or filled between points.
#include <random>
#include <utility>
#include <vector>

#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::render::clip_test {

// Half of a square is cut away, in every way to draw it.
TEST(Clip, CutsEveryKind) {
    for (const DrawMode mode :
         {DrawMode::mesh, DrawMode::points, DrawMode::surfels, DrawMode::lines, DrawMode::voxels}) {
        MeshData data;
        constexpr int n = 41;
        Array3f::Dense V(n * n, 3), N(n * n, 3);
        for (int i = 0; i < n * n; ++i) {
            V.row(i) << float(i % n) / 20 - 1, float(i / n) / 20 - 1, 0;
            N.row(i) << 0, 0, 1;
        }
        Array3i::Dense F(2 * (n - 1) * (n - 1), 3);
        for (int y = 0, k = 0; y < n - 1; ++y)
            for (int x = 0; x < n - 1; ++x) {
                const int a = y * n + x;
                F.row(k++) << a, a + 1, a + n + 1;
                F.row(k++) << a, a + n + 1, a + n;
            }
        data.V = Array3f(V);
        data.N = Array3f(N);
        data.F = Array3i(F);
        data.style.mode = mode;
        data.style.voxel_size = 0.05f;
        Scene scene;
        scene.show(Mesh(data), "square");
        app::Session session = plain_session(scene, 100);
        look_from(session, Vec3d(0, 0, 5));
        const auto covered = [&] {
            const Image image = render_linear(session, 4);
            double left = 0, right = 0;
            for (int y = 0; y < 100; ++y)
                for (int x = 0; x < 100; ++x)
                    (x < 47 ? left : right) += x < 47 || x > 53 ? image.at<float>(x, y)[3] : 0;
            return std::pair(left, right);
        };
        const auto [left, right] = covered();
        EXPECT_GT(left, 500) << int(mode);
        session.settings().clip.planes = {1, 0, 0, 0};
        const auto [cut_left, cut_right] = covered();
        EXPECT_EQ(cut_left, 0) << int(mode);
        EXPECT_NEAR(cut_right, right, 0.02 * right) << int(mode);
        session.settings().clip.planes.clear();
        session.settings().clip.box = {-2, -2, -2, 0, 2, 2};
        const auto [box_left, box_right] = covered();
        EXPECT_NEAR(box_left, left, 0.02 * left) << int(mode);
        EXPECT_EQ(box_right, 0) << int(mode);
    }
}

TEST(Overlay, IsInFrontOfEverything) {
    for (const bool with_points : {false, true}) {
        Scene scene;
        scene.show(facing_square(1), "front");
        Mesh behind;
        if (with_points) {
            behind.set_V(Array3f(Array3f::Dense(Array3f::Dense::Zero(1, 3))));
        } else {
            behind = facing_square(0.3f);
        }
        behind.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1)));
        Style style;
        style.overlay = true;
        style.point_size = 12.0f;
        behind.set_style(style);
        scene.show(behind, "behind");
        app::Session session = plain_session(scene, 64);
        look_from(session, Vec3d(0, 0, 5));
        const Image id = session.render_layers({"object_id"}).at("object_id");
        EXPECT_EQ(*id.at<float>(32, 32), 1.0f) << with_points;
        EXPECT_EQ(*id.at<float>(10, 32), 2.0f) << with_points;
    }
}

// Every other column of a sheet of points is missing: filling closes the gaps and leaves the outline.
TEST(HoleFilling, ClosesGapsBetweenPoints) {
    constexpr int n = 60;
    Array3f::Dense V(n * n, 3);
    for (int i = 0; i < n * n; ++i) V.row(i) << float(i % n) / 30 - 1, float(i / n) / 30 - 1, 0;
    std::mt19937 random(5);
    std::vector<int> kept;
    for (int i = 0; i < n * n; ++i)
        if (random() % 4 != 0) kept.push_back(i);
    MeshData data;
    data.V = Array3f(Array3f::Dense(V(kept, Eigen::all)));
    Scene scene;
    scene.show(Mesh(data), "sheet");
    app::Session session = plain_session(scene, 64);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 64.0 / 30;
    session.settings().style.point_size = 1.0f;
    look_from(session, Vec3d(0, 0, 5));
    const auto holes_and_outside = [&](int times) {
        session.settings().points.hole_filling = times;
        const Image depth = session.render_layers({"depth"}).at("depth");
        int holes = 0, outside = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const bool inside = x >= 4 && x < 60 && y >= 4 && y < 60;
                holes += inside && *depth.at<float>(x, y) == 0;
                outside += (x < 1 || x > 62 || y < 1 || y > 62) && *depth.at<float>(x, y) > 0;
            }
        return std::pair(holes, outside);
    };
    EXPECT_GT(holes_and_outside(0).first, 500);
    EXPECT_LE(holes_and_outside(6).first, 5);
    EXPECT_EQ(holes_and_outside(6).second, 0);
}

}  // namespace easypbr::render::clip_test
