#include "easypbr/geometry/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::primitives_test {
namespace {

TEST(Sphere, IsClosedAndItsVerticesLieOnIt) {
    const auto sphere = make_sphere(2.5f, 48).snapshot();
    EXPECT_TRUE(is_closed(*sphere));
    for (Eigen::Index v = 0; v < sphere->V.rows(); ++v) {
        ASSERT_NEAR(sphere->V.row(v).norm(), 2.5f, 1e-6f);
        ASSERT_NEAR(sphere->N.row(v).norm(), 1, 1e-6f);
    }
    // 48 segments take away less than 1 % of 4/3 pi r^3 = 65.45 (h^2 / 3 with h = 0.131 is 0.6 %).
    EXPECT_NEAR(volume(*sphere), 65.45, 0.65);
    EXPECT_GT(normal_agreement(*sphere).first, 0.99);
}

TEST(Sphere, TextureRunsEastAndUp) {
    const auto sphere = make_sphere(1, 32).snapshot();
    for (Eigen::Index v = 0; v < sphere->V.rows(); ++v) {
        const float u = sphere->UV(v, 0), w = sphere->UV(v, 1);
        const double theta = pi * (1 - w), phi = 2 * pi * u;
        EXPECT_NEAR(sphere->V(v, 1), std::cos(theta), 1e-6);
        EXPECT_NEAR(sphere->V(v, 0), std::sin(theta) * std::sin(phi), 1e-6);
        EXPECT_NEAR(sphere->V(v, 2), std::sin(theta) * std::cos(phi), 1e-6);
    }
}

TEST(Sphere, CoarsestOneIsClosedToo) {
    EXPECT_TRUE(is_closed(*make_sphere(1, 3).snapshot()));
}

TEST(Box, IsClosedFlatAndOfItsSize) {
    const auto box = make_box({1, 2, 3}).snapshot();
    EXPECT_TRUE(is_closed(*box));
    EXPECT_NEAR(volume(*box), 6, 1e-6);
    EXPECT_EQ(normal_agreement(*box).first, 1);
    EXPECT_EQ(Vec3(box->V.colwise().maxCoeff()), Vec3(0.5f, 1, 1.5f));
    EXPECT_EQ(Vec3(box->V.colwise().minCoeff()), Vec3(-0.5f, -1, -1.5f));
}

TEST(Plane, FacesUp) {
    const auto plane = make_plane(4).snapshot();
    EXPECT_EQ(normal_agreement(*plane).first, 1);
    EXPECT_EQ(Vec3(plane->N.row(0)), Vec3::UnitY());
    EXPECT_EQ(Vec3(plane->V.colwise().maxCoeff()), Vec3(2, 0, 2));
    EXPECT_EQ(Vec3(plane->V.colwise().minCoeff()), Vec3(-2, 0, -2));
}

TEST(Plane, IsCutIntoFields) {
    const auto plane = make_plane(3, 6).snapshot();
    EXPECT_EQ(plane->V.rows(), 49);
    EXPECT_EQ(plane->F.rows(), 72);
    // Coordinates are multiples of 1/2: every area is exact.
    EXPECT_EQ(area(*plane), 9);
    EXPECT_EQ(normal_agreement(*plane).first, 1);
    EXPECT_EQ(Vec2(plane->UV.row(48)), Vec2(1, 1));
    EXPECT_EQ(Vec3(plane->V.row(48)), Vec3(1.5f, 0, -1.5f));
}

TEST(Grid, IsMadeOfLines) {
    const auto grid = make_grid(8, 4).snapshot();
    EXPECT_EQ(grid->F.rows(), 0);
    ASSERT_EQ(grid->E.rows(), 10);
    double length = 0;
    for (Eigen::Index e = 0; e < 10; ++e)
        length += (grid->V.row(grid->E(e, 0)) - grid->V.row(grid->E(e, 1))).norm();
    EXPECT_EQ(length, 80);
    EXPECT_EQ(Vec3(grid->V.colwise().maxCoeff()), Vec3(4, 0, 4));
    EXPECT_EQ(Vec3(grid->V.colwise().minCoeff()), Vec3(-4, 0, -4));
}

TEST(Icosphere, HasNearlyEqualFacesAndSharedVertices) {
    const auto ball = make_icosphere(2, 3).snapshot();
    EXPECT_EQ(ball->F.rows(), 20 * 64);
    EXPECT_EQ(ball->V.rows(), 2 + 10 * 64) << "Euler: V = 2 + F / 2";
    EXPECT_TRUE(is_closed(*ball));
    EXPECT_EQ(euler_characteristic(*ball), 2);
    EXPECT_LT((ball->V.rowwise().norm().array() - 2).abs().maxCoeff(), 3e-7f);
    EXPECT_GT(normal_agreement(*ball).first, 0.99);
    // Edges of about h = 0.15 radii take away about h^2 / 2 of 4/3 pi r^3 = 33.51: 1.2 %.
    EXPECT_NEAR(volume(*ball), 33.51, 0.42);
    // The icosahedron itself, of circumradius 1: 2.53615 (Weisstein, Regular Icosahedron).
    EXPECT_NEAR(volume(*make_icosphere(1, 0).snapshot()), 2.536150, 1e-5);
}

/// Area of a regular polygon of n corners at the distance r.
double polygon(double r, int n) {
    return n / 2.0 * r * r * std::sin(2 * pi / n);
}

TEST(Cylinder, IsAClosedPrism) {
    const auto cylinder = make_cylinder(2, 3, 24).snapshot();
    EXPECT_TRUE(is_closed(*cylinder));
    EXPECT_EQ(euler_characteristic(*cylinder), 2);
    EXPECT_NEAR(volume(*cylinder), 3 * polygon(2, 24), 1e-4) << "a prism of 24 sides, but for rounding";
    EXPECT_NEAR(area(*cylinder), 2 * polygon(2, 24) + 24 * 3 * 4 * std::sin(pi / 24), 1e-4);
    // The normals of the side are those of the round one: half a segment beside the face's.
    EXPECT_NEAR(normal_agreement(*cylinder).first, std::cos(pi / 24), 1e-6);
    EXPECT_EQ(Vec3(cylinder->V.colwise().maxCoeff()).y(), 1.5f);
    EXPECT_EQ(cylinder->UV.col(1).maxCoeff(), 1);
    EXPECT_EQ(cylinder->UV.col(1).minCoeff(), 0);
}

TEST(Cone, IsAClosedPyramid) {
    const auto cone = make_cone(2, 3, 24).snapshot();
    EXPECT_TRUE(is_closed(*cone));
    EXPECT_EQ(euler_characteristic(*cone), 2);
    EXPECT_NEAR(volume(*cone), polygon(2, 24), 1e-4);
    EXPECT_EQ(Vec3(cone->V.row(0)), Vec3(0, 1.5f, 0));
    // The side's normal leans up by atan(2 / 3).
    EXPECT_NEAR(cone->N(0, 1), 2 / std::sqrt(13.0), 1e-6);
    EXPECT_GT(normal_agreement(*cone).first, std::cos(pi / 24) - 1e-6);
}

TEST(Torus, IsARing) {
    const auto torus = make_torus(2, 0.5f, 96, 48).snapshot();
    EXPECT_TRUE(is_closed(*torus));
    EXPECT_EQ(euler_characteristic(*torus), 0);
    // A horizontal cut is the difference of two polygons of 96 corners, n / 2 sin(2 pi / n) (a^2 - b^2); over
    // all heights that is n sin(2 pi / n) R times the area of the tube's section.
    EXPECT_NEAR(volume(*torus), 96 * std::sin(2 * pi / 96) * 2 * polygon(0.5, 48), 1e-5);
    // 4 pi^2 R r = 39.48, less at most h^2 / 8 for each of the chords: 0.27 %.
    EXPECT_NEAR(area(*torus), 39.48, 0.0027 * 39.48);
    EXPECT_GT(normal_agreement(*torus).first, 0.99);
    EXPECT_NEAR(torus->V.col(0).maxCoeff(), 2.5, 1e-6);
    EXPECT_NEAR(torus->V.col(1).maxCoeff(), 0.5, 1e-6);
}

TEST(Capsule, IsACylinderBetweenHalfSpheres) {
    const auto capsule = make_capsule(1, 2, 96).snapshot();
    EXPECT_TRUE(is_closed(*capsule));
    EXPECT_EQ(euler_characteristic(*capsule), 2);
    // 4/3 pi + 2 pi = 10.472, less at most h^2 / 3 = 0.14 %.
    EXPECT_NEAR(volume(*capsule), 10.472, 0.0014 * 10.472);
    EXPECT_EQ(Vec3(capsule->V.colwise().maxCoeff()).y(), 2);
    EXPECT_EQ(Vec3(capsule->V.colwise().minCoeff()).y(), -2);
    EXPECT_GT(normal_agreement(*capsule).first, 0.99);
}

TEST(Arrow, GoesFromOnePointToTheOther) {
    const Vec3 from(1, 2, 3), to(1, -2, 0);  // length 5
    const auto arrow = make_arrow(from, to, 0.25f).snapshot();
    EXPECT_TRUE(is_closed(*arrow));
    EXPECT_EQ(euler_characteristic(*arrow), 2);
    EXPECT_LT((Vec3(arrow->V.row(0)) - to).norm(), 1e-6f);
    // Head: 1.5 long, 0.625 wide; shaft: 3.5 long.
    EXPECT_NEAR(volume(*arrow), 3.5 * polygon(0.25, 32) + 1.5 / 3 * polygon(0.625, 32), 1e-5);
    const Vec3 axis = (to - from) / 5;
    const Eigen::VectorXf along = (arrow->V.rowwise() - from.transpose()) * axis;
    EXPECT_NEAR(along.minCoeff(), 0, 1e-6);
    EXPECT_NEAR(along.maxCoeff(), 5, 1e-6);
    // Straight down, where the turn from +y has no axis of its own.
    EXPECT_GT(volume(*make_arrow(Vec3(0, 1, 0), Vec3(0, -1, 0)).snapshot()), 0);
}

TEST(Axes, AreRedGreenAndBlue) {
    const auto axes = make_axes(2).snapshot();
    EXPECT_NO_THROW(validate(*axes));
    EXPECT_TRUE(axes->parts.empty());
    for (int axis = 0; axis < 3; ++axis) {
        Eigen::Index tip = 0, strongest = 0;
        EXPECT_NEAR(axes->V.col(axis).maxCoeff(&tip), 2, 1e-6);
        axes->C.row(tip).maxCoeff(&strongest);
        EXPECT_EQ(strongest, axis);
    }
}

TEST(Shapes, ImpossibleSizesAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusal([] { make_sphere(0); }), "sphere: radius: expected a number > 0, got 0");
    EXPECT_EQ(refusal([] { make_sphere(1, 2); }),
              "sphere: segments: expected a whole number from 3 to 8192, got 2");
    EXPECT_THROW(make_sphere(-1), ArgumentError);
    EXPECT_THROW(make_icosphere(nan), ArgumentError);
    EXPECT_THROW(make_icosphere(1, -1), ArgumentError);
    EXPECT_THROW(make_icosphere(1, 11), ArgumentError);
    EXPECT_THROW(make_box({1, 0, 1}), ArgumentError);
    EXPECT_THROW(make_plane(nan), ArgumentError);
    EXPECT_THROW(make_plane(1, 0), ArgumentError);
    EXPECT_THROW(make_grid(0), ArgumentError);
    EXPECT_THROW(make_grid(1, 0), ArgumentError);
    EXPECT_THROW(make_cylinder(0, 1), ArgumentError);
    EXPECT_THROW(make_cylinder(1, nan), ArgumentError);
    EXPECT_THROW(make_cylinder(1, 1, 2), ArgumentError);
    EXPECT_THROW(make_cone(1, 0), ArgumentError);
    EXPECT_THROW(make_cone(nan, 1), ArgumentError);
    EXPECT_THROW(make_capsule(1, -1), ArgumentError);
    EXPECT_THROW(make_torus(1, 0), ArgumentError);
    EXPECT_NE(refusal([] { make_torus(1, 1); }).find("below the radius 1, got 1"), std::string::npos);
    EXPECT_THROW(make_arrow({1, 1, 1}, {1, 1, 1}), ArgumentError);
    EXPECT_THROW(make_arrow({0, 0, 0}, {nan, 1, 1}), ArgumentError);
    EXPECT_THROW(make_arrow({0, 0, 0}, {1, 1, 1}, 0.0f), ArgumentError);
    EXPECT_THROW(make_axes(0), ArgumentError);
    EXPECT_THROW(make_axes(1, nan), ArgumentError);
    EXPECT_THROW(make_teapot(0), ArgumentError);
    EXPECT_THROW(make_teapot(1, 0), ArgumentError);
}

