// Annotations of what reaches beyond its vertices: points, surfels, voxels.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "dataset/placed_meshes.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::primitive_truth_test {
namespace {

const Vec2i size(320, 240);
constexpr double f = 300, cx = 159.5, cy = 119.5;

enum class Kind { points_in_pixels, points_in_world, surfels, voxels };
constexpr Kind every_kind[] = {Kind::points_in_pixels, Kind::points_in_world, Kind::surfels, Kind::voxels};

Mesh primitives(Kind kind, const std::vector<Vec3>& places, const Vec3d& at, float length) {
    MeshData data;
    Array3f::Dense V(Eigen::Index(places.size()), 3), N = V, T = V;
    Array1f::Dense B(Eigen::Index(places.size()));
    for (Eigen::Index i = 0; i < V.rows(); ++i) {
        V.row(i) = places[size_t(i)];
        N.row(i) << 0, 0, 1;
        T.row(i) << length, 0, 0;
        B(i) = length / 2;
    }
    data.V = Array3f(V);
    switch (kind) {
        case Kind::points_in_pixels:
            data.style.point_size = float(length * f / 2);
            break;
        case Kind::points_in_world:
            data.style.point_size = length;
            data.style.point_size_unit = SizeUnit::world;
            break;
        case Kind::surfels:
            data.N = Array3f(N);
            data.T = Array3f(T);
            data.B = Array1f(B);
            break;
        case Kind::voxels:
            data.voxel_size = length;
            break;
    }
    Mesh mesh(data);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(at)));
    return mesh;
}

/// Of a camera at the origin that looks along -z.
GroundTruth truth_of(const Scene& scene, const std::vector<std::string>& layers = {}) {
    app::Session session = plain_session(scene);
    const Mat3d K = (Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished();
    session.set_camera(opencv_camera(K, size));
    TruthOptions options;
    options.size = size;
    options.instances = true;
    return ground_truth(session, layers, options);
}

const Instance& named(const GroundTruth& truth, const std::string& name) {
    return *std::ranges::find(truth.instances, name, &Instance::name);
}

/// Of the whole picture, row by row.
std::vector<uint8_t> whole(const Bitmap& bitmap) {
    std::vector<uint8_t> pixels(size_t(size.prod()));
    for (int y = 0; y < bitmap.area.height; ++y)
        for (int x = 0; x < bitmap.area.width; ++x)
            pixels[size_t((bitmap.area.y + y) * size.x() + bitmap.area.x + x)] =
                bitmap.pixels[size_t(y * bitmap.area.width + x)];
    return pixels;
}

int count_of(const std::vector<uint8_t>& pixels) {
    return int(std::ranges::count(pixels, uint8_t(1)));
}

// The amodal mask of one that another hides a part of is what is visible of it in a scene of its own.
TEST(PrimitiveTruth, WhatIsHiddenCounts) {
    for (const Kind kind : every_kind) {
        const Mesh front = primitives(kind, {Vec3(0, 0, 0)}, {-0.15, 0, -2}, 0.5f);
        const Mesh back = primitives(kind, {Vec3(0, 0, 0)}, {0.2, 0.02, -3}, 0.5f);
        Scene both, alone;
        both.show(front, "front");
        both.show(back, "back");
        alone.show(back, "back");
        const GroundTruth truth = truth_of(both), of_one = truth_of(alone);
        const Instance& hidden = named(truth, "back");
        const std::vector<uint8_t> expected = whole(of_one.instances.at(0).visible);
        EXPECT_EQ(whole(hidden.amodal), expected) << int(kind);
        EXPECT_EQ(hidden.pixels_amodal, count_of(expected)) << int(kind);
        EXPECT_GT(hidden.pixels_visible, 100) << int(kind);
        EXPECT_EQ(hidden.visible_fraction, double(hidden.pixels_visible) / count_of(expected)) << int(kind);
        EXPECT_LT(hidden.visible_fraction, 0.95) << int(kind);
        EXPECT_EQ(named(truth, "front").visible_fraction, 1) << int(kind);
        EXPECT_EQ(of_one.instances.at(0).visible_fraction, 1) << int(kind);
    }
}

// At the picture's right edge nothing that is seen lies outside of the amodal mask, and the part outside
// counts.
TEST(PrimitiveTruth, WhatTheEdgeCutsOff) {
    for (const Kind kind : every_kind) {
        Scene scene;
        scene.show(primitives(kind, {Vec3(-0.3f, 0, 0), Vec3(0.3f, 0, 0)}, {1, 0, -2}, 0.6f), "cut");
        const Instance cut = truth_of(scene).instances.at(0);
        const std::vector<uint8_t> visible = whole(cut.visible), amodal = whole(cut.amodal);
        EXPECT_GT(cut.pixels_visible, 1000) << int(kind);
        EXPECT_EQ(visible, amodal) << int(kind);
        EXPECT_EQ(cut.pixels_amodal_inside, cut.pixels_visible) << int(kind);
        EXPECT_GT(cut.truncation, 0.2) << int(kind);
        EXPECT_LT(cut.visible_fraction, 0.8) << int(kind);
        EXPECT_GT(cut.box_amodal.x + cut.box_amodal.width, size.x()) << int(kind);
    }
}

// Two cubes are a box of 1.2 x 0.6 x 0.6: the rays through the pixels of three times the picture either meet
// it or do not, by the method of slabs. A ray within 1/256 pixel of an edge may be off: 2 % of those at an
// outline of 1,100 pixels.
TEST(PrimitiveTruth, PixelsOfVoxelsAreThoseOfTheirBox) {
    Scene scene;
    scene.show(primitives(Kind::voxels, {Vec3(-0.3f, 0, 0), Vec3(0.3f, 0, 0)}, {1, 0, -2}, 0.6f), "voxels");
    const GroundTruth truth = truth_of(scene);
    const Instance& voxels = truth.instances.at(0);
    EXPECT_NEAR((voxels.box.sizes() - Vec3d(1.2, 0.6, 0.6)).norm(), 0, 1e-6);
    EXPECT_NEAR(voxels.box.center().norm(), 0, 1e-6);
    const Vec3d low(0.4, -0.3, 1.7), high(1.6, 0.3, 2.3);  // OpenCV's axes
    int inside = 0, all = 0;
    for (int y = -size.y(); y < 2 * size.y(); ++y)
        for (int x = -size.x(); x < 2 * size.x(); ++x) {
            const Vec3d ray((x - cx) / f, (y - cy) / f, 1);
            double first = 0, last = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                const double a = low[axis] / ray[axis], b = high[axis] / ray[axis];
                first = std::max(first, std::min(a, b));
                last = std::min(last, std::max(a, b));
            }
            if (first > last) continue;
            ++all;
            inside += x >= 0 && y >= 0 && x < size.x() && y < size.y();
        }
    EXPECT_NEAR(voxels.pixels_amodal, all, 20);
    EXPECT_NEAR(voxels.pixels_amodal_inside, inside, 20);
    EXPECT_NEAR(voxels.truncation, 1 - double(inside) / all, 1e-3);
}

