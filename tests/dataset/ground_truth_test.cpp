#include "easypbr/dataset/ground_truth.h"

#include <gtest/gtest.h>

#include <random>

#include "dataset/placed_meshes.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::ground_truth_test {
namespace {

const Instance& named(const GroundTruth& truth, const std::string& name) {
    return *std::ranges::find(truth.instances, name, &Instance::name);
}

TruthOptions with_instances(Vec2i size) {
    TruthOptions options;
    options.size = size;
    options.instances = true;
    return options;
}

// A sphere's outline is an ellipse. Its mask has the ellipse's area within half its perimeter in pixels,
// which is the most that pixels cut by the outline can be off; the polyhedron (64 x 128) is inside by 1e-3 of
// its radius.
TEST(GroundTruth, SphereIsAnEllipse) {
    const Vec2i size(160, 120);
    Scene scene;
    const Vec3d centre(0.35, -0.2, -3);
    const double radius = 0.8;
    scene.show(moved(make_sphere(float(radius), 128), centre), "ball");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera(off_centre_K(), size));
    const GroundTruth truth = ground_truth(session, {"instance_id", "depth"}, with_instances(size));
    // Inside: the ray's angle to the centre is less than asin(r / d).
    const Vec3d axis = Vec3d(centre.x(), -centre.y(), -centre.z()).normalized();
    const double cosine = std::sqrt(1 - std::pow(radius / centre.norm(), 2));
    double area = 0;
    int edge = 0;
    constexpr int sub = 8;
    const Mat3d inverse = off_centre_K().inverse();
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            int hits = 0;
            for (int k = 0; k < sub * sub; ++k) {
                const Vec3d ray =
                    inverse * Vec3d(x - 0.5 + (k % sub + 0.5) / sub, y - 0.5 + (k / sub + 0.5) / sub, 1);
                hits += ray.normalized().dot(axis) > cosine;
            }
            area += double(hits) / (sub * sub);
            edge += hits != 0 && hits != sub * sub;
        }
    const Instance& ball = named(truth, "ball");
    EXPECT_NEAR(ball.pixels_visible, area, 0.5 * edge);
    EXPECT_EQ(ball.visible_fraction, 1);
    EXPECT_EQ(ball.truncation, 0);
    // The nearest point of the sphere along the axis of the picture's ray; the polyhedron's faces lie 3e-4 r
    // inside.
    const auto& depth = truth.layers.at("depth").floats();
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            const size_t i = size_t(y) * size_t(size.x()) + size_t(x);
            if (depth[i] == 0) continue;
            const Vec3d p = inverse * Vec3d(x, y, 1) * double(depth[i]);
            EXPECT_NEAR((p - Vec3d(centre.x(), -centre.y(), -centre.z())).norm(), radius, 1.5e-3 * radius);
        }
}

// A quad whose right half another one hides: half of it is seen. Edges lie between pixel centres, so nothing
// is rounded; 0.005 is what the issue asks for.
TEST(GroundTruth, HalfCoveredQuadIsHalfVisible) {
    Scene scene;
    scene.show(facing_square(1), "back");
    scene.show(moved(facing_square(1), {1, 0, 0.5}), "front");
    app::Session session = plain_session(scene, 200);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 5.0;
    look_from(session, Vec3d(0, 0, 5));
    const GroundTruth truth = ground_truth(session, {"instance_id"}, with_instances({200, 200}));
    EXPECT_NEAR(named(truth, "back").visible_fraction, 0.5, 0.005);
    EXPECT_EQ(named(truth, "front").visible_fraction, 1);
    // 40 pixels to a unit.
    EXPECT_EQ(named(truth, "back").pixels_amodal, 80 * 80);
    EXPECT_EQ(named(truth, "back").box_amodal.width, 80);
    EXPECT_EQ(named(truth, "back").box_visible.width, 40);
    EXPECT_EQ(named(truth, "back").box_visible.x, 60);
}