TEST(Teapot, HasThirtyTwoPatchesOfTheAskedSize) {
    const auto teapot = make_teapot(3.15f, 8).snapshot();
    EXPECT_EQ(teapot->V.rows(), 32 * 81);
    // 4 knob and 4 bottom patches have 8 triangles less each at their poles.
    EXPECT_EQ(teapot->F.rows(), 32 * 128 - 8 * 8);
    // In Newell's units: from z = 0 to the knob's 3.15; the handle ends at x = -3 (its middle control points'
    // t = 1), the body's belly is a Bezier quarter circle of radius 2 at the patches' common edge t = 1 (z =
    // 0.9).
    const Vec3 low = teapot->V.colwise().minCoeff(), high = teapot->V.colwise().maxCoeff();
    EXPECT_EQ(low.y(), 0);
    EXPECT_FLOAT_EQ(high.y(), 3.15f);
    EXPECT_FLOAT_EQ(low.x(), -3);
    EXPECT_FLOAT_EQ(low.z(), -2);
    EXPECT_FLOAT_EQ(high.z(), 2);
    EXPECT_GT(high.x(), 3.4f);
    EXPECT_LT(high.x(), 3.525f);
}

TEST(Teapot, KnownPointsOfTheSurface) {
    // The lip of the spout at s = t = 1 of its last patch is the control point (3.2, 2.4); the handle's top
    // at its start
    // (-1.5, 2.25); the spout's tip at the end of the first spout patch (3.3, 2.4). The belly's quarter
    // circle at s = 1/2 is (1 + 3 * 0.56 ... ) / 8: 2 * (3 * 0.56 + 3 + 1) / 8 = 1.42 in x and z.
    const auto teapot = make_teapot(3.15f, 8).snapshot();
    for (const Vec3& point :
         {Vec3(3.2f, 2.4f, 0), Vec3(-1.5f, 2.25f, 0), Vec3(3.3f, 2.4f, 0), Vec3(1.42f, 0.9f, 1.42f)})
        EXPECT_LT((teapot->V.rowwise() - point.transpose()).rowwise().norm().minCoeff(), 1e-5f)
            << point.transpose();
}

