// Path tracing at the borders of surfaces: where rays start, and what lies below interpolated normals.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "easypbr/render/raytrace/smooth_surface.h"
#include "render_test.h"
#include "tilted_normals.h"

namespace easypbr::path_surfaces_test {
namespace {

app::Session path_session(const Scene& scene, int size) {
    app::Session session = plain_session(scene, size);
    Settings& s = session.settings();
    s.path.enabled = true;
    s.path.clamp = 0;
    s.shadows.enabled = true;
    return session;
}

Material matt(float color) {
    Material m;
    m.base_color = Vec3::Constant(color);
    m.roughness = 1;
    return m;
}

/// Parallel light that sends the irradiance pi across its direction.
void shine(Scene& scene, const Vec3& direction) {
    Light light;
    light.type = LightType::directional;
    light.direction = direction;
    light.intensity = float(pi);
    light.color = Vec3::Ones();
    scene.set_light("light", light);
}

/// Red, of all pixels.
double mean_of(const Image& image) {
    double sum = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) sum += double(image.at<float>(x, y)[0]);
    return sum / double(image.pixel_count());
}

/// Few large discs, far from the origin.
Mesh coarse_cloud() {
    Array3f::Dense V(8, 3), N(8, 3), T(8, 3);
    for (int i = 0; i < 8; ++i) {
        V.row(i) = Eigen::RowVector3f(5 + float(i % 2), float(i / 2 % 2), float(i / 4));
        N.row(i) = Eigen::RowVector3f(0, 1, 0);
        T.row(i) = Eigen::RowVector3f(0.5f, 0, 0);
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.T = Array3f(T);
    data.B = Array1f(Array1f::Dense::Constant(8, 0.5f));
    return Mesh(data);
}

// Within walls that send 1 and reflect nothing a ball of albedo 1/2 shows 1/2, however near they are: rays
// that leave a face start at the face, whatever else is in the scene reaches beyond its vertices.
TEST(PathSurfaces, CloudsLeaveContactsOfMeshesAlone) {
    Mesh room = make_box(Vec3(2, 2, 2));
    Material glowing = matt(0);
    glowing.emissive = Vec3::Ones();
    glowing.specular = 0;
    room.set_material(glowing);
    for (const float specular : {0.0f, 1.0f}) {
        Material m = matt(0.5f);
        m.specular = specular;
        Mesh ball = make_sphere(0.98, 64);
        ball.set_material(m);
        Scene scene;
        scene.show(room, "room");
        scene.show(ball, "ball");
        scene.show(coarse_cloud(), "cloud");
        app::Session session = path_session(scene, 16);
        session.settings().shading.dielectric_f0 = 0;
        // Across the ball, and where it nearly meets the wall: 0.08 away, of 0.5 that the cloud reaches.
        for (const Vec3d& from : {Vec3d(0.95, 0.95, 0.95), Vec3d(0.93, 0.5, 0)}) {
            look_from(session, from, 5);
            if (from.z() == 0) session.settings().camera.target = Vec3d(0.921, 0.335, 0);
            // The Fresnel reflection at grazing angles adds up to 0.07 at 70 degrees, and 0.02 straight on.
            const double reflected = specular * (from.z() == 0 ? 0.07 : 0.02);
            EXPECT_NEAR(mean_of(render_linear(session, 64)), 0.5, 0.005 + reflected) << specular;
        }
    }
}

// Lambert with a mapped normal: lamps bring n . l, but for those below the face, which hides them though the
// normal is turned to them. 0.01: 8 bits of the normal texture.
TEST(PathSurfaces, LampsOnMappedNormals) {
    const double tilt = radians(55);
    const std::function<void(Material&)> plain = [](Material&) {},
                                         extended = [](Material&m) { m.specular_color = Vec3(1, 1, 0.9f); };
    for (const auto& change : {plain, extended}) {
        Material m = matt(0.8f);
        m.specular = 0;
        m.normal_texture.image = tilted_normals(tilt);
        change(m);
        Scene scene;
        scene.show(facing_square(1, m), "square");
        shine(scene, Vec3(0, 0, -1));
        app::Session session = path_session(scene, 8);
        look_from(session, Vec3d(0, 0, 4), 10);
        for (const bool flat : {false, true}) {
            session.settings().style.flat = flat;
            EXPECT_NEAR(render_linear(session, 16).at<float>(4, 4)[0], 0.8 * std::cos(tilt), 0.01) << flat;
            const Image layer = session.render_layers({"normal_world"}).at("normal_world");
            const Vec3 wanted(float(std::sin(tilt)), 0, float(std::cos(tilt)));
            EXPECT_LT((Vec3(layer.at<float>(4, 4)) - wanted).norm(), 0.01f) << flat;
        }
        shine(scene, Vec3(-1, 0, 0.2f).normalized());
        app::Session from_below = path_session(scene, 8);
        look_from(from_below, Vec3d(0, 0, 4), 10);
        EXPECT_EQ(render_linear(from_below, 16).at<float>(4, 4)[0], 0);
    }
}

// Normals that a map tilts by up to 85 degrees send most of the light below the face. It is mirrored there:
// it meets the surface once, and a part of 0.8 of an even sky is left. 0.005: as of Paths.WhiteFurnace.
TEST(PathSurfaces, TiltedNormalsReflectOnce) {
    for (const double tilt : {70.0, 76.0, 80.0, 85.0})
        for (const double height : {70.0, 40.0, 15.0}) {
            Material m = matt(0.8f);
            m.metallic = 1;
            m.roughness = 0.2f;
            m.normal_texture.image = tilted_normals(radians(tilt));
            Scene scene;
            scene.show(facing_square(1, m), "square");
            scene.set_environment(constant_environment(1));
            app::Session session = path_session(scene, 8);
            session.settings().environment.enabled = true;
            look_from(session, Vec3d(4 * std::cos(radians(height)), 0, 4 * std::sin(radians(height))), 5);
            // Schlick's part of what the mirror lacks.
            const double cosine = std::cos(radians(tilt + height - 90));
            EXPECT_NEAR(mean_of(render_linear(session, 64)), 0.8 + 0.2 * std::pow(1 - cosine, 5), 0.005)
                << tilt << " degrees, seen from " << height;
        }
}

// A coarse ball with interpolated normals is as bright as the cosine makes it: no face stands out, and none
// hides the light from itself where it is turned away by up to 13 degrees more than its normals, of a light
// of up to 0.18. 0.004: roundings of normals and colours to 8 and 16 bits. 0.02: what a pixel's samples see
// of a face in other places.
TEST(PathSurfaces, LampsShowNoFaces) {
    const std::function<void(Material&)> extended = [](Material&m) { m.specular = 0; },
                                         plain = [](Material&) {};
    for (const auto& change : {extended, plain}) {
        Mesh ball = make_sphere(1, 12);
        Material m = matt(0.8f);
        change(m);
        ball.set_material(m);
        Scene scene;
        scene.show(ball, "ball");
        shine(scene, Vec3(-1, 0, -0.3f).normalized());
        app::Session session = path_session(scene, 64);
        session.settings().shading.dielectric_f0 = 0;
        look_from(session, Vec3d(0, 0, 5), 25);
        const Image traced = render_linear(session, 8);
        session.settings().path.enabled = false;
        session.settings().shadows.enabled = false;
        const Image cosines = render_linear(session, 8);
        float brighter = 0, darker = 0, brightest = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const Vec4 a(traced.at<float>(x, y)), b(cosines.at<float>(x, y));
                if (a.w() < 1 || b.w() < 1) continue;
                brighter = std::max(brighter, a.x() - b.x());
                darker = std::max(darker, b.x() - a.x());
                brightest = std::max(brightest, a.x());
            }
        EXPECT_LT(brighter, 0.004);
        EXPECT_LT(darker, 0.02);
        // Where a face and the light meet at less than 12 degrees; plain surfaces mirror some of it.
        EXPECT_NEAR(brightest, 0.77, 0.05);
    }
}

// The surface at right angles to the normals of an octant's corners is below the unit sphere: from the
// middle, (1, 1, 1) / 3, each corner's plane is 2/3 away, so that the mean of the places on them is (1, 1, 1)
// 5/9. A hollow triangle's lies below it. 1e-6: roundings.
TEST(PathSurfaces, SmoothSurfacesOfTriangles) {
    const std::array<Vec3, 3> corners{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    const Vec3 way = render::to_smooth_surface(corners, corners, 1 / 3.0f, 1 / 3.0f);
    EXPECT_LT((way - Vec3::Constant(2 / 9.0f)).norm(), 1e-6f);
    EXPECT_LT(render::to_smooth_surface(corners, corners, 1, 0).norm(), 1e-6f);  // at a corner
    const std::array<Vec3, 3> inwards{-Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()};
    EXPECT_EQ(render::to_smooth_surface(corners, inwards, 1 / 3.0f, 1 / 3.0f).norm(), 0);
}

// A flat surface that reflects all shows an even sky, though the normals of its vertices are turned from the
// face by 80 degrees, or by 100. Nothing is bounced twice: no path that leaves the face meets it again.
// 0.005: as of Paths.WhiteFurnace.
TEST(PathSurfaces, NormalsMayTurnAwayFromTheFace) {
    for (const double turned : {80.0, 100.0}) {
        Mesh square = facing_square(1, matt(1));
        Array3f::Dense N(4, 3);
        const auto sine = float(std::sin(radians(turned))), cosine = float(std::cos(radians(turned)));
        for (int i = 0; i < 4; ++i) N.row(i) = Eigen::RowVector3f(sine, 0, cosine);
        square.set_N(Array3f(N));
        Scene scene;
        scene.show(square, "square");
        scene.set_environment(constant_environment(1));
        app::Session session = path_session(scene, 8);
        session.settings().environment.enabled = true;
        session.settings().path.bounces = 0;
        look_from(session, Vec3d(-1, 0, 4), 10);
        EXPECT_NEAR(mean_of(render_linear(session, 256)), 1, 0.02) << turned;
    }
}

/// Red, of the middle of a picture.
double mean_of_the_middle(const Image& image) {
    double sum = 0;
    const int from = image.width() * 3 / 8, to = image.width() * 5 / 8;
    for (int y = from; y < to; ++y)
        for (int x = from; x < to; ++x) sum += double(image.at<float>(x, y)[0]);
    return sum / ((to - from) * (to - from));
}

// Vertices drawn on top of faces neither shadow them nor hide the light from themselves, whatever their size.
TEST(PathSurfaces, VerticesOnFacesCastNothing) {
    Mesh ball = make_sphere(1, 12);
    Material m = matt(0.8f);
    m.specular = 0;
    ball.set_material(m);
    Scene scene;
    scene.show(ball, "ball");
    shine(scene, Vec3(0, 0, -1));
    app::Session session = path_session(scene, 64);
    look_from(session, Vec3d(0, 0, 5), 25);
    const double without = mean_of_the_middle(render_linear(session, 8));
    EXPECT_GT(without, 0.7);
    session.settings().style.show_points = true;
    for (const SizeUnit unit : {SizeUnit::pixels, SizeUnit::world}) {
        session.settings().style.point_size_unit = unit;
        session.settings().style.point_size = unit == SizeUnit::pixels ? 3.0f : 0.1f;
        // The normal of a disc is that of its vertex: over 1.5 of 28 pixels the cosine changes by less than
        // 0.02 there, to both sides.
        EXPECT_NEAR(mean_of_the_middle(render_linear(session, 8)), without, 0.01);
    }
}

// A pane from black to white lets through as much of a lamp's light as is between them, in linear light: the
// camera looks at x = 0.05 of -1 to 1, past the pane, where 0.52 of it is left, and 0.96 of that at its face.
// The floor sends the half back. Codes of sRGB in the middle would be 0.24 of the light.
TEST(PathSurfaces, PanesTintLampsBetweenVerticesByLight) {
    Material glass = matt(1);
    glass.transmission = 1;
    glass.roughness = 0;
    Mesh pane = facing_square(1, glass);
    ArrayXf::Dense C(4, 3);
    for (int i = 0; i < 4; ++i) C.row(i).setConstant((pane.V()(i, 0) + 1) / 2);
    pane.set_C(ArrayXf(C));
    pane.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
    Scene scene;
    scene.show(facing_square(1, matt(0.5f)), "floor");
    scene.show(pane, "pane");
    shine(scene, Vec3(0, 0, -1));
    app::Session session = path_session(scene, 16);
    session.settings().path.bounces = 0;
    session.settings().shading.dielectric_f0 = 0;
    look_from(session, Vec3d(0, -4, 1), 20);
    const double x = 4.12 * std::tan(10 * pi / 180) / 16;
    EXPECT_NEAR(render_linear(session, 16).at<float>(8, 8)[0], 0.5 * 0.96 * (1 + x) / 2, 0.005);
}

// A pane reflects more of a lamp's light the more slanted it is (Schlick 1994), by the strength of its
// reflection, and passes the rest. Light falls straight down through the middle of panes that are turned
// about x; the camera looks below them.
TEST(PathSurfaces, PanesReflectLampsByTheirAngle) {
    const auto floor_below = [](double angle_deg, float specular) {
        Material glass = matt(1);
        glass.transmission = 1;
        glass.roughness = 0;
        glass.specular = specular;
        Mesh pane = facing_square(4, glass);
        pane.set_T_world_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 4) *
                                              Eigen::AngleAxisd(-radians(angle_deg), Vec3d::UnitX())));
        Scene scene;
        Material floor = matt(0.5f);
        floor.specular = 0;
        scene.show(facing_square(1, floor), "floor");
        scene.show(pane, "pane");
        shine(scene, Vec3(0, 0, -1));
        app::Session session = path_session(scene, 16);
        session.settings().path.bounces = 0;
        look_from(session, Vec3d(0, -4, 1), 20);
        return double(render_linear(session, 4).at<float>(8, 8)[0]);
    };
    const double open = floor_below(0, 0);  // such a pane is not there
    EXPECT_NEAR(open, 0.5, 1e-3);
    struct Case {
        double angle_deg;
        float specular;
    };
    for (const Case& c : {Case{0, 1}, Case{60, 1}, Case{75, 1}, Case{75, 0.5f}, Case{60, 0}}) {
        SCOPED_TRACE(testing::Message() << c.angle_deg << " degrees, specular " << c.specular);
        const double reflected = c.specular * (0.04 + 0.96 * std::pow(1 - std::cos(radians(c.angle_deg)), 5));
        // Over the disc of the sun reflectances differ by 0.006 from its middle's, of which 16 samples have
        // the mean.
        EXPECT_NEAR(floor_below(c.angle_deg, c.specular) / open, 1 - reflected, 1e-3);
    }
}

