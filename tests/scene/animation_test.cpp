#include "easypbr/scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "refusal.h"
#include "scene/animation_channels.h"

namespace easypbr::animation_test {
namespace {

Mesh triangle() {
    return Mesh(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Array3i::Dense{{0, 1, 2}});
}

/// A mesh (node 0) on two joints (1, and 2 below it), which its vertices follow with the weights 1, 1/2 + 1/2
/// and 1.
AnimationRig skinned(const Mesh& mesh) {
    AnimationRig rig;
    rig.nodes.resize(3);
    rig.nodes[2].parent = 1;
    rig.nodes[2].translation = Vec3d(0, 1, 0);
    rig.skins = {{{1, 2}, {Eigen::Affine3d::Identity(), Eigen::Affine3d(Eigen::Translation3d(0, -1, 0))}}};
    rig.nodes[0].mesh = mesh;
    rig.nodes[0].skin = 0;
    Deformation& d = rig.nodes[0].deformation;
    d.V = mesh.V();
    d.joints = ArrayXf::Dense{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}};
    d.weights = ArrayXf::Dense{{1, 0, 0, 0}, {0.5, 0.5, 0, 0}, {1, 0, 0, 0}};
    rig.animations = {{"bend", 1, {}}};
    AnimationChannel c = channel(Interpolation::linear, {0, 1}, ArrayXf::Dense{{0, 1, 0}, {4, 1, 0}});
    c.node = 2;
    rig.animations[0].channels = {c};
    return rig;
}

TEST(Animations, RefuseARigThatDoesNotFitTogether) {
    const auto message = [](auto&& change) {
        AnimationRig rig = skinned(triangle());
        change(rig);
        return refusal([&] { Animations{std::move(rig)}; });
    };
    const auto of_channel = [&](auto&& change) {
        return message([&](AnimationRig& rig) { change(rig.animations[0].channels[0]); });
    };
    EXPECT_EQ(message([](AnimationRig&) {}), "taken");
    EXPECT_EQ(
        of_channel([](AnimationChannel& c) { c.values = ArrayXf(); }),
        "animation rig: animation 'bend', channel 0: expected values of 2 rows, 1 for each of 2 times, and 3 "
        "columns, got 0 x 0");
    EXPECT_EQ(of_channel([](AnimationChannel& c) { c.node = 7; }),
              "animation rig: animation 'bend', channel 0: node 7 does not exist, there are 3");
    EXPECT_EQ(message([](AnimationRig& rig) { rig.nodes[2].parent = 7; }),
              "animation rig: node 7 does not exist, there are 3");
    EXPECT_EQ(of_channel([](AnimationChannel& c) {
                  c.times = {1, 1};
              }),
              "animation rig: animation 'bend', channel 0: expected finite times that rise, got 1 as time 1 "
              "of 2, after 1");
    EXPECT_NE(of_channel([](AnimationChannel& c) { c.times[1] = NAN; }), "taken");
    EXPECT_EQ(of_channel([](AnimationChannel& c) { c.values = ArrayXf::Dense::Constant(2, 3, NAN); }),
              "animation rig: animation 'bend', channel 0: expected finite values, got others in row 0 of 2");
    EXPECT_EQ(message([](AnimationRig& rig) { rig.animations[0].duration_s = -1; }),
              "animation rig: animation 'bend': expected a finite duration of at least 0, got -1");
    EXPECT_NE(message([](AnimationRig& rig) { rig.animations[0].duration_s = NAN; }), "taken");
    EXPECT_EQ(message([](AnimationRig& rig) { rig.skins[0].T_joint_at_rest.pop_back(); }),
              "animation rig: expected a pose at rest for each of 2 joints of a skin, got 1");
    EXPECT_EQ(message([](AnimationRig& rig) { rig.materials.resize(1); }),
              "animation rig: material 0: expected a function of its values, got none");
    EXPECT_EQ(message([](AnimationRig& rig) { rig.lights.resize(1); }),
              "animation rig: light 0: expected a function of its values, got none");
    EXPECT_NE(message([](AnimationRig& rig) { rig.cameras.resize(1); }), "taken");
}

/// Where the mesh's vertices are in the world, one in each row.
Array3f::Dense world_V(const Mesh& mesh) {
    const Eigen::Affine3d T = mesh.T_world_mesh();
    return (T * mesh.V().cast<double>().transpose().eval()).transpose().cast<float>();
}

/// Of the first triangle, as its winding tells, in the world.
Vec3d world_normal(const Mesh& mesh) {
    const Eigen::Matrix3d V = world_V(mesh).topRows<3>().cast<double>();
    const Vec3d n = (V.row(1) - V.row(0)).cross(V.row(2) - V.row(0)).transpose();
    // A mirrored pose exchanges the sides of faces.
    return mesh.T_world_mesh().linear().determinant() < 0 ? Vec3d(-n) : n;
}

TEST(Animations, SkinsFollowTheirJoints) {
    Mesh mesh = triangle();
    Animations animations(skinned(mesh));
    animations.apply(0, 0);
    EXPECT_EQ(mesh.V(), triangle().V()) << "at rest";
    animations.apply(0, 0.5);
    // The second joint has moved by 2 along x: all of it, and half of it.
    EXPECT_EQ(mesh.V(), (Array3f::Dense{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}}));
    animations.apply(0, 1.25);
    EXPECT_EQ(mesh.V()(2, 0), 1) << "goes around";
    EXPECT_EQ(mesh.snapshot()->rest_shape.V, triangle().V()) << "tells which edges are sharp in all poses";
    EXPECT_EQ(mesh.snapshot()->rest_shape.F_revision, mesh.F().revision());
    animations.apply(0, 1.25, false);
    EXPECT_EQ(mesh.V()(2, 0), 4) << "rests";
}

