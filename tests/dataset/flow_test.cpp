// Optical flow, and what it says is occluded.
#include <gtest/gtest.h>

#include "dataset/placed_meshes.h"
#include "easypbr/dataset/ground_truth.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"
#include "render/render_test.h"

namespace easypbr::dataset::flow_test {
namespace {

// The camera and an object move: the point that a pixel sees is projected by the other frame's own matrices.
TEST(Flow, IsTheProjectionOfTheSamePoint) {
    const Vec2i size(160, 120);
    Scene scene;
    Mesh ball = moved(make_sphere(0.5f, 64), {-0.2, 0, -4});
    scene.show(ball, "ball");
    scene.show(moved(facing_square(3), {0, 0, -6}), "wall");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera(off_centre_K(), size));
    const app::Moment before = session.moment(size);
    ball.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.1, 0.05, -3.9)));
    TruthOptions options;
    options.size = size;
    options.previous = &before;
    const GroundTruth now =
        ground_truth(session, {"flow_backward", "occlusion_backward", "position", "instance_id"}, options);
    const Mat3d K = off_centre_K();
    int hidden = 0;
    for (size_t i = 0; i < size_t(size.prod()); ++i) {
        const int id = now.layers.at("instance_id").integers()[i];
        if (id == 0) continue;
        const float* p = &now.layers.at("position").floats()[3 * i];
        Vec3d point(p[0], p[1], p[2]);
        if (id == 1) point -= Vec3d(0.3, 0.05, 0.1);
        const Vec3d pixel = K * Vec3d(point.x(), -point.y(), -point.z()) / -point.z();
        const float* flow = &now.layers.at("flow_backward").floats()[2 * i];
        EXPECT_NEAR(double(i % 160) + flow[0], pixel.x(), 2e-3);
        EXPECT_NEAR(double(i / 160) + flow[1], pixel.y(), 2e-3);
        hidden += now.layers.at("occlusion_backward").bytes()[i];
    }
    // A strip of the wall that the ball has uncovered, about 15 pixels wide and 50 high, and the ball's own
    // edge.
    EXPECT_GT(hidden, 200);
    EXPECT_LT(hidden, 1500);
    options.previous = nullptr;
    EXPECT_THROW(ground_truth(session, {"flow_backward"}, options), ArgumentError);
}

/// Of a mesh at a pose now, from the frame in which it was at another pose: covered pixels, and those whose
/// point was not seen there.
struct Counts {
    int seen = 0, occluded = 0;
};
Counts occluded_from(Mesh mesh, const Eigen::Affine3d& before, const Eigen::Affine3d& now) {
    const Vec2i size(160, 120);
    Scene scene;
    scene.show(mesh, "mesh");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera(off_centre_K(), size));
    mesh.set_T_parent_mesh(before);
    const app::Moment moment = session.moment(size);
    mesh.set_T_parent_mesh(now);
    TruthOptions options;
    options.size = size;
    options.previous = &moment;
    const GroundTruth truth = ground_truth(session, {"occlusion_backward", "depth"}, options);
    Counts counts;
    for (size_t i = 0; i < size_t(size.prod()); ++i) {
        counts.seen += truth.layers.at("depth").floats()[i] > 0;
        counts.occluded += truth.layers.at("occlusion_backward").bytes()[i];
    }
    return counts;
}

// A card that turns its back shows none of the points of its front, however thin it is. Of a single sheet the
// same points are seen from behind.
TEST(Flow, WhatTurnsItsBackIsOccluded) {
    const Eigen::Affine3d now(Eigen::Translation3d(0, 0, -2));
    const Eigen::Affine3d turned = now * Eigen::AngleAxisd(radians(180), Vec3d::UnitY());
    for (const float thickness : {0.1f, 0.01f, 0.001f}) {
        const Counts card = occluded_from(make_box(Vec3(0.6f, 0.4f, thickness)), turned, now);
        EXPECT_GT(card.seen, 1500);
        EXPECT_EQ(card.occluded, card.seen) << thickness;
        EXPECT_EQ(occluded_from(make_box(Vec3(0.6f, 0.4f, thickness)), now, now).occluded, 0) << thickness;
    }
    const Counts sheet = occluded_from(facing_square(0.3f), turned, now);
    EXPECT_GT(sheet.seen, 1500);
    EXPECT_EQ(sheet.occluded, 0);
    MeshData voxels;
    Array3f::Dense V(400, 3);
    for (int i = 0; i < 400; ++i)
        V.row(i) << 0.015f * (float(i % 20) - 9.5f), 0.015f * (float(i / 20) - 9.5f), 0;
    voxels.V = Array3f(V);
    voxels.voxel_size = 0.015f;
    const Counts layer = occluded_from(Mesh(voxels), turned, now);
    EXPECT_GT(layer.seen, 500);
    EXPECT_EQ(layer.occluded, layer.seen);
}