// Two cubes along each axis: the box is that of the cubes, under a pose of a child that turns them too.
TEST(PrimitiveTruth, BoxesHoldVoxels) {
    std::vector<Vec3> centres;
    for (int i = 0; i < 8; ++i)
        centres.emplace_back(0.5f * float(i & 1) - 0.25f, 0.5f * float(i >> 1 & 1) - 0.25f,
                             0.5f * float(i >> 2) - 0.25f);
    Scene scene;
    scene.show(primitives(Kind::voxels, centres, {0, 0, -3}, 0.5f), "grid");
    const GroundTruth truth = truth_of(scene, {"object_coordinates", "position", "depth"});
    const Instance& grid = truth.instances.at(0);
    EXPECT_NEAR((grid.box.sizes() - Vec3d(1, 1, 1)).norm(), 0, 1e-6);
    int seen = 0;
    for (size_t i = 0; i < size_t(size.prod()); ++i) {
        if (truth.layers.at("depth").floats()[i] == 0) continue;
        ++seen;
        const float* nocs = &truth.layers.at("object_coordinates").floats()[3 * i];
        const float* p = &truth.layers.at("position").floats()[3 * i];
        const Vec3 own(p[0], p[1], p[2] + 3);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(nocs[axis], 0);
            ASSERT_LE(nocs[axis], 1);
            // Where a point lies outside of the box, that is by rounding.
            ASSERT_NEAR(nocs[axis], 0.5 + own[axis] / std::sqrt(3.0), 1e-4);
        }
    }
    EXPECT_GT(seen, 10000);

    Mesh parent = make_box(Vec3(0.1f, 0.1f, 0.1f));
    parent.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -3)));
    Mesh child = primitives(Kind::voxels, {Vec3(0, 0, 0)}, {0, 0, 0}, 1);
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::AngleAxisd(radians(45), Vec3d::UnitZ())));
    parent.add_child(child);
    Scene nested;
    nested.show(parent, "parent");
    const Vec3d sizes = truth_of(nested).instances.at(0).box.sizes();
    EXPECT_NEAR((sizes - Vec3d(std::sqrt(2.0), std::sqrt(2.0), 1)).norm(), 0, 1e-6);
}