TEST(Animations, TheMeshsOwnNodeDoesNotMoveItsSkin) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].translation = Vec3d(7, 0, 0);
    Animations(std::move(rig)).apply(0, 0.5);
    // In the world the vertices are where the joints put them.
    EXPECT_LT((mesh.T_world_mesh() * mesh.V().row(2).transpose().cast<double>() - Vec3d(2, 1, 0)).norm(),
              1e-6);
}

TEST(Animations, AtRestSkinsFollowTheirJoints) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].translation = Vec3d(7, 0, 0);
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(7, 0, 0)));
    rig.nodes[1].translation = Vec3d(0, 0, 3);
    rig.animations.clear();
    Animations animations(std::move(rig));
    animations.put_at_rest();
    animations.put_at_rest();
    // The joints are 3 above where the mesh was bound to them, in the world; its own node adds nothing.
    EXPECT_EQ(world_V(mesh), (Array3f::Dense{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}}));
}

// glTF 2.0, section 3.7.3.3: only the joints' transforms apply. The sign of the node's determinant would tell
// the side of faces that is outside.
TEST(Animations, ASkinIsNotMirroredByItsNode) {
    for (const bool above : {false, true}) {
        SCOPED_TRACE(above);
        Mesh parent, mesh = triangle();
        parent.add_child(mesh);
        AnimationRig rig = skinned(mesh);
        rig.nodes.resize(4);
        rig.nodes[0].parent = 3;
        rig.nodes[3].mesh = parent;
        rig.nodes[above ? 3 : 0].scale = Vec3d(-1, 1, 1);
        parent.set_T_parent_mesh(Eigen::Affine3d(Eigen::Scaling(rig.nodes[3].scale)));
        Animations animations(std::move(rig));
        animations.put_at_rest();
        EXPECT_EQ(world_V(mesh), triangle().V());
        EXPECT_GT(world_normal(mesh).z(), 0);
        animations.apply(0, 0.5);
        EXPECT_EQ(world_V(mesh), (Array3f::Dense{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}}));
        EXPECT_GT(world_normal(mesh).z(), 0);
    }
}