TEST(Teapot, NormalsPointOutwardsAndAreExact) {
    const auto teapot = make_teapot(1, 32).snapshot();
    const auto [least, mean] = normal_agreement(*teapot);
    EXPECT_GT(least, 0) << "a face is wound the wrong way";
    EXPECT_GT(mean, 0.995);
    EXPECT_LT((teapot->N.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-5f);
    // The body is a surface of revolution but for the Bezier circle's error: normals at radius > 0.6 (belly)
    // are radial in the horizontal plane to within a degree and a half.
    for (Eigen::Index v = 0; v < teapot->V.rows(); ++v) {
        const Eigen::Vector2f radial(teapot->V(v, 0), teapot->V(v, 2)),
            normal(teapot->N(v, 0), teapot->N(v, 2));
        if (v < 8 * 33 * 33 && v >= 4 * 33 * 33) {
            ASSERT_GT(radial.normalized().dot(normal.normalized()), std::cos(radians(1.5))) << v;
        }
    }
}

TEST(Teapot, PolesHaveTheAxisAsNormal) {
    const auto teapot = make_teapot(1, 4).snapshot();
    int poles = 0;
    for (Eigen::Index v = 0; v < teapot->V.rows(); ++v) {
        if (teapot->V(v, 0) != 0 || teapot->V(v, 2) != 0) continue;
        ++poles;
        const Vec3 axis = teapot->V(v, 1) > 0.5f ? Vec3::UnitY() : Vec3(-Vec3::UnitY());
        EXPECT_LT((teapot->N.row(v).transpose() - axis).norm(), 1e-6f);
    }
    EXPECT_EQ(poles, 2 * 4 * 5);
}

TEST(DemoScene, ShowsTeapotsAndSpheresOnAFloor) {
    const SceneSnapshot scene = make_demo_scene().snapshot();
    ASSERT_EQ(scene.objects.size(), 9u);
    std::set<std::string> materials;
    for (const auto& object : scene.objects) {
        ASSERT_EQ(object.mesh->materials.size(), 1u) << object.name;
        materials.insert(object.mesh->materials[0].name);
        if (object.name == "floor") continue;
        // Everything else stands on the floor (within the poses' rounding) and inside its circle.
        float lowest = 1, farthest = 0;
        for (Eigen::Index v = 0; v < object.mesh->V.rows(); ++v) {
            const Vec3d p = object.T_world_mesh * object.mesh->V.row(v).transpose().cast<double>();
            lowest = std::min(lowest, float(p.y()));
            farthest = std::max(farthest, float(std::hypot(p.x(), p.z())));
        }
        EXPECT_NEAR(lowest, 0, 1e-6) << object.name;
        EXPECT_LT(farthest, 3.5) << object.name;
        EXPECT_GT(normal_agreement(*object.mesh).second, 0.99) << object.name;
    }
    EXPECT_EQ(materials.size(), 9u);
}

}  // namespace
}  // namespace easypbr::primitives_test