// A quad whose left half is outside of the picture: truncation one half, and the box reaches out.
// A pane of 80 x 80 pixels that hides nothing: it is seen nowhere, and covers all that its texture leaves.
TEST(GroundTruth, BlendedSurfacesAreWholeAmodally) {
    auto image = std::make_shared<Image>(2, 1, 4, PixelType::u8);
    const uint8_t codes[] = {255, 255, 255, 0, 255, 255, 255, 255};
    std::ranges::copy(codes, image->pixels<uint8_t>().begin());
    for (const bool textured : {false, true})
        for (const bool alone : {false, true}) {
            Material material;
            material.opacity = 0.25f;
            if (textured) {
                material.base_color_texture.image = image;
                material.base_color_texture.wrap_u = Wrap::clamp;
                material.base_color_texture.filter = Filter::nearest;
            }
            Scene scene;
            scene.show(moved(facing_square(1, material), {0, 0, 0.5}), "pane");
            if (!alone) scene.show(facing_square(1), "back");
            app::Session session = plain_session(scene, 200);
            session.settings().camera.projection = Projection::orthographic;
            session.settings().camera.ortho_height = 5.0;
            look_from(session, Vec3d(0, 0, 5));
            const GroundTruth truth = ground_truth(session, {"instance_id"}, with_instances({200, 200}));
            const Instance& pane = named(truth, "pane");
            EXPECT_EQ(pane.pixels_visible, 0);
            EXPECT_EQ(pane.visible_fraction, 0);
            EXPECT_EQ(pane.pixels_amodal, (textured ? 40 : 80) * 80) << "alone: " << alone;
            EXPECT_EQ(pane.box_amodal.width, textured ? 40 : 80) << "alone: " << alone;
            EXPECT_EQ(pane.box_amodal.x, textured ? 100 : 60) << "alone: " << alone;
            if (!alone) {
                EXPECT_EQ(named(truth, "back").pixels_visible, 80 * 80);
            }
        }
}

TEST(GroundTruth, TruncationAndTheBoxOutside) {
    Scene scene;
    scene.show(moved(facing_square(1), {-2.5, 0, 0}), "left");
    app::Session session = plain_session(scene, 200);
    session.settings().camera.projection = Projection::orthographic;
    session.settings().camera.ortho_height = 5.0;
    look_from(session, Vec3d(0, 0, 5));
    const Instance left = ground_truth(session, {}, with_instances({200, 200})).instances.at(0);
    EXPECT_EQ(left.truncation, 0.5);
    EXPECT_EQ(left.visible_fraction, 0.5);
    EXPECT_EQ(left.box_amodal.x, -40);
    EXPECT_EQ(left.box_amodal.width, 80);
    EXPECT_EQ(left.box_visible.x, 0);
    EXPECT_EQ(left.box_visible.width, 40);
    EXPECT_EQ(left.pixels_amodal, 6400);
    EXPECT_EQ(left.pixels_amodal_inside, 3200);
}

// Beside the picture by more than the canvas is large, on each side: an object that is alone covers nothing.
TEST(GroundTruth, FarOutsideOfThePictureIsAnEmptyBox) {
    for (const Vec3d& by : {Vec3d(0, 30, 0), Vec3d(0, -30, 0), Vec3d(30, 0, 0), Vec3d(-30, 30, 0)}) {
        Scene scene;
        scene.show(facing_square(1), "middle");
        scene.show(moved(facing_square(1), by), "outside");
        app::Session session = plain_session(scene, 100);
        look_from(session, Vec3d(0, 0, 5));
        const GroundTruth truth = ground_truth(session, {}, with_instances({100, 100}));
        const Instance& outside = named(truth, "outside");
        EXPECT_EQ(outside.pixels_amodal, 0);
        EXPECT_EQ(outside.box_amodal.width, 0);
        EXPECT_EQ(outside.box_amodal.height, 0);
        EXPECT_EQ(outside.visible_fraction, 0);
        EXPECT_EQ(named(truth, "middle").visible_fraction, 1);
    }
}

