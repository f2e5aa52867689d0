#include "easypbr/geometry/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "easypbr/core/error.h"
#include "easypbr/core/math.h"

namespace easypbr {
namespace {

Vec3d corner(const MeshData& mesh, Eigen::Index face, int k) {
    return mesh.V.row(mesh.F(face, k)).transpose().cast<double>();
}

/// Volume inside a closed, outwards oriented surface (divergence theorem).
double volume(const MeshData& mesh) {
    double sum = 0;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        sum += corner(mesh, f, 0).dot(corner(mesh, f, 1).cross(corner(mesh, f, 2))) / 6;
    return sum;
}

/// Whether every edge, by position, is used as often in one direction as in the other.
bool is_closed(const MeshData& mesh) {
    using Point = std::tuple<float, float, float>;
    std::map<std::pair<Point, Point>, int> balance;
    const auto point = [&](int v) {
        return Point(mesh.V(v, 0) + 0.0f, mesh.V(v, 1) + 0.0f, mesh.V(v, 2) + 0.0f);
    };
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const Point a = point(mesh.F(f, k)), b = point(mesh.F(f, (k + 1) % 3));
            ++balance[{a, b}];
            --balance[{b, a}];
        }
    }
    for (const auto& [edge, count] : balance)
        if (count != 0) return false;
    return true;
}

/// Smallest and mean cosine between a face's normal and the normals at its corners.
std::pair<double, double> normal_agreement(const MeshData& mesh) {
    double least = 1, sum = 0;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        const Vec3d origin = corner(mesh, f, 0);
        const Vec3d normal = (corner(mesh, f, 1) - origin).cross(corner(mesh, f, 2) - origin).normalized();
        for (int k = 0; k < 3; ++k) {
            const double cosine = normal.dot(mesh.N.row(mesh.F(f, k)).transpose().cast<double>());
            least = std::min(least, cosine);
            sum += cosine;
        }
    }
    return {least, sum / double(3 * mesh.F.rows())};
}

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

TEST(Shapes, ImpossibleSizesAreRefused) {
    EXPECT_THROW(make_sphere(0), ArgumentError);
    EXPECT_THROW(make_sphere(-1), ArgumentError);
    EXPECT_THROW(make_sphere(1, 2), ArgumentError);
    EXPECT_THROW(make_box({1, 0, 1}), ArgumentError);
    EXPECT_THROW(make_plane(std::numeric_limits<float>::quiet_NaN()), ArgumentError);
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
}  // namespace easypbr