// A large disc throws a round shadow: the light falls straight down, the camera looks at the floor from below
// the disc. Its polygon of 48 corners deviates by 0.2 % from the circle, an octagon would by 5 %.
TEST(PathSurfaces, LargeDiscsThrowRoundShadows) {
    Array3f::Dense V(1, 3), N(1, 3);
    V << 0, 0, 5;
    N << 0, 0, 1;
    Array3f::Dense T(1, 3);
    T << 1, 0, 0;
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.T = Array3f(T);
    Mesh disc(data);
    Style style;
    style.mode = DrawMode::surfels;
    disc.set_style(style);
    Scene scene;
    scene.show(facing_square(2, matt(0.5f)), "floor");
    scene.show(disc, "disc");
    Light sun;
    sun.type = LightType::directional;
    sun.direction = Vec3(0, 0, -1);
    sun.angular_radius_deg = 0;
    sun.intensity = float(pi);
    scene.set_light("sun", sun);
    constexpr int size = 300;
    app::Session session = path_session(scene, size);
    session.settings().path.bounces = 0;
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 3;
    look_from(session, Vec3d(0, 0, 3));
    const Image image = render_linear(session, 1);
    for (int i = 0; i < 64; ++i)
        for (const double radius : {0.98, 1.02}) {  // a pixel is 0.01
            const double angle = 2 * pi * i / 64;
            const auto pixel = [](double at) { return int(std::lround(size * (0.5 + at / 3) - 0.5)); };
            const float light =
                image.at<float>(pixel(radius * std::cos(angle)), pixel(radius * std::sin(angle)))[0];
            EXPECT_EQ(light > 0.25f, radius > 1) << i;
        }
}