// A floor of small faces, seen at down to two degrees, hides nothing of itself: what is not seen is outside
// of the picture. A pixel is 2.3 % of the depth there.
TEST(Flow, GrazingSurfacesAreNotOccluded) {
    constexpr int side = 120;
    MeshData floor;
    Array3f::Dense V((side + 1) * (side + 1), 3);
    Array3i::Dense F(2 * side * side, 3);
    for (int i = 0; i <= side; ++i)
        for (int k = 0; k <= side; ++k)
            V.row(i * (side + 1) + k) << 8.0f * (float(k) / side - 0.5f), -0.2f, -1 - 5.0f * float(i) / side;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const int a = i * (side + 1) + k, b = a + side + 1;
            F.row(2 * (i * side + k)) << a, a + 1, b + 1;
            F.row(2 * (i * side + k) + 1) << a, b + 1, b;
        }
    floor.V = Array3f(V);
    floor.F = Array3i(F);
    const Eigen::Affine3d now = Eigen::Affine3d::Identity();
    const Eigen::Affine3d before(Eigen::Translation3d(0.01, 0, -0.02));
    const Counts counts = occluded_from(Mesh(floor), before, now);
    EXPECT_GT(counts.seen, 4500);
    // It was 0.01 to the right, 2.1 pixels at its near end: of its 38 rows three columns at most were
    // outside.
    EXPECT_LE(counts.occluded, 3 * 38);
}

// Of three children of one name the first leaves: the others are where they were.
TEST(Flow, OfSiblingsOfOneNameIsTheirOwn) {
    const Vec2i size(160, 120);
    for (const bool hides : {false, true}) {
        Scene scene;
        Mesh parent, first = moved(make_sphere(0.3f, 32), {-0.8, 0, -4});
        parent.add_child(first);
        for (const double x : {0.0, 0.8}) parent.add_child(moved(make_sphere(0.3f, 32), {x, 0, -4}));
        scene.show(parent, "row");
        app::Session session = plain_session(scene);
        session.set_camera(opencv_camera(off_centre_K(), size));
        const app::Moment before = session.moment(size);
        if (hides) {
            Style hidden;
            hidden.visible = false;
            first.set_style(hidden);
        } else {
            parent.remove_child(first);
        }
        TruthOptions options;
        options.size = size;
        options.previous = &before;
        const GroundTruth now =
            ground_truth(session, {"flow_backward", "occlusion_backward", "depth"}, options);
        int seen = 0;
        for (size_t i = 0; i < size_t(size.prod()); ++i) {
            if (!(now.layers.at("depth").floats()[i] > 0)) continue;
            ++seen;
            // Single precision of the position: a few times 1e-7 of 160 pixels.
            for (size_t k = 0; k < 2; ++k)
                EXPECT_NEAR(now.layers.at("flow_backward").floats()[2 * i + k], 0, 2e-3);
            EXPECT_EQ(now.layers.at("occlusion_backward").bytes()[i], 0);
        }
        EXPECT_GT(seen, 500);
    }
}

// Nothing tells which points of a mesh are those of another one of its name.
TEST(Flow, OfOtherArraysIsNone) {
    const Vec2i size(160, 120);
    Scene scene;
    Mesh mesh = moved(make_sphere(0.5f, 64), {0, 0, -4});
    scene.show(mesh, "ball");
    app::Session session = plain_session(scene);
    session.set_camera(opencv_camera(off_centre_K(), size));
    const app::Moment before = session.moment(size);
    const Mesh finer = make_sphere(0.5f, 96);
    mesh.edit([&](MeshData& data) {
        data.V = finer.V();
        data.N = finer.N();
        data.F = finer.F();
        data.UV = {};
    });
    TruthOptions options;
    options.size = size;
    options.previous = &before;
    const GroundTruth now = ground_truth(session, {"flow_backward", "occlusion_backward", "depth"}, options);
    int seen = 0;
    for (size_t i = 0; i < size_t(size.prod()); ++i) {
        if (!(now.layers.at("depth").floats()[i] > 0)) continue;
        ++seen;
        EXPECT_TRUE(std::isnan(now.layers.at("flow_backward").floats()[2 * i]));
        EXPECT_EQ(now.layers.at("occlusion_backward").bytes()[i], 1);
    }
    EXPECT_GT(seen, 1000);
}

// A wall that was 0.9 pixels further to the left: what the first column shows was outside. 0.4 pixels to the
// left its nearest pixel is the first column still.
TEST(Flow, OutsideIsWhereTheNearestPixelIs) {
    const Eigen::Affine3d now(Eigen::Translation3d(0, 0, -3));
    const double pixel = 3.0 / 210;
    EXPECT_EQ(occluded_from(facing_square(5), Eigen::Translation3d(-0.9 * pixel, 0, 0) * now, now).occluded,
              120);
    EXPECT_EQ(occluded_from(facing_square(5), Eigen::Translation3d(-0.4 * pixel, 0, 0) * now, now).occluded,
              0);
    EXPECT_EQ(occluded_from(facing_square(5), Eigen::Translation3d(0.9 * pixel, 0, 0) * now, now).occluded,
              120);
}

}  // namespace
}  // namespace easypbr::dataset::flow_test