// Joints that mirror what follows them mirror its faces with it: their outside stays outside.
TEST(Animations, ASkinIsMirroredWithItsJoints) {
    MeshData data = *triangle().snapshot();
    data.N = Array3f::Dense(Vec3(0, 0, 1).transpose().replicate(3, 1));
    Mesh mesh(data);
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].deformation.N = data.N;
    rig.nodes[1].scale = Vec3d(-1, 1, 1);
    Animations(std::move(rig)).apply(0, 0);
    EXPECT_EQ(world_V(mesh), (Array3f::Dense{{0, 0, 0}, {-1, 0, 0}, {0, 1, 0}}));
    EXPECT_GT(world_normal(mesh).z(), 0);
    // Poses turn normals by the inverse transpose.
    EXPECT_GT(
        (mesh.T_world_mesh().linear().inverse().transpose() * mesh.N().row(0).transpose().cast<double>()).z(),
        0);
}

TEST(Animations, ASkinMovesWithItsJointsNotWithItsNode) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    AnimationChannel slide = channel(Interpolation::linear, {0, 1}, ArrayXf::Dense{{0, 0, 0}, {2, 0, 0}});
    slide.node = 0;
    rig.animations[0].channels = {slide};
    slide.node = 1;
    rig.animations.push_back({"walk", 1, {slide}});
    const Animations animations(std::move(rig));
    EXPECT_EQ(animations.motion(0, 0.25, 0.75)[0].second.matrix(), Eigen::Matrix4d::Identity());
    // All joints hang from the one that goes 2 units a second.
    const MovedMeshes walked = animations.motion(1, 0.25, 0.75);
    EXPECT_EQ(walked[0].second.translation(), Vec3d(-1, 0, 0));
}

// What hangs from a skinned mesh has its place by the nodes' poses.
TEST(Animations, ChildrenOfASkinGoWithItsNode) {
    Mesh mesh = triangle(), child = triangle();
    mesh.add_child(child);
    AnimationRig rig = skinned(mesh);
    rig.nodes.resize(4);
    rig.nodes[0].translation = Vec3d(7, 0, 0);
    rig.nodes[0].scale = Vec3d(-1, 1, 1);
    rig.nodes[1].translation = Vec3d(0, 0, 3);
    rig.nodes[3].parent = 0;
    rig.nodes[3].translation = Vec3d(2, 0, 0);
    rig.nodes[3].mesh = child;
    Animations animations(std::move(rig));
    for (const bool is_at_rest : {true, false}) {
        if (is_at_rest) {
            animations.put_at_rest();
        } else {
            animations.apply(0, 0.5);
        }
        EXPECT_EQ(child.T_world_mesh().translation(), Vec3d(5, 0, 0));
        EXPECT_LT(child.T_world_mesh().linear().determinant(), 0);
    }
}

TEST(Animations, AtRestNothingElseIsTouched) {
    Mesh mesh = triangle();
    AnimationRig rig;
    rig.nodes.resize(1);
    rig.nodes[0].mesh = mesh;
    rig.nodes[0].deformation.V = mesh.V();
    rig.nodes[0].deformation.targets_V = {Array3f::Dense{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}};
    rig.nodes[0].deformation.targets_N.resize(1);
    rig.nodes[0].weights = {0};
    const float* data = mesh.V().data();
    Animations still(rig);
    still.put_at_rest();
    EXPECT_EQ(mesh.V().data(), data) << "the same array";
    rig.nodes[0].weights = {0.5f};
    Animations morphed(rig);
    morphed.put_at_rest();
    EXPECT_EQ(mesh.V()(0, 2), 0.5f);
}

// What is scaled to nothing cannot be moved back to where the joints are.
TEST(Animations, ASkinOfANodeWithoutSizeStaysFinite) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].scale.setZero();
    Animations animations(std::move(rig));
    animations.put_at_rest();
    animations.apply(0, 0.5);
    EXPECT_TRUE(mesh.V().allFinite());
}