/// A floor of discs of radius 0.05 at every 0.05, from -1 to 1, and one more of another radius beside it.
Mesh floor_of_discs(float other) {
    constexpr int side = 41;
    constexpr float radius = 0.05f;
    Array3f::Dense V(side * side + 1, 3), N(side * side + 1, 3), T(side * side + 1, 3);
    for (int i = 0; i < side * side; ++i)
        V.row(i) =
            Eigen::RowVector3f(radius * float(i % side - side / 2), radius * float(i / side - side / 2), 0);
    V.row(side * side) << -4, 0, 0;
    for (int i = 0; i <= side * side; ++i) {
        N.row(i) << 0, 0, 1;
        T.row(i) << (i < side * side ? radius : other), 0, 0;
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.T = Array3f(T);
    data.B = Array1f(Array1f::Dense(T.col(0)));
    data.style.mode = DrawMode::surfels;
    return Mesh(data);
}

// Rays that leave a disc start beyond its neighbours, however large others of its mesh are: the plate, 0.25
// above the floor, keeps its shadow, which the light along (2, 0, -1) throws 0.5 beside it, into the middle
// of the picture. The open floor beside the shadow gets 0.5 pi cos(light) / pi = 0.5 / sqrt(5). 0.01: colours
// of 16 bits, and what the dark plate reflects.
TEST(PathSurfaces, OneLargeDiscLeavesShadowsOfOthers) {
    Material dark = matt(0);
    dark.specular = 0;
    for (const float other : {0.05f, 0.4f, 2.0f}) {
        Mesh plate = facing_square(0.25f, dark);
        plate.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(-0.5, 0, 0.25)));
        Material m = matt(0.5f);
        m.specular = 0;
        Mesh floor = floor_of_discs(other);
        floor.set_material(m);
        Scene scene;
        scene.show(floor, "floor");
        scene.show(plate, "plate");
        shine(scene, Vec3(2, 0, -1).normalized());
        app::Session session = path_session(scene, 16);
        look_from(session, Vec3d(0, 0, 4), 10);
        const Image image = render_linear(session, 4);
        // Pixels are 0.044 wide: these are at 0.02 and 0.33.
        EXPECT_EQ(image.at<float>(8, 8)[0], 0) << other;
        EXPECT_NEAR(image.at<float>(15, 8)[0], 0.5 / std::sqrt(5.0), 0.01) << other;
    }
}