/// Meshes above and below the size from which triangles are rasterised natively, a cloud, surfels and voxels.
Scene every_kind() {
    Scene scene;
    scene.show(moved(make_sphere(0.5f, 64), {-1, 0.6, -4}), "ball");
    scene.show(moved(make_box(Vec3(0.8f, 0.8f, 0.8f)), {0.9, 0.5, -4.2}), "cube");
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
    for (const char* name : {"points", "surfels", "voxels"}) {
        Array3f::Dense V(300, 3);
        for (int i = 0; i < 300; ++i) V.row(i) << unit(random), unit(random), unit(random);
        MeshData data;
        Array3f::Dense N = V.rowwise().normalized();
        data.V = Array3f(V);
        if (std::string(name) != "points") data.N = Array3f(N);
        data.style.mode = std::string(name) == "points"    ? DrawMode::points
                          : std::string(name) == "surfels" ? DrawMode::surfels
                                                           : DrawMode::voxels;
        const double x = std::string(name) == "points" ? -1 : std::string(name) == "surfels" ? 0 : 1;
        scene.show(moved(Mesh(data), {x, -0.6, -4}), name);
    }
    return scene;
}

// Visible masks are disjoint and cover the foreground, whatever is drawn; what is derived agrees with itself.
TEST(GroundTruth, MasksPartitionTheForegroundOfEveryKind) {
    const Vec2i size(160, 120);
    app::Session session = plain_session(every_kind());
    session.set_camera(opencv_camera(off_centre_K(), size));
    const GroundTruth truth = ground_truth(
        session,
        {"instance_id", "depth", "distance", "position", "face_id", "object_coordinates", "normal_camera"},
        with_instances(size));
    ASSERT_EQ(truth.instances.size(), 5u);
    const auto& depth = truth.layers.at("depth").floats();
    std::vector<int> owners(depth.size());
    for (const Instance& instance : truth.instances) {
        EXPECT_GT(instance.pixels_visible, 50) << instance.name;
        EXPECT_GE(instance.pixels_amodal, instance.pixels_visible) << instance.name;
        const PixelBox& box = instance.visible.area;
        for (int i = 0; i < box.width * box.height; ++i)
            if (instance.visible.pixels[size_t(i)]) {
                const size_t at = size_t((box.y + i / box.width) * size.x() + box.x + i % box.width);
                ++owners[at];
                EXPECT_EQ(truth.layers.at("instance_id").integers()[at], instance.id);
            }
    }
    const Mat3d K = off_centre_K();
    for (size_t i = 0; i < depth.size(); ++i) {
        ASSERT_EQ(owners[i], depth[i] > 0);
        ASSERT_EQ(truth.layers.at("face_id").integers()[i] >= 0, depth[i] > 0);
        if (depth[i] == 0) continue;
        const float* p = &truth.layers.at("position").floats()[3 * i];
        // The camera stands at the origin and looks along -z. 1e-3 px: float32 positions at 4 m.
        const Vec3d cv(p[0], -p[1], -p[2]);
        EXPECT_NEAR(cv.z(), depth[i], 1e-5);
        EXPECT_NEAR(cv.norm(), truth.layers.at("distance").floats()[i], 1e-5);
        const Vec3d pixel = K * cv / cv.z();
        EXPECT_NEAR(pixel.x(), double(i % 160), 1e-3);
        EXPECT_NEAR(pixel.y(), double(i / 160), 1e-3);
    }
}

// Same scene, same bytes.
TEST(GroundTruth, IsDeterministic) {
    const Vec2i size(160, 120);
    const auto draw = [&] {
        app::Session session = plain_session(every_kind());
        session.set_camera(opencv_camera(off_centre_K(), size));
        return ground_truth(session, {"instance_id", "depth", "albedo", "normal_world"},
                            with_instances(size));
    };
    const GroundTruth a = draw(), b = draw();
    for (const auto& [name, layer] : a.layers) EXPECT_EQ(layer.values, b.layers.at(name).values) << name;
}