// A skin is where its joints are, whatever its own node's scale: also where that has no inverse.
TEST(Animations, ASkinWhoseNodeIsScaledToNothingFollowsItsJoints) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].translation = Vec3d(7, 0, 0);
    rig.nodes[0].scale = Vec3d(0, 1, 1);
    Animations animations(std::move(rig));
    const auto last_vertex = [&] {
        return Vec3d(mesh.T_world_mesh() * mesh.V().row(2).transpose().cast<double>());
    };
    animations.apply(0, 0.5);
    EXPECT_LT((last_vertex() - Vec3d(2, 1, 0)).norm(), 1e-6);
    // As it is loaded.
    mesh.set_T_parent_mesh(Eigen::Translation3d(7, 0, 0) * Eigen::Scaling(0.0, 1.0, 1.0));
    animations.put_at_rest();
    EXPECT_LT((last_vertex() - Vec3d(0, 1, 0)).norm(), 1e-6);
}

// All of it, joints too, hangs from a node of scale 0: a point, which has finite vertices all the same.
TEST(Animations, ASkinBelowWhatIsScaledToNothingStaysFinite) {
    Mesh armature, mesh = triangle();
    armature.add_child(mesh);
    AnimationRig rig = skinned(mesh);
    rig.nodes.resize(4);
    rig.nodes[0].parent = rig.nodes[1].parent = 3;
    rig.nodes[3].mesh = armature;
    AnimationChannel grow =
        channel(Interpolation::linear, {0, 1}, ArrayXf::Dense{{0, 0, 0}, {1, 1, 1}}, AnimatedProperty::scale);
    grow.node = 3;
    rig.animations[0].channels.push_back(grow);
    Animations animations(std::move(rig));
    animations.apply(0, 0.5);
    animations.apply(0, 0);
    EXPECT_TRUE(mesh.V().array().isFinite().all());
    for (int i = 0; i < 3; ++i)
        EXPECT_LT((mesh.T_world_mesh() * mesh.V().row(i).transpose().cast<double>()).norm(), 1e-6);
    animations.apply(0, 0.5);
    // Half as large as that of SkinsFollowTheirJoints.
    EXPECT_LT((mesh.T_world_mesh() * mesh.V().row(2).transpose().cast<double>() - Vec3d(1, 0.5, 0)).norm(),
              1e-6);
}

TEST(Animations, AWholeDurationAfterTheBeginningIsTheEnd) {
    Mesh mesh = triangle();
    AnimationRig rig = skinned(mesh);
    rig.animations[0].duration_s = 2.1f;
    rig.animations[0].channels[0].times = {0, 2.1f};
    Animations animations(std::move(rig));
    // 2.1f is less than 2.1 by 1e-7 of it.
    for (const double time_s : {2.1, double(2.1f), 2 * double(2.1f)}) {
        animations.apply(0, time_s);
        EXPECT_NEAR(mesh.V()(2, 0), 4, 1e-5) << time_s;
    }
    for (const double time_s : {0.0, -double(2.1f), 2.1001}) {
        animations.apply(0, time_s);
        EXPECT_NEAR(mesh.V()(2, 0), 0, 1e-3) << time_s;
    }
}

TEST(Animations, MorphTargetsAddUp) {
    Mesh mesh = triangle();
    AnimationRig rig;
    rig.nodes.resize(1);
    rig.nodes[0].mesh = mesh;
    rig.nodes[0].deformation.V = mesh.V();
    rig.nodes[0].deformation.targets_V = {Array3f::Dense{{0, 0, 1}, {0, 0, 0}, {0, 0, 0}},
                                          Array3f::Dense{{0, 0, 0}, {0, 0, 2}, {0, 0, 0}}};
    rig.nodes[0].deformation.targets_N.resize(2);
    rig.nodes[0].weights = {0.5f, 0};
    rig.animations = {{"rest", 0, {}},
                      {"smile",
                       1,
                       {channel(Interpolation::linear, {0, 1}, ArrayXf::Dense{{0, 0}, {1, 2}},
                                AnimatedProperty::weights)}}};
    Animations animations(std::move(rig));
    animations.apply(1, 0.5);
    EXPECT_EQ(mesh.V(), (Array3f::Dense{{0, 0, 0.5}, {1, 0, 2}, {0, 1, 0}}));
    animations.apply(0, 0);
    EXPECT_EQ(mesh.V(), (Array3f::Dense{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}})) << "weights at rest";
    EXPECT_EQ(animations.find("smile"), 1u);
    EXPECT_EQ(animations.find("0"), 0u);
    EXPECT_THROW(animations.find("smiel"), NameError);
    EXPECT_THROW(animations.apply(2, 0), NameError);
    EXPECT_THROW(animations.apply(0, std::numeric_limits<double>::infinity()), ArgumentError);
}