// Only what casts shadows says how exact they are: the sheet 0.05 above the floor keeps its shadow, which the
// light along (1, 0, -1) throws 0.05 beside it, by rays and in shadow maps, however far lines and vertices
// without faces are. Pixels are 0.022 wide; the one at 0.28 lies in the shadow that ends at 0.3, and no
// longer below the sheet, which ends at 0.25 and hides 0.253 from the camera.
TEST(PathSurfaces, WhatCastsNothingLeavesShadowsAlone) {
    Material dark = matt(0);
    dark.specular = 0;
    Mesh sheet = facing_square(0.25f, dark);
    sheet.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.05)));
    for (const bool paths : {true, false})
        for (const bool line : {true, false}) {
            Mesh floor = facing_square(2, matt(0.5f));
            if (!line) {
                Array3f::Dense V(5, 3);
                V << Array3f::Dense(floor.V()), 1e5f, 0, 0;
                floor.set_UV({});
                floor.set_V(Array3f(V));
            }
            Scene scene;
            scene.show(floor, "floor");
            scene.show(sheet, "sheet");
            if (line) scene.show(segment({0, 0, -1}, {1e5f, 0, -1}), "line");
            shine(scene, Vec3(1, 0, -1).normalized());
            app::Session session = path_session(scene, 32);
            session.settings().path.enabled = paths;
            look_from(session, Vec3d(0, 0, 4), 10);
            const Image image = render_linear(session, 4);
            EXPECT_LT(image.at<float>(28, 16)[0], 0.01) << paths << line;
            EXPECT_GT(image.at<float>(31, 16)[0], 0.3) << paths << line;
        }
}

