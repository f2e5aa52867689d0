// Depth through a lens: that of the pixel's own ray, in layers and where the picture is focused.
#include <gtest/gtest.h>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "render/single_splats.h"

namespace easypbr::app::lens_depth_test {
namespace {

const Vec2i size(320, 240);

/// A floor 0.3 below a camera that looks along it. It stands at the origin, as OpenCV's axes do.
Session floor_session() {
    Mesh floor = make_plane(20);
    // The plane y = 0 as seen in OpenCV's axes, where y points down.
    floor.set_T_parent_mesh(Eigen::Translation3d(0, 0.3, 0) *
                            Eigen::Affine3d(Eigen::AngleAxisd(pi, Vec3d::UnitX())));
    Scene scene;
    scene.show(floor, "floor");
    Session session(scene);
    session.settings().image.size = size;
    session.settings().ground.mode = GroundMode::none;
    Mat3d K;
    K << 300, 0, 159.5, 0, 300, 119.5, 0, 0, 1;
    Camera camera = Camera::from_opencv(K, Mat4d::Identity(), size.x(), size.y());
    camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.1, 0.01, 0, 0});
    session.set_camera(camera);
    return session;
}

/// A ray of slope s meets the floor at the depth 0.3 / s.
double depth_of_floor(int x, int y) {
    const Distortion lens = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.1, 0.01, 0, 0});
    return 0.3 / lens.undistort({(x - 159.5) / 300, (y - 119.5) / 300}).y();
}

TEST(LensDepth, OfLayersIsThatOfThePixelsOwnRay) {
    Session session = floor_session();
    const Image depth = session.render_layers({"albedo", "depth"}).at("depth");
    int seen = 0;
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            const double found = depth.at<float>(x, y)[0];
            if (found == 0) continue;
            ++seen;
            // The ray's slope and the depth are float32: each is right to 6e-8 of itself.
            const double expected = depth_of_floor(x, y);
            EXPECT_NEAR(found, expected, 1e-6 * expected) << x << ", " << y;
        }
    // The plane reaches to a depth of 10, where the slope is 0.03: all rows from 129 on see it in the middle.
    EXPECT_GT(seen, 100 * 300);
}

TEST(LensDepth, OfTilesIsThatOfTheWhole) {
    Session session = floor_session();
    session.settings().ssao.enabled = false;  // Its reach leaves no room for small tiles.
    const Vec2i large(640, 480);
    const Image whole = session.render_layers({"depth"}, large).at("depth");
    session.limit_tiles({384, int64_t(1) << 25});
    const Image tiled = session.render_layers({"depth"}, large).at("depth");
    ASSERT_EQ(tiled.width(), large.x());
    for (int y = 0; y < large.y(); ++y)
        for (int x = 0; x < large.x(); ++x) {
            // The same face and ray, in double precision.
            ASSERT_EQ(tiled.at<float>(x, y)[0], whole.at<float>(x, y)[0]) << x << ", " << y;
        }
}

enum class Kind { points, surfels, splats };

/// Four primitives of a slanted plane, one in each quarter of the picture of floor_session().
Mesh four_of(Kind kind) {
    std::vector<render::single_splats::Splat> splats(4);
    Array3f::Dense N(4, 3), T(4, 3);
    for (int i = 0; i < 4; ++i) {
        const double x = i % 2 ? 1 : -1, y = i / 2 ? 0.75 : -0.75;
        splats[size_t(i)].mean = Vec3d(x, y, 4 + 0.5 * x);
        splats[size_t(i)].scales = Vec3d(0.3, 0.3, 0.1);
        splats[size_t(i)].opacity = 0.99;
        N.row(i) = Vec3(0.5f, 0, -1).normalized();
        T.row(i) << 0, 0.5f, 0;
    }
    MeshData mesh = render::single_splats::mesh_of(splats);
    if (kind == Kind::splats) return Mesh(mesh);
    MeshData plain;
    plain.V = mesh.V;
    plain.N = Array3f(N);
    plain.T = Array3f(T);
    plain.style.mode = kind == Kind::surfels ? DrawMode::surfels : DrawMode::points;
    return Mesh(plain);
}

TEST(LensDepth, OfPrimitivesInTilesIsThatOfTheWhole) {
    const Vec2i large(640, 480);
    for (const Kind kind : {Kind::points, Kind::surfels, Kind::splats}) {
        Session session = floor_session();
        session.scene().clear();
        session.scene().show(four_of(kind), "four");
        // Their reaches leave no room for small tiles.
        session.settings().ssao.enabled = false;
        session.settings().edl.enabled = false;
        session.settings().style.point_size = 40;
        const Image whole = session.render_layers({"depth"}, large).at("depth");
        session.limit_tiles({384, int64_t(1) << 25});
        const Image tiled = session.render_layers({"depth"}, large).at("depth");
        const std::span<const float> expected = whole.pixels<float>(), found = tiled.pixels<float>();
        ASSERT_EQ(found.size(), expected.size());
        int seen = 0, on_one_alone = 0;
        for (size_t i = 0; i < found.size(); ++i) {
            const bool is_seen = expected[i] > 0;
            seen += is_seen;
            on_one_alone += is_seen != (found[i] > 0);
            // Points have the depth that is drawn: the near plane over a float32, 6e-8 each.
            if (is_seen && found[i] > 0) {
                ASSERT_NEAR(found[i], expected[i], 5e-7 * expected[i]) << int(kind) << ' ' << i;
            }
        }
        EXPECT_GT(seen, 4 * 1000) << int(kind);
        // A tile's projection is rounded otherwise: a few of the pixels on rims, which are some 1000.
        EXPECT_LE(on_one_alone, 10) << int(kind);
        if (kind != Kind::surfels) continue;
        // The middle of the first of them, up to the slope of its plane within some pixels.
        EXPECT_NEAR(session.focus_at(150, 113, large), 3.5, 0.02);
    }
}

TEST(LensDepth, IsFocusedAt) {
    Session session = floor_session();
    const double expected = depth_of_floor(60, 130);
    EXPECT_NEAR(session.focus_at(60, 130), expected, 1e-6 * expected);
}

// Points have the depth that is drawn: each of them faces the camera. So have those that a cloud is shown as
// that lacks what surfels or splats are made of.
TEST(LensDepth, OfPointsIsTheDrawnOne) {
    for (const DrawMode mode : {DrawMode::points, DrawMode::surfels, DrawMode::splats}) {
        Session session = floor_session();
        Array3f::Dense V(1, 3);
        V << 0.5f, 0.25f, 4;
        MeshData data;
        data.V = Array3f(V);
        data.style.mode = mode;
        session.scene().clear();
        session.scene().show(Mesh(data), "point");
        session.settings().style.point_size = 20;
        const Image depth = session.render_layers({"depth"}).at("depth");
        int seen = 0;
        for (const float found : depth.pixels<float>()) {
            if (found == 0) continue;
            ++seen;
            EXPECT_NEAR(found, 4, 1e-5);
        }
        EXPECT_GT(seen, 100) << int(mode);
    }
}

}  // namespace
}  // namespace easypbr::app::lens_depth_test