// Two seconds: x goes from 0 to 4, y steps from 0 to 3 at 1 s.
AnimationRig stepping(const Mesh& slides, const Mesh& steps) {
    AnimationRig rig;
    rig.nodes.resize(2);
    rig.nodes[0].mesh = slides;
    rig.nodes[1].mesh = steps;
    AnimationChannel step = channel(Interpolation::step, {0, 1}, ArrayXf::Dense{{0, 0, 0}, {0, 3, 0}});
    step.node = 1;
    rig.animations = {
        {"both", 2, {channel(Interpolation::linear, {0, 2}, ArrayXf::Dense{{0, 0, 0}, {4, 0, 0}}), step}}};
    return rig;
}

TEST(Animations, StepsHaveNoMotion) {
    Mesh slides = triangle(), steps = triangle();
    const Animations animations(stepping(slides, steps));
    const MovedMeshes moved = animations.motion(0, 0.75, 1.25);
    ASSERT_EQ(moved.size(), 2u);
    EXPECT_LT((moved[0].second.translation() - Vec3d(-1, 0, 0)).norm(), 1e-12);
    EXPECT_EQ(moved[1].second.matrix(), Eigen::Matrix4d::Identity());
    const MovedMeshes jumped = animations.jumps(0, 0.75, 1.25);
    ASSERT_EQ(jumped.size(), 1u);
    EXPECT_TRUE(jumped[0].first == steps);
    EXPECT_TRUE(animations.jumps(0, 0.25, 0.75).empty());
}

TEST(Animations, WhatGoesAroundMovesFromItsBeginning) {
    Mesh slides = triangle(), steps = triangle();
    const Animations animations(stepping(slides, steps));
    const auto x = [&](double from_s, double to_s, bool loop) {
        return animations.motion(0, from_s, to_s, loop)[0].second.translation().x();
    };
    // 2 units a second.
    EXPECT_NEAR(x(1.75, 2.25, true), -0.5, 1e-12);
    EXPECT_NEAR(x(2.25, 1.75, true), 0.5, 1e-12) << "backwards, from its end";
    EXPECT_NEAR(x(1.5, 2, true), -1, 1e-12) << "the end itself";
    EXPECT_NEAR(x(-0.5, 0, true), 0, 1e-12);
    EXPECT_NEAR(x(-1, -0.5, true), -1, 1e-12) << "before its beginning it goes around too";
    EXPECT_NEAR(x(1.75, 2.25, false), -0.5, 1e-12) << "it rests at its end";
    EXPECT_EQ(animations.jumps(0, 1.75, 2.25).size(), 2u) << "the step goes back, too";
    EXPECT_TRUE(animations.jumps(0, 1.75, 2.25, false).empty());
    EXPECT_TRUE(animations.jumps(0, 1.5, 2).empty());
}

// Copies move the same meshes: what one has put, another one takes back.
TEST(Animations, CopiesKnowWhatEachOtherPut) {
    Mesh mesh = triangle();
    mesh.edit([](MeshData& data) { data.materials = {Material()}; });
    AnimationRig rig;
    rig.nodes.resize(1);
    rig.nodes[0].mesh = mesh;
    rig.materials.resize(1);
    rig.materials[0].parameters = {0.25};
    rig.materials[0].material = [](const std::vector<double>& parameters) {
        Material material;
        material.roughness = float(parameters[0]);
        return material;
    };
    rig.materials[0].users = {{mesh, 0}};
    rig.animations = {{"rough",
                       1,
                       {channel(Interpolation::linear, {0, 1}, ArrayXf::Dense{{0.25f}, {0.75f}},
                                AnimatedProperty::material)}},
                      {"still", 1, {}}};
    const Animations loaded(std::move(rig));
    const auto roughness = [&] { return mesh.snapshot()->materials[0].roughness; };
    Animations first = loaded, second = loaded, third = loaded;
    first.apply(0, 1);
    EXPECT_EQ(roughness(), 0.75f);
    second.apply(0, 0);
    EXPECT_EQ(roughness(), 0.25f) << "the first key";
    first.apply(0, 1);
    third.apply(1, 0);
    EXPECT_EQ(roughness(), 0.25f) << "the file's value";
}