// Of a large scene small parts hold too: its places are rounded to 1e-7 of its size. The floor is 10,000
// wide, and the sheet 0.1 above it keeps its shadow, as above.
TEST(PathSurfaces, SheetsNearALargeFloorKeepTheirShadows) {
    Material dark = matt(0);
    dark.specular = 0;
    Mesh sheet = facing_square(0.25f, dark);
    sheet.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.1)));
    Scene scene;
    scene.show(facing_square(5000, matt(0.5f)), "floor");
    scene.show(sheet, "sheet");
    shine(scene, Vec3(1, 0, -1).normalized());
    app::Session session = path_session(scene, 32);
    look_from(session, Vec3d(0, 0, 4), 10);
    const Image image = render_linear(session, 4);
    // At 0.306, where the shadow ends at 0.35, and at -0.3, which is open.
    EXPECT_LT(image.at<float>(29, 16)[0], 0.01);
    EXPECT_GT(image.at<float>(2, 16)[0], 0.3);
}

// A room of 2 units in a world of 40,000 lets no sky in, however it is lit. Seen from within, it has no
// light.
TEST(PathSurfaces, ASmallRoomInALargeSceneIsDark) {
    Mesh room = make_box(Vec3(2, 2, 2)), floor = facing_square(20'000, matt(0.5f));
    room.set_material(matt(0.8f));
    floor.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1.2)));
    Scene scene;
    scene.show(room, "room");
    scene.show(floor, "floor");
    scene.set_environment(constant_environment(1));
    for (const bool paths : {true, false}) {
        app::Session session = path_session(scene, 32);
        Settings& s = session.settings();
        s.environment.enabled = s.ssao.enabled = s.rays.enabled = true;
        s.path.enabled = paths;
        s.camera.near = 0.01;
        look_from(session, Vec3d(-0.6, 0.3, 0.2), 90);
        EXPECT_EQ(mean_of(render_linear(session, 16)), 0) << paths;
    }
}

}  // namespace
}  // namespace easypbr::path_surfaces_test