// Barycentrics, uv and face: the square's uv are (x + 1) / 2, (y + 1) / 2 of the point that is seen.
TEST(GroundTruth, FacesWeightsAndUv) {
    Scene scene;
    scene.show(facing_square(1), "square");
    app::Session session = plain_session(scene, 50);
    look_from(session, Vec3d(0.5, 0.3, 4), 35);
    TruthOptions options;
    options.size = Vec2i(50, 50);
    const GroundTruth truth =
        ground_truth(session, {"uv", "barycentrics", "face_id", "position", "object_coordinates"}, options);
    const MeshData& mesh = *scene.get("square").snapshot();
    int seen = 0;
    for (size_t i = 0; i < 2500; ++i) {
        const int face = truth.layers.at("face_id").integers()[i];
        if (face < 0) continue;
        ++seen;
        const float* p = &truth.layers.at("position").floats()[3 * i];
        const float* uv = &truth.layers.at("uv").floats()[2 * i];
        const float* w = &truth.layers.at("barycentrics").floats()[3 * i];
        // 1e-5: float32 of numbers around 4. A pixel on the border may be up to 1/512 pixel outside.
        EXPECT_NEAR(uv[0], (p[0] + 1) / 2, 3e-4);
        EXPECT_NEAR(uv[1], (p[1] + 1) / 2, 3e-4);
        EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-6);
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 3; ++k) sum += w[k] * Vec3(mesh.V.row(mesh.F(face, k)));
        EXPECT_NEAR((sum - Vec3(p[0], p[1], p[2])).norm(), 0, 6e-4);
        // Box of size 2 x 2 x 0, diagonal sqrt(8).
        EXPECT_NEAR(truth.layers.at("object_coordinates").floats()[3 * i], p[0] / std::sqrt(8.0) + 0.5, 1e-5);
    }
    EXPECT_GT(seen, 800);
}

// A sphere that its pose flattens to a disc of radius 1: the axis that is left out has no extent.
TEST(GroundTruth, OfWhatItsPoseFlattens) {
    Mesh disc = make_sphere(1, 64);
    disc.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, 0.0)));
    Scene scene;
    scene.show(disc, "disc");
    app::Session session = plain_session(scene, 50);
    look_from(session, Vec3d(0, 0, 4), 35);
    TruthOptions options = with_instances({50, 50});
    const GroundTruth truth =
        ground_truth(session, {"position", "object_coordinates", "instance_id"}, options);
    const Instance& found = named(truth, "disc");
    EXPECT_LT((found.box.sizes() - Vec3d(2, 2, 0)).norm(), 1e-2);
    EXPECT_LT(found.corners_world.col(2).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(found.corners_px.row(0).x(), found.corners_px.row(7).x());
    const double diagonal = found.box.diagonal().norm();
    for (size_t i = 0; i < 2500; ++i) {
        if (!truth.layers.at("instance_id").integers()[i]) continue;
        const float *p = &truth.layers.at("position").floats()[3 * i],
                    *coordinates = &truth.layers.at("object_coordinates").floats()[3 * i];
        EXPECT_NEAR(coordinates[0], 0.5 + p[0] / diagonal, 1e-5);
        EXPECT_NEAR(coordinates[2], 0.5, 1e-5);
    }
}

// Through a lens with distortion and skew every pixel's point is on the ray that the lens's formula gives.
TEST(GroundTruth, DistortionAppliesToEveryLayer) {
    const Vec2i size(160, 120);
    Mat3d K = off_centre_K();
    K(0, 1) = 3;
    for (const DistortionModel model : {DistortionModel::brown_conrady, DistortionModel::fisheye}) {
        app::Session session = plain_session(every_kind());
        Camera camera = opencv_camera(K, size);
        camera.distortion = Distortion::from_coefficients(
            model, model == DistortionModel::fisheye ? std::vector<double>{0.05, -0.01, 0.002, 0}
                                                     : std::vector<double>{-0.25, 0.08, 0.001, -0.002});
        session.set_camera(camera);
        const GroundTruth truth =
            ground_truth(session, {"color", "position", "depth", "instance_id"}, with_instances(size));
        EXPECT_EQ(truth.layers.at("color").width, 160);
        int seen = 0;
        for (size_t i = 0; i < size_t(size.prod()); ++i) {
            if (truth.layers.at("depth").floats()[i] == 0) continue;
            ++seen;
            const float* p = &truth.layers.at("position").floats()[3 * i];
            const Vec2d slopes = camera.distortion->distort(Vec2d(p[0] / -p[2], p[1] / p[2]));
            const Vec3d pixel = K * slopes.homogeneous();
            EXPECT_NEAR(pixel.x(), double(i % 160), 0.01);
            EXPECT_NEAR(pixel.y(), double(i / 160), 0.01);
        }
        EXPECT_GT(seen, 2000);
        int visible = 0;
        for (const Instance& instance : truth.instances) visible += instance.pixels_visible;
        EXPECT_EQ(visible, seen);
    }
}