// The box of points and surfels is that of their positions; coordinates of what reaches beyond it stay in it.
TEST(PrimitiveTruth, CoordinatesStayInTheBoxOfThePositions) {
    for (const Kind kind : {Kind::points_in_pixels, Kind::points_in_world, Kind::surfels}) {
        Scene scene;
        scene.show(primitives(kind, {Vec3(-0.2f, 0, 0), Vec3(0.2f, 0, 0)}, {0, 0, -2}, 0.3f), "two");
        const GroundTruth truth = truth_of(scene, {"object_coordinates", "depth"});
        EXPECT_NEAR((truth.instances.at(0).box.sizes() - Vec3d(0.4, 0, 0)).norm(), 0, 1e-6);
        int seen = 0;
        for (size_t i = 0; i < size_t(size.prod()); ++i) {
            if (truth.layers.at("depth").floats()[i] == 0) continue;
            ++seen;
            const float* nocs = &truth.layers.at("object_coordinates").floats()[3 * i];
            const double x = (double(i % 320) - cx) / f * 2;
            // The points lie in a plane that faces the camera; the diagonal is 0.4.
            ASSERT_NEAR(nocs[0], std::clamp(0.5 + x / 0.4, 0.0, 1.0), 1e-4);
            ASSERT_NEAR(nocs[1], 0.5, 1e-6);
            ASSERT_NEAR(nocs[2], 0.5, 1e-6);
        }
        EXPECT_GT(seen, 2000) << int(kind);
    }
}

Mesh surfel(const Vec3& place, float radius, const Vec3& normal, const Vec3& color) {
    MeshData mesh;
    mesh.V = Array3f::Dense(place.transpose());
    mesh.N = Array3f::Dense(normal.transpose());
    mesh.T = Array3f::Dense(radius * normal.unitOrthogonal().transpose());
    mesh.B = Array1f::Dense::Constant(1, radius);
    Material material;
    material.base_color = color;
    mesh.materials = {material};
    return Mesh(mesh);
}

const Vec3 red_place(0, 0, -5), blue_place(0.7f, 0, -5.4f);
const Vec3 red_normal = Vec3(0.5f, 0.2f, 1).normalized(), blue_normal(0, 0, 1);

/// The depth at which a ray from the camera's centre meets a surfel's plane; OpenGL's axes.
double plane_depth(const Vec3& place, const Vec3& normal, const Vec2d& slopes) {
    const Vec3d n = normal.cast<double>();
    return n.dot(place.cast<double>()) / n.dot(Vec3d(slopes.x(), -slopes.y(), -1));
}

