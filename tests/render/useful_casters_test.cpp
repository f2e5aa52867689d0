// Floors are left out of shadow maps, and nothing else is.
#include "easypbr/render/shadow/useful_casters.h"

#include <fmt/format.h>

#include <vector>

#include "easypbr/gl/program.h"
#include "easypbr/render/primitives/caches.h"
#include "easypbr/render/shadow/caster_bounds.h"
#include "shadow_test.h"

namespace easypbr::render::useful_casters_test {
namespace {

std::vector<FacePlane> planes_of(const Mesh& mesh) {
    return convex_faces(mesh.V(), mesh.F());
}

TEST(ConvexFaces, OfAFlatMeshAreBothItsSides) {
    const auto of_square = planes_of(facing_square(3));
    ASSERT_EQ(of_square.size(), 2u);
    EXPECT_EQ(of_square[0].normal, Vec3d(0, 0, 1));
    EXPECT_EQ(of_square[1].normal, Vec3d(0, 0, -1));
    EXPECT_EQ(of_square[0].offset, 0);
    EXPECT_EQ(planes_of(make_plane(2, 40)).size(), 2u);  // of 3200 faces
}

TEST(ConvexFaces, OfASlabAreSixInAnyWinding) {
    Mesh box = make_box(Vec3(0.4f, 4, 6));
    for (const bool inward : {false, true}) {
        if (inward) box.set_F(Array3i(Array3i::Dense(Array3i::Dense(box.F()).rowwise().reverse())));
        const auto planes = planes_of(box);
        ASSERT_EQ(planes.size(), 6u) << inward;
        for (const FacePlane& plane : planes) {
            const Vec3d half(0.2, 2, 3);
            EXPECT_NEAR(plane.offset, plane.normal.cwiseAbs().dot(half), 1e-6) << inward;
        }
    }
}

// What is open, hollow or made of many faces may hide light from itself, and what is thick may be a room.
TEST(ConvexFaces, OthersHaveNone) {
    const Vec3 slab(4, 4, 0.4f);
    EXPECT_EQ(planes_of(make_box(slab)).size(), 6u);
    EXPECT_TRUE(planes_of(make_box()).empty());
    Mesh open = make_box(slab);
    open.set_F(Array3i(Array3i::Dense(Array3i::Dense(open.F()).topRows(10))));
    EXPECT_TRUE(planes_of(open).empty());
    EXPECT_TRUE(planes_of(make_sphere(1, 32)).empty());
    Array3f::Dense V = make_box(slab).V();
    for (Eigen::Index i = 0; i < V.rows(); ++i)
        if (V(i, 0) > 0 && V(i, 1) > 0 && V(i, 2) > 0) V.row(i).setConstant(-0.1f);  // a dent
    EXPECT_TRUE(planes_of(Mesh(Array3f(V), make_box(slab).F())).empty());
    EXPECT_TRUE(convex_faces(Array3f(), Array3i()).empty());
}

CasterExtent extent_of(const Mesh& mesh) {
    const Scene scene = [&] {
        Scene one;
        one.show(mesh, "mesh");
        return one;
    }();
    return {scene.snapshot().bounds(), 0, planes_of(mesh)};
}

CasterExtent ball_at(const Vec3d& centre, double radius) {
    const Vec3d half = Vec3d::Constant(radius);
    return {Box3d(centre - half, centre + half), 0, {}};
}

size_t left_out(const std::vector<CasterExtent>& casters, const ResolvedLight& light,
                const std::optional<FacePlane>& ground = std::nullopt) {
    return useful_casters(light, CasterSet(casters), 0, ground).left_out.size();
}

ResolvedLight sun_along(const Vec3& direction) {
    return ResolvedLight(directional(direction), 0);
}

ResolvedLight lamp_at(const Vec3& position, float radius = 0) {
    return ResolvedLight(point(position, radius), radius);
}

const CasterExtent floor_of_20 = extent_of(facing_square(10));

TEST(UsefulCasters, LeaveOutAFloor) {
    const std::vector<CasterExtent> casters{floor_of_20, ball_at(Vec3d(1, 0, 1), 1)};
    const UsefulCasters useful =
        useful_casters(sun_along(Vec3(1, 0, -1)), CasterSet(casters), 0, std::nullopt);
    EXPECT_EQ(useful.left_out, std::vector<size_t>{0});
    EXPECT_EQ(useful.bounds.min(), Vec3d(0, -1, 0));
    EXPECT_EQ(useful.bounds.max(), Vec3d(2, 1, 2));
    EXPECT_EQ(left_out(casters, lamp_at(Vec3(0, 0, 3), 0.5f)), 1u);
}

// Light from the top of the ball, 2 above the floor, goes 2 units to it. The penumbra's radius there is 0.24
// of that, rounded up to 0.5, and the map is as many times as wide as the filter may be.
TEST(UsefulCasters, HaveRoomForPenumbrae) {
    const CasterSet casters({floor_of_20, ball_at(Vec3d(1, 0, 1), 1)});
    UsefulCasters useful = useful_casters(sun_along(Vec3(0, 0, -1)), casters, 0.24, std::nullopt);
    const double half = 0.5 / widest_filter / 2;
    EXPECT_LT((useful.bounds.min() - Vec3d(1 - half, -half, 0)).norm(), 1e-6);  // of single precision
    EXPECT_LT((useful.bounds.max() - Vec3d(1 + half, half, 2)).norm(), 1e-6);
    // 4 above the ball's top, whose penumbra on the floor has a radius from 0.5 on; the outermost rays go by
    // it 1.41 + 1 aside, 2.6 to the floor.
    useful = useful_casters(lamp_at(Vec3(1, 0, 6), 1), casters, 1, std::nullopt);
    EXPECT_EQ(useful.left_out.size(), 1u);
    EXPECT_GE(useful.bounds.sizes().x(), 0.5 / widest_filter);
    EXPECT_LE(useful.bounds.sizes().x(), 1 / widest_filter + 1e-6);
}

// A post 2 high on a floor of 400 under a low sun, which sees it from the side: the box is 2 high, and the
// map turned to the sun is wide enough for 2 / sin(8 - 2.58 degrees) * tan(2.58 degrees) all the same.
TEST(UsefulCasters, HaveRoomForPenumbraeOfALowSun) {
    const CasterExtent post{Box3d(Vec3d(-0.1, -0.1, 0), Vec3d(0.1, 0.1, 2)), 0, {}};
    ResolvedLight sun = sun_along(Vec3(std::cos(radians(8.0f)), 0, -std::sin(radians(8.0f))));
    sun.angular_radius_deg = 2.58f;
    const double extent = std::tan(radians(2.58));
    const UsefulCasters useful =
        useful_casters(sun, CasterSet({extent_of(facing_square(200)), post}), extent, std::nullopt);
    ASSERT_EQ(useful.left_out.size(), 1u);
    const Vec3d across(std::sin(radians(8.0)), 0, std::cos(radians(8.0)));
    EXPECT_GE(widest_filter * useful.bounds.sizes().dot(across), extent * 2 / std::sin(radians(8 - 2.58)));
    EXPECT_LT(useful.bounds.sizes().x(), 100);  // far less than the floor
}

TEST(UsefulCasters, FiltersAreAsWideAsTheShaders) {
    const std::string text = gl::shader_source("common_shadow_filter.glsl");
    EXPECT_NE(text.find(fmt::format("const float widest = {};", widest_filter)), text.npos);
}

// From below, from behind the plane, or from both sides of it, the floor hides the light.
TEST(UsefulCasters, KeepAFloorThatHidesTheLight) {
    const std::vector<CasterExtent> casters{floor_of_20, ball_at(Vec3d(1, 0, 1), 1)};
    EXPECT_EQ(left_out(casters, sun_along(Vec3(0, 0, 1))), 0u);
    EXPECT_EQ(left_out(casters, sun_along(Vec3(1, 0, 0))), 0u);
    EXPECT_EQ(left_out(casters, lamp_at(Vec3(0, 0, 0.3f), 0.5f)), 0u);
    EXPECT_EQ(left_out(casters, lamp_at(Vec3(0, 0, -3))), 0u);
}

// A ball below it, a floor below it, and a plane that receives shadows below it or beside it.
TEST(UsefulCasters, KeepAFloorAboveSomething) {
    const CasterExtent ball = ball_at(Vec3d(1, 0, 1), 1);
    const ResolvedLight sun = sun_along(Vec3(1, 0, -1));
    EXPECT_EQ(left_out({floor_of_20, ball, ball_at(Vec3d(0, 0, -1), 0.5)}, sun), 0u);
    CasterExtent lower = floor_of_20;
    lower.box = Box3d(Vec3d(-40, -40, -0.1), Vec3d(40, 40, -0.1));
    for (FacePlane& plane : lower.planes) plane.offset = -0.1 * plane.normal.z();
    // The lower one alone.
    EXPECT_EQ(left_out({floor_of_20, ball, lower}, sun), 1u);
    EXPECT_EQ(left_out({floor_of_20, ball}, sun, FacePlane{Vec3d(0, 0, 1), -1e-3}), 1u);
    EXPECT_EQ(left_out({floor_of_20, ball}, sun, FacePlane{Vec3d(0, 0, 1), -1}), 0u);
    EXPECT_EQ(left_out({floor_of_20, ball}, sun, FacePlane{Vec3d(1, 0, 0), 0}), 0u);
}

// A sheet just below it that is seen beyond its edge, small as it is.
TEST(UsefulCasters, KeepAFloorAboveASheet) {
    const CasterExtent sheet{Box3d(Vec3d(6, -4, -0.1), Vec3d(14, 4, -0.1)), 0, {}};
    EXPECT_EQ(left_out({floor_of_20, ball_at(Vec3d(1, 0, 1), 1), sheet}, sun_along(Vec3(1, 0, -1))), 0u);
}

// A small card above the ground is no floor, however large the rest is.
TEST(UsefulCasters, KeepACardAboveTheGround) {
    const CasterExtent card = extent_of(facing_square(0.25f));
    const CasterExtent mountain{Box3d(Vec3d(10, -500, 0), Vec3d(1000, 500, 100)), 0, {}};
    EXPECT_EQ(left_out({card, mountain}, sun_along(Vec3(1, 0, -1)), FacePlane{Vec3d(0, 0, 1), -0.1}), 0u);
}

// Balls that are drawn around points reach below the floor as those of meshes do.
TEST(UsefulCasters, KeepAFloorWithinLargePoints) {
    const CasterExtent point{Box3d(Vec3d::Zero(), Vec3d::Zero()), 1, {}};
    EXPECT_EQ(left_out({floor_of_20, point}, sun_along(Vec3(1, 0, -1))), 0u);
    const CasterExtent small{Box3d(Vec3d(-3, -3, 0), Vec3d(3, 3, 3)), 0.01, {}};
    EXPECT_EQ(left_out({floor_of_20, small}, sun_along(Vec3(1, 0, -1))), 1u);
}

// What stands on a floor is seldom placed to the last digit; a half of it below is another matter.
TEST(UsefulCasters, MaySinkIn) {
    const ResolvedLight sun = sun_along(Vec3(1, 0, -1));
    EXPECT_EQ(left_out({floor_of_20, ball_at(Vec3d(1, 0, 0.99), 1)}, sun), 1u);
    EXPECT_EQ(left_out({floor_of_20, ball_at(Vec3d(1, 0, 0), 1)}, sun), 0u);
}

// The walls of a room of boxes hide nothing from a lamp within; the sun they keep out.
TEST(UsefulCasters, LeaveOutWallsAroundALamp) {
    std::vector<CasterExtent> casters{ball_at(Vec3d::Zero(), 0.5)};
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 size = Vec3::Constant(10);
            size[axis] = 0.2f;
            Mesh wall = make_box(size);
            CasterExtent extent = extent_of(wall);
            const Vec3d shift = 5.1 * side * Vec3d::Unit(axis);
            extent.box.translate(shift);
            for (FacePlane& plane : extent.planes) plane.offset += plane.normal.dot(shift);
            casters.push_back(extent);
        }
    EXPECT_EQ(left_out(casters, lamp_at(Vec3(1, 2, 3))), 6u);
    EXPECT_EQ(left_out(casters, sun_along(Vec3(1, 2, -3))), 0u);
}

// A sheet 0.1 above a floor that is 4000 times as wide as its shadow keeps it: of the light along (1, 0, -1)
// the part from 0.25 to 0.35 is seen. Pixels are 0.022 wide.
TEST(UsefulCasters, FloorsTakeNoTexels) {
    Material matt;
    matt.base_color = Vec3::Constant(0.5f);
    matt.roughness = 1;
    Mesh sheet = facing_square(0.25f, matt);
    sheet.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.1)));
    for (const bool native : {true, false}) {
        Scene scene;
        scene.show(facing_square(200, matt), "floor");
        scene.show(sheet, "sheet");
        scene.set_light("sun", directional(Vec3(1, 0, -1)));
        app::Session session = plain_session(scene, 32);
        session.allow_native_shading(native);
        session.settings().shadows.enabled = true;
        look_from(session, Vec3d(0, 0, 4), 10);
        const Image image = render_linear(session);
        EXPECT_LT(image.at<float>(29, 16)[0], 0.01) << native;
        EXPECT_GT(image.at<float>(2, 16)[0], 0.1) << native;
    }
}