// The polynomial r - r^3 / 4 grows up to r = sqrt(4 / 3) = 1.155. What lies further out has no place, though
// the formula gives one inside of the picture: corners at slopes of 0.81 sqrt(2) = 1.146 have one, at 0.82
// sqrt(2) = 1.160 not.
TEST(GroundTruth, BeyondTheFoldOfALensIsNoPlace) {
    const Vec2i size(160, 120);
    Camera camera = opencv_camera(off_centre_K(), size);
    camera.distortion = Distortion::from_coefficients(DistortionModel::brown_conrady, {-0.25, 0, 0, 0});
    for (const bool within : {true, false}) {
        Scene scene;
        scene.show(moved(facing_square(within ? 0.81f : 0.82f), {0, 0, -1}), "square");
        app::Session session = plain_session(scene);
        session.set_camera(camera);
        const Instance square = ground_truth(session, {}, with_instances(size)).instances.at(0);
        EXPECT_EQ(square.corners_px.array().isFinite().all(), within);
        EXPECT_EQ(square.corners_px.array().isNaN().all(), !within);
    }
    Scene scene;
    Mesh box = moved(make_box(Vec3(0.4f, 0.4f, 0.4f)), {2.6, 0, -1.5});
    scene.show(box, "box");
    app::Session session = plain_session(scene);
    session.set_camera(camera);
    const app::Moment before = session.moment(size);
    box.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, -1.5)));
    TruthOptions options;
    options.size = size;
    options.previous = &before;
    const GroundTruth truth =
        ground_truth(session, {"flow_backward", "occlusion_backward", "depth"}, options);
    int seen = 0;
    for (size_t i = 0; i < size_t(size.prod()); ++i) {
        const float* flow = &truth.layers.at("flow_backward").floats()[2 * i];
        const bool is_covered = truth.layers.at("depth").floats()[i] > 0;
        seen += is_covered;
        ASSERT_EQ(truth.layers.at("occlusion_backward").bytes()[i], is_covered);
        ASSERT_EQ(std::isnan(flow[0]) && std::isnan(flow[1]), is_covered);
        ASSERT_TRUE(is_covered || (flow[0] == 0 && flow[1] == 0));
    }
    EXPECT_GT(seen, 1000);
}

// Labels of faces; classes where there are none.
TEST(GroundTruth, SemanticIds) {
    Scene scene;
    Mesh square = facing_square(1);
    square.set_L(Array1i(Array1i::Dense{{7, 9}}));
    scene.show(square, "labelled");
    scene.show(moved(facing_square(0.5), {0, 0, 0.5}), "plain");
    app::Session session = plain_session(scene, 40);
    look_from(session, Vec3d(0, 0, 5), 35);
    TruthOptions options = with_instances({40, 40});
    options.classes = {{"plain", 3}};
    const GroundTruth truth = ground_truth(session, {"semantic_id", "instance_id", "face_id"}, options);
    std::map<std::pair<int, int>, int> counts;
    for (size_t i = 0; i < 1600; ++i) {
        const int instance = truth.layers.at("instance_id").integers()[i];
        const int face = truth.layers.at("face_id").integers()[i];
        const int expected = instance == 0 ? 0 : instance == 2 ? 3 : face == 0 ? 7 : 9;
        EXPECT_EQ(truth.layers.at("semantic_id").integers()[i], expected);
        ++counts[{instance, expected}];
    }
    EXPECT_EQ(counts.size(), 4u);
    EXPECT_EQ(named(truth, "plain").semantic_id, 3);
}

// A car with a wheel: one instance as an object, two as nodes.
TEST(GroundTruth, InstancesAreObjectsOrNodes) {
    Scene scene;
    Mesh car = facing_square(1);
    car.add_child(moved(facing_square(0.3), {0, 0, 0.2}));
    scene.show(car, "car");
    app::Session session = plain_session(scene, 40);
    look_from(session, Vec3d(0, 0, 5), 35);
    TruthOptions options = with_instances({40, 40});
    EXPECT_EQ(ground_truth(session, {}, options).instances.size(), 1u);
    // The wheel lies at z = 0.2 in the car's frame.
    EXPECT_NEAR(ground_truth(session, {}, options).instances[0].box.max().z(), 0.2, 1e-6);
    options.instances_by = InstancesBy::node;
    const GroundTruth nodes = ground_truth(session, {}, options);
    ASSERT_EQ(nodes.instances.size(), 2u);
    EXPECT_LT(nodes.instances[0].visible_fraction, 1);
    EXPECT_EQ(nodes.instances[1].visible_fraction, 1);
}