// Bands of a surfel's size behind the nearest are one surface in pictures: here the blue surfel is in the
// band of the red one, and smaller. Depths are floats, 6e-8, of places and normals that are. Normals are held
// in 2 x 16 bits, albedos in 16.
TEST(PrimitiveTruth, EveryLayerIsOfTheNearestSurfelAlone) {
    Scene scene;
    scene.show(surfel(red_place, 0.8f, red_normal, Vec3(1, 0, 0)), "red");
    scene.show(surfel(blue_place, 0.6f, blue_normal, Vec3(0, 0, 1)), "blue");
    for (const bool native : {true, false})
        for (const bool through_lens : {false, true}) {
            app::Session session = plain_session(scene);
            session.allow_native_geometry(native);
            Camera camera = opencv_camera((Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished(), size);
            if (through_lens)
                camera.distortion =
                    Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.2, 0, 0, 0});
            session.set_camera(camera);
            TruthOptions options;
            options.size = size;
            options.instances = true;
            const GroundTruth truth = ground_truth(
                session, {"depth", "position", "albedo", "normal_world", "instance_id"}, options);
            const int red_id = std::ranges::find(truth.instances, "red", &Instance::name)->id;
            const auto ids = truth.layers.at("instance_id").integers();
            int reds = 0, blues = 0;
            for (size_t i = 0; i < ids.size(); ++i) {
                if (ids[i] == 0) continue;
                const bool is_red = ids[i] == red_id;
                (is_red ? reds : blues) += 1;
                const Vec3 place = is_red ? red_place : blue_place,
                           normal = is_red ? red_normal : blue_normal;
                const float *p = &truth.layers.at("position").floats()[3 * i],
                            *albedo = &truth.layers.at("albedo").floats()[3 * i],
                            *n = &truth.layers.at("normal_world").floats()[3 * i];
                const Vec2d slopes(p[0] / -p[2], p[1] / p[2]);
                const double depth = double(truth.layers.at("depth").floats()[i]);
                ASSERT_NEAR(depth, plane_depth(place, normal, slopes), 3e-6) << native << i;
                ASSERT_EQ(Vec3(albedo[0], albedo[1], albedo[2]), is_red ? Vec3(1, 0, 0) : Vec3(0, 0, 1)) << i;
                ASSERT_NEAR((Vec3(n[0], n[1], n[2]) - normal).norm(), 0, 1e-4) << i;
                // No pixel of the other's that is nearer.
                if (is_red || through_lens) continue;
                const Vec3d at_red =
                    plane_depth(red_place, red_normal, slopes) * Vec3d(slopes.x(), -slopes.y(), -1);
                ASSERT_TRUE(depth < -at_red.z() || (at_red - red_place.cast<double>()).norm() > 0.8 - 0.02)
                    << i;
            }
            EXPECT_GT(reds, 1000);
            EXPECT_GT(blues, 200);
        }
}

// What one frame shows is the same whether its ground truth is asked for or not: there surfels are blended.
TEST(PrimitiveTruth, LeavesThePictureOfSurfelsAsItIs) {
    Scene scene;
    scene.show(surfel(red_place, 0.8f, red_normal, Vec3(1, 0, 0)), "red");
    scene.show(surfel(blue_place, 0.6f, blue_normal, Vec3(0, 0, 1)), "blue");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera((Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished(), size));
    TruthOptions options;
    options.size = size;
    const GroundTruth truth = ground_truth(session, {"hdr", "depth"}, options);
    const Image picture = session.render({size, 1, app::Encoding::scene_linear});
    const std::span<const float> expected = picture.pixels<float>();
    EXPECT_TRUE(std::ranges::equal(truth.layers.at("hdr").floats(), expected));
}

// Surfels without normals and splats without Gaussians are drawn as points: so are their ground truth and
// picks.
TEST(PrimitiveTruth, IsOfWhatIsDrawnInPlaceOfAMode) {
    for (const bool with_faces : {false, true}) {
        const auto shown_as = [&](DrawMode mode) {
            Mesh mesh = primitives(Kind::points_in_pixels, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
                                   {-0.3, -0.3, -3}, 0.2f);
            mesh.edit([&](MeshData& d) {
                d.style.mode = mode;
                if (with_faces) d.F = Array3i::Dense{{0, 1, 2}};
            });
            Scene scene;
            scene.show(mesh, "points");
            return scene;
        };
        const std::vector<std::string> layers = {"depth", "instance_id"};
        const GroundTruth expected = truth_of(shown_as(DrawMode::points), layers);
        ASSERT_GT(expected.instances.at(0).pixels_visible, 1000);
        for (const DrawMode mode : {DrawMode::surfels, DrawMode::splats}) {
            const Scene scene = shown_as(mode);
            const GroundTruth truth = truth_of(scene, layers);
            EXPECT_EQ(truth.layers.at("depth").floats(), expected.layers.at("depth").floats()) << int(mode);
            EXPECT_EQ(truth.layers.at("instance_id").integers(), expected.layers.at("instance_id").integers())
                << int(mode);
            app::Session session = plain_session(scene);
            session.set_camera(opencv_camera((Mat3d() << f, 0, cx, 0, f, cy, 0, 0, 1).finished(), size));
            // The first point is at (-0.3, 0.3) of OpenCV's axes, 3 away.
            const std::optional<app::Pick> pick =
                session.pick({cx - 0.3 * f / 3, cy + 0.3 * f / 3}, Vec2i(size));
            ASSERT_TRUE(pick) << int(mode);
            EXPECT_EQ(pick->element, 0) << int(mode);
            EXPECT_FALSE(pick->is_face) << int(mode);
        }
    }
}