// A joint that scales by 2 along x turns the normal (1, 1, 0) as the inverse transpose does: to (1/2, 1, 0).
TEST(Animations, NormalsFollowTheInverseTranspose) {
    MeshData data = *triangle().snapshot();
    data.N = Array3f::Dense(Vec3(1, 1, 0).normalized().transpose().replicate(3, 1));
    Mesh mesh(data);
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].deformation.N = data.N;
    rig.nodes[1].scale = Vec3d(2, 1, 1);
    Animations(std::move(rig)).apply(0, 0);
    EXPECT_LT((mesh.N().row(0).transpose() - Vec3(0.5f, 1, 0).normalized()).norm(), 1e-6);
}

// The second joint goes 2 along z: the corners are (0, 0, 0), (1, 0, 1) and (0, 1, 2), and the cross product
// of the edges (-1, -2, 1).
TEST(Animations, FlatFacesHaveTheirOwnNormalsInEveryPose) {
    MeshData data = *triangle().snapshot();
    data.N = Array3f::Dense(Vec3(0, 0, 1).transpose().replicate(3, 1));
    Mesh mesh(data);
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].deformation.N = data.N;
    rig.nodes[0].deformation.flat_F = data.F;
    rig.animations[0].channels[0].values = ArrayXf::Dense{{0, 1, 2}, {0, 1, 2}};
    AnimationRig broken = rig;
    Animations(std::move(rig)).apply(0, 0);
    for (int i = 0; i < 3; ++i)
        EXPECT_LT((mesh.N().row(i).transpose() - Vec3(-1, -2, 1).normalized()).norm(), 1e-6);  // of rounding
    broken.nodes[0].deformation.flat_F = Array3i::Dense{{0, 1, 3}};
    EXPECT_THROW(Animations(std::move(broken)), ArgumentError);
}

// The tangent (1, 1, 0) is turned as edges are: to (2, 1, 0).
TEST(Animations, TangentsFollowTheJoints) {
    MeshData data = *triangle().snapshot();
    const float half = std::sqrt(0.5f);
    data.uv_tangents = Array4f::Dense(Eigen::RowVector4f(half, half, 0, -1).replicate(3, 1));
    Mesh mesh(data);
    AnimationRig rig = skinned(mesh);
    rig.nodes[0].deformation.uv_tangents = data.uv_tangents;
    rig.nodes[1].scale = Vec3d(2, 1, 1);
    Animations(std::move(rig)).apply(0, 0);
    const Array4f turned = mesh.snapshot()->uv_tangents;
    ASSERT_EQ(turned.rows(), 3);
    EXPECT_LT((Vec3(turned.row(0).head<3>()) - Vec3(2, 1, 0).normalized()).norm(), 1e-6);  // of rounding
    EXPECT_EQ(turned(0, 3), -1);
}

TEST(Animations, RefuseBrokenRigs) {
    AnimationRig rig = skinned(triangle());
    rig.nodes[1].parent = 2;
    EXPECT_THROW(Animations{rig}, ArgumentError) << "a circle";
    rig = skinned(triangle());
    rig.skins[0].joints[1] = 3;
    EXPECT_THROW(Animations{rig}, ArgumentError);
    rig = skinned(triangle());
    rig.nodes[0].deformation.joints = ArrayXf::Dense(ArrayXf::Dense::Constant(3, 4, 2));
    EXPECT_THROW(Animations{rig}, ArgumentError) << "a joint that the skin lacks";
}

}  // namespace
}  // namespace easypbr::animation_test