// Lights of one direction need different maps where their penumbrae differ.
TEST(UsefulCasters, LightsOfOneDirectionKeepTheirMaps) {
    Mesh sheet = facing_square(0.25f);
    sheet.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.1)));
    const auto picture = [&](bool hard, bool soft) {
        Scene scene;
        scene.show(facing_square(4), "floor");
        scene.show(sheet, "sheet");
        if (hard) scene.set_light("hard", directional(Vec3(1, 0, -1), 0));
        if (soft) scene.set_light("soft", directional(Vec3(1, 0, -1), 5));
        app::Session session = plain_session(scene, 32);
        session.settings().shadows.enabled = true;
        look_from(session, Vec3d(0, 0, 4), 10);
        return render_linear(session);
    };
    const Image both = picture(true, true), hard = picture(true, false), soft = picture(false, true);
    for (size_t i = 0; i < both.pixels<float>().size(); ++i)
        if (i % 4 < 3) {
            EXPECT_NEAR(both.pixels<float>()[i], hard.pixels<float>()[i] + soft.pixels<float>()[i], 1e-3f);
        }
}

// A crate of slats shows what its lid does to its bottom; closed, it shows nothing.
TEST(CasterBounds, WhatIsSeenIntoHasNoPlanes) {
    const auto planes = [](AlphaMode mode) {
        Mesh slab = make_box(Vec3(4, 4, 0.4f));
        Material material;
        material.opacity = 0.5f;
        material.alpha_mode = mode;
        slab.set_material(material);
        Scene scene;
        scene.show(slab, "slab");
        const SceneSnapshot snapshot = scene.snapshot();
        DrawItem item;
        item.object = &snapshot.objects[0];
        item.alpha = mode;
        DrawList list;
        list.items[DrawMode::mesh].push_back(item);
        DataCaches caches;
        const Primitives primitives = make_primitives(caches);
        CasterBounds bounds;
        return bounds.of(list, primitives).extents.at(0).planes.size();
    };
    EXPECT_EQ(planes(AlphaMode::opaque), 6u);
    EXPECT_EQ(planes(AlphaMode::blend), 0u);
    EXPECT_EQ(planes(AlphaMode::mask), 0u);
}

}  // namespace
}  // namespace easypbr::render::useful_casters_test