constexpr int ball_width = 200, ball_height = 150;

/// Surfels strewn about a unit sphere, a hundredth off it, each of which overlaps several others; their
/// normals are the sphere's. Three units before an OpenCV camera at the origin.
Scene rough_ball() {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    constexpr int count = 4000;
    Array3f::Dense V(count, 3), N(count, 3), C(count, 3);
    for (int i = 0; i < count; ++i) {
        N.row(i) = Vec3(normal(random), normal(random), normal(random)).normalized();
        V.row(i) = (1 + 0.01f * normal(random)) * N.row(i) + Eigen::RowVector3f(0, 0, 3);
        C.row(i) = (N.row(i).array() + 1) / 2;
    }
    MeshData data;
    data.V = Array3f(V);
    data.N = Array3f(N);
    data.C = Array3f(C);
    data.style.mode = DrawMode::surfels;
    Scene scene;
    scene.show(Mesh(data), "ball");
    return scene;
}

app::Session session_of(bool native, double k1) {
    app::Session session = plain_session(rough_ball());
    session.allow_native_geometry(native);
    session.settings().image.size = Vec2i(ball_width, ball_height);
    Mat3d K;
    K << 200, 0, 99.5, 0, 200, 74.5, 0, 0, 1;
    Camera camera = Camera::from_opencv(K, Mat4d::Identity(), ball_width, ball_height);
    if (k1 != 0)
        camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {k1, 0, 0, 0});
    session.set_camera(camera);
    return session;
}

/// How many pixels of two depths differ by more than float32 explains: the place in a disc is found in pixels
/// of a picture of 200, which rounds it to 1e-5 of the disc, more where that is slanted.
int count_different(std::span<const float> a, std::span<const float> b) {
    int different = 0;
    for (size_t i = 0; i < a.size(); ++i) different += !(std::abs(a[i] - b[i]) <= 1e-4f * a[i]);
    return different;
}

/// On rims of discs rounding decides which disc a pixel sees: a few of the ball's 16000 pixels.
constexpr int most_on_rims = 20;

TEST(SurfelTruth, IsWhatLayersHold) {
    for (const bool native : {true, false})
        for (const double k1 : {0.0, -0.05}) {
            app::Session session = session_of(native, k1);
            const auto layers =
                session.render_layers({"albedo", "normal_world", "depth", "roughness", "element_id"});
            const GroundTruth truth =
                ground_truth(session, {"albedo", "normal_world", "depth", "roughness", "face_id"}, {});
            const auto of = [&](const char* name) -> const std::vector<float>& {
                return truth.layers.at(name).floats();
            };
            EXPECT_LE(count_different(of("depth"), layers.at("depth").pixels<float>()), most_on_rims)
                << native << k1;
            const std::span<const float> true_albedo = of("albedo"), true_normal = of("normal_world"),
                                         true_roughness = of("roughness");
            const std::span<const float> albedo = layers.at("albedo").pixels<float>(),
                                         normal = layers.at("normal_world").pixels<float>(),
                                         element = layers.at("element_id").pixels<float>(),
                                         roughness = layers.at("roughness").pixels<float>();
            const auto faces = truth.layers.at("face_id").integers();
            int seen = 0;
            for (size_t i = 0; i < faces.size(); ++i) {
                // Both read the same targets.
                ASSERT_EQ(element[i], float(faces[i] + 1)) << i;
                ASSERT_EQ(roughness[i], true_roughness[i]) << i;
                for (size_t c = 0; c < 3; ++c) {
                    ASSERT_EQ(albedo[4 * i + c], true_albedo[3 * i + c]) << i;
                    ASSERT_EQ(normal[3 * i + c], true_normal[3 * i + c]) << i;
                }
                seen += faces[i] >= 0;
            }
            EXPECT_GT(seen, 15000);
        }
}

// A lens that moves no pixel by more than 1e-7 of one changes nothing.
TEST(SurfelTruth, DepthDoesNotJumpWithALens) {
    for (const bool native : {true, false}) {
        app::Session plain = session_of(native, 0), bent = session_of(native, 1e-9);
        const Image without = plain.render_layers({"depth"}).at("depth"),
                    with = bent.render_layers({"depth"}).at("depth");
        EXPECT_LE(count_different(without.pixels<float>(), with.pixels<float>()), most_on_rims) << native;
    }
}

}  // namespace
}  // namespace easypbr::dataset::primitive_truth_test