TEST(GroundTruth, NodesOfOneNameAreNumbered) {
    Scene scene;
    Mesh row;
    for (int i = 0; i < 4; ++i) {
        Mesh wheel = moved(facing_square(0.1), {i - 1.5, 0, 0});
        wheel.edit([](MeshData& data) { data.name = "wheel"; });
        row.add_child(wheel);
    }
    scene.show(row, "row");
    scene.show(moved(facing_square(0.1), {0, 1, 0}), "row/wheel#3");
    app::Session session = plain_session(scene, 40);
    look_from(session, Vec3d(0, 0, 5), 35);
    TruthOptions options = with_instances({40, 40});
    options.instances_by = InstancesBy::node;
    std::vector<std::string> names;
    for (const Instance& instance : ground_truth(session, {}, options).instances)
        names.push_back(instance.name);
    EXPECT_EQ(names, (std::vector<std::string>{"row", "row/wheel", "row/wheel#2", "row/wheel#4",
                                               "row/wheel#5", "row/wheel#3"}));
}

// A child "b" of "a", and what the scene shows as "a/b": two instances, however they are told apart. The
// child is in the left half of the picture, and the class "a/b" is of what the scene shows.
TEST(GroundTruth, NamesOfChildrenAndOfTheSceneDiffer) {
    Scene scene;
    Mesh parent = moved(facing_square(0.3f), {-1, 0, 0});
    MeshData child = *facing_square(0.2f).snapshot();
    child.name = "b";
    parent.add_child(moved(Mesh(child), {0, 0.6, 0}));
    scene.show(parent, "a");
    scene.show(moved(facing_square(0.25f), {1, 0, 0}), "a/b");
    app::Session session = plain_session(scene, 80);
    look_from(session, Vec3d(0, 0, 5), 35);
    TruthOptions options = with_instances({80, 80});
    options.classes = {{"a", 1}, {"a/b", 2}};
    const GroundTruth objects = ground_truth(session, {}, options);
    ASSERT_EQ(objects.instances.size(), 2u);
    // Both squares of "a": from -0.3 to 0.8 in its frame.
    EXPECT_NEAR(named(objects, "a").box.sizes().y(), 1.1, 1e-6);
    EXPECT_NEAR(named(objects, "a/b").box.sizes().y(), 0.5, 1e-6);
    for (const InstancesBy by : {InstancesBy::node, InstancesBy::part}) {
        options.instances_by = by;
        const GroundTruth nodes = ground_truth(session, {}, options);
        ASSERT_EQ(nodes.instances.size(), 3u);
        EXPECT_NEAR(named(nodes, "a").box.sizes().x(), 0.6, 1e-6);
        EXPECT_NEAR(named(nodes, "a/b").box.sizes().x(), 0.5, 1e-6);
        EXPECT_GT(named(nodes, "a/b").box_visible.x, 40);
        EXPECT_EQ(named(nodes, "a/b").semantic_id, 2);
        EXPECT_NEAR(named(nodes, "a/b#2").box.sizes().x(), 0.4, 1e-6);
        EXPECT_LT(named(nodes, "a/b#2").box_visible.x, 40);
        EXPECT_EQ(named(nodes, "a/b#2").semantic_id, 1);
    }
}

TEST(GroundTruth, NamesWhatThereIsNot) {
    app::Session session = plain_session(Scene());
    try {
        ground_truth(session, {"dept"});
        FAIL();
    } catch (const NameError& error) {
        EXPECT_NE(std::string(error.what()).find("'depth'"), std::string::npos) << error.what();
    }
    EXPECT_THROW(instances_by_named("objects"), NameError);
}

}  // namespace
}  // namespace easypbr::dataset::ground_truth_test
