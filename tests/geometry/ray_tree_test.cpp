#include "easypbr/geometry/rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <utility>

#include "easypbr/geometry/place.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/mesh.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::ray_tree_test {
namespace {

using Rows3 = Array3d::Dense;
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Sums of some products of numbers of about 1 in double precision.
constexpr double exact = 1e-13;

Rows3 rows_of(std::initializer_list<Vec3d> vectors) {
    Rows3 rows(Eigen::Index(vectors.size()), 3);
    Eigen::Index i = 0;
    for (const Vec3d& vector : vectors) rows.row(i++) = vector.transpose();
    return rows;
}

Rows3 random_rows(int count, unsigned seed, double reach = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-reach, reach);
    Rows3 rows(count, 3);
    for (double& value : rows.reshaped()) value = uniform(random);
    return rows;
}

/// Moeller and Trumbore 1997; infinity: none is met. Faces count when the ray passes `inside` of their edges.
double distance_by_trying_all(const MeshData& mesh, const Vec3d& from, const Vec3d& direction,
                              double inside) {
    double nearest = infinity;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        const Vec3d a = corner(mesh, f, 0), e1 = corner(mesh, f, 1) - a, e2 = corner(mesh, f, 2) - a;
        const Vec3d p = direction.cross(e2);
        const double determinant = e1.dot(p);
        if (determinant == 0) continue;
        const double u = (from - a).dot(p) / determinant;
        const Vec3d q = (from - a).cross(e1);
        const double v = direction.dot(q) / determinant, t = e2.dot(q) / determinant;
        if (u >= inside && v >= inside && u + v <= 1 - inside && t >= 0) nearest = std::min(nearest, t);
    }
    return nearest;
}

/// A ball of faces that share their vertices.
std::shared_ptr<const MeshData> ball(float radius = 1, int subdivisions = 3) {
    return make_icosphere(radius, subdivisions).snapshot();
}

Mesh joined(const std::vector<Mesh>& meshes) {
    return merged(meshes);
}

Mesh placed(Mesh mesh, const Vec3d& at) {
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(at)));
    return mesh;
}

TEST(RayTree, MeetsABoxWhereItsFacesAre) {
    const RayTree tree(make_box());
    const Rows3 origins = rows_of({{0.1, 0.2, 5}, {0.1, 0.2, 0.3}, {0.1, 0.2, 5}, {0.6, 0, 5}});
    // The direction's length does not count.
    const Rows3 directions = rows_of({{0, 0, -3}, {0.01, 0, 0}, {0, 0, 1}, {0, 0, -1}});
    const RayTree::Hits hits = tree.cast(origins, directions);
    EXPECT_NEAR(hits.distances[0], 4.5, exact);
    EXPECT_NEAR(hits.distances[1], 0.4, exact);
    EXPECT_LT((hits.points[0] - Vec3d(0.1, 0.2, 0.5)).norm(), exact);
    EXPECT_LT((hits.normals[0] - Vec3d::UnitZ()).norm(), exact);
    // From inside, too, normals look outside.
    EXPECT_LT((hits.normals[1] - Vec3d::UnitX()).norm(), exact);
    for (const size_t i : {2, 3}) {
        EXPECT_EQ(hits.distances[i], infinity);
        EXPECT_EQ(hits.faces[i], -1);
        EXPECT_TRUE(hits.points[i].array().isNaN().all());
    }
    const auto box = make_box().snapshot();
    for (const size_t i : {0, 1}) {
        Vec3d point = Vec3d::Zero();
        for (int k = 0; k < 3; ++k) point += hits.barycentric[i][k] * corner(*box, hits.faces[i], k);
        EXPECT_LT((point - hits.points[i]).norm(), exact);
    }
    EXPECT_EQ(tree.face_count(), 12);
}

TEST(RayTree, EndsAtTheLargestDistance) {
    const RayTree tree(make_box());
    const Rows3 from = rows_of({{0, 0, 4.5}}), direction = rows_of({{0, 0, -2}});
    EXPECT_GE(tree.cast(from, direction, 4).faces[0], 0) << "4.5 - 0.5, exact in binary";
    EXPECT_EQ(tree.cast(from, direction, 3.999).faces[0], -1);
    EXPECT_EQ(tree.cast(from, direction, 3.999).distances[0], infinity);
}

TEST(RayTree, MeetsASphereAsFarAsItsTessellation) {
    const auto sphere = ball(1, 5);
    const RayTree tree(*sphere);
    double below = 0;
    for (Eigen::Index f = 0; f < sphere->F.rows(); ++f)
        below = std::max(below, 1 - corner(*sphere, f, 0).dot(area_vector(*sphere, f).normalized()));
    const Rows3 origins = 3 * random_rows(500, 1).rowwise().normalized(), targets = random_rows(500, 2, 0.4);
    const RayTree::Hits hits = tree.cast(origins, targets - origins);
    for (size_t i = 0; i < 500; ++i) {
        const Vec3d o = origins.row(Eigen::Index(i)).transpose();
        const Vec3d d = (targets.row(Eigen::Index(i)).transpose() - o).normalized();
        const double b = o.dot(d), distance = -b - std::sqrt(b * b - o.squaredNorm() + 1);
        // Faces are between two spheres. Rays pass the centre at 0.4 sqrt(3) at most: the cosine is 0.72 or
        // more.
        ASSERT_LE(hits.distances[i], distance + below / 0.7);
        // Vertices are float32.
        ASSERT_GE(hits.distances[i], distance - 1e-7 / 0.7);
        ASSERT_GT(hits.normals[i].dot(hits.points[i]), 0.99);
    }
}

TEST(RayTree, MeetsWhatTryingAllMeets) {
    const auto torus = make_torus(1, 0.4f, 24, 12).snapshot();
    const Rows3 origins = random_rows(2000, 3, 1.6), directions = random_rows(2000, 4);
    const RayTree::Hits hits = RayTree(*torus).cast(origins, directions);
    int met = 0;
    for (size_t i = 0; i < 2000; ++i) {
        const Vec3d from = origins.row(Eigen::Index(i)).transpose();
        const Vec3d direction = directions.row(Eigen::Index(i)).transpose().normalized();
        const double least = distance_by_trying_all(*torus, from, direction, -1e-12),
                     strict = distance_by_trying_all(*torus, from, direction, 1e-12);
        // Random rays do not come so near to an edge.
        ASSERT_EQ(least, strict);
        if (least == infinity) {
            ASSERT_EQ(hits.faces[i], -1);
            continue;
        }
        ++met;
        // 1e-16 of coordinates of 1, divided by the cosine of grazing rays, of at least 1e-3.
        ASSERT_NEAR(hits.distances[i], least, 1e-11);
        ASSERT_LT((from + hits.distances[i] * direction - hits.points[i]).norm(), 1e-11);
    }
    EXPECT_GT(met, 400);
}

/// Places on vertices and edges of a mesh.
std::vector<Vec3d> seams_of(const MeshData& mesh) {
    std::vector<Vec3d> places;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec3d a = corner(mesh, f, k), b = corner(mesh, f, (k + 1) % 3);
            places.push_back(a);
            places.push_back((a + b) / 2);
            places.push_back(a + 0.3 * (b - a));
        }
    return places;
}

TEST(RayTree, LetsNoRayOutThroughVerticesAndEdges) {
    for (const auto& mesh : {ball(1, 3), make_box().snapshot(), make_cylinder(0.5f, 1, 16).snapshot()}) {
        const std::vector<Vec3d> targets = seams_of(*mesh);
        const RayTree tree(*mesh);
        for (const Vec3d& from : {Vec3d(0, 0, 0), Vec3d(0.1, 0, 0), Vec3d(0.013, -0.21, 0.17)}) {
            Rows3 directions(Eigen::Index(targets.size()), 3);
            for (size_t i = 0; i < targets.size(); ++i)
                directions.row(Eigen::Index(i)) = (targets[i] - from).transpose();
            const RayTree::Hits hits = tree.cast(Rows3(from.transpose()), directions);
            for (size_t i = 0; i < targets.size(); ++i)
                // The ray leaves a convex body where it is aimed at.
                ASSERT_NEAR(hits.distances[i], (targets[i] - from).norm(), 1e-12) << i;
        }
    }
}

TEST(RayTree, CountsWindingsThroughVerticesAndEdgesExactly) {
    const auto mesh = ball(1, 2);
    const RayTree tree(*mesh);
    const std::vector<Vec3d> seams = seams_of(*mesh);
    // Counted along z: the rays of all three points pass the seam, or end before it. Within 0.9 of the axis
    // the middle is inside, for the faces are nowhere below 0.95.
    for (const Vec3d& seam : seams) {
        const double middle = seam.head<2>().norm();
        const auto inside = tree.contains(
            rows_of({{seam.x(), seam.y(), 0}, {seam.x(), seam.y(), -2}, {seam.x(), seam.y(), 2}}));
        EXPECT_EQ(inside[1], 0);
        EXPECT_EQ(inside[2], 0);
        if (middle < 0.9) {
            EXPECT_EQ(inside[0], 1) << seam.transpose();
        }
    }
}

TEST(RayTree, ContainsWhatIsInside) {
    const Rows3 points = random_rows(3000, 5, 1.5);
    const auto inside = RayTree(make_torus(1, 0.4f, 64, 32)).contains(points);
    for (size_t i = 0; i < inside.size(); ++i) {
        const Vec3d p = points.row(Eigen::Index(i)).transpose();
        const double from_ring = std::hypot(std::hypot(p.x(), p.z()) - 1, p.y());
        // Chords of 64 and 32 parts are 1.4 (1 - cos(pi / 64)) + 0.4 (1 - cos(pi / 32)) = 0.0036 off at most.
        if (std::abs(from_ring - 0.4) > 0.0037) {
            ASSERT_EQ(inside[i], from_ring < 0.4) << p.transpose();
        }
    }
}

TEST(RayTree, ContainsCountsBodiesThatOverlapAndHollowOnes) {
    const Mesh one = make_icosphere(1, 2), other = placed(make_icosphere(1, 2), {1, 0, 0});
    const Rows3 points = rows_of({{-0.5, 0, 0}, {0.5, 0, 0}, {1.5, 0, 0}, {2.5, 0, 0}});
    EXPECT_EQ(RayTree(joined({one, other})).contains(points), (std::vector<uint8_t>{1, 1, 1, 0}));
    MeshData hollow = *make_icosphere(0.5f, 2).snapshot();
    hollow.F = Array3i::Dense(hollow.F.rowwise().reverse());
    const RayTree shell(joined({make_icosphere(1, 2), Mesh(hollow)}));
    EXPECT_EQ(shell.contains(rows_of({{0, 0, 0}, {0.7, 0, 0}})), (std::vector<uint8_t>{0, 1}));
    EXPECT_EQ(RayTree(hollow).contains(rows_of({{0, 0, 0}})), (std::vector<uint8_t>{1}))
        << "wound the other way round";
}

TEST(RayTree, OccludedSegmentsHaveAFaceBetweenTheirEnds) {
    const RayTree tree(make_plane(2));
    const Rows3 from = rows_of({{0.1, 1, 0.2}, {0.1, 1, 0.2}, {5, 1, 0}, {0.3, 0, 0.1}, {0, 0, 0}});
    const Rows3 to = rows_of({{0.2, -1, 0.3}, {0.2, 0.5, 0.3}, {5, -1, 0}, {0, 3, 0}, {0, 0, 0}});
    EXPECT_EQ(tree.occluded(from, to), (std::vector<uint8_t>{1, 0, 0, 0, 0}));
    EXPECT_EQ(tree.occluded(to, from), (std::vector<uint8_t>{1, 0, 0, 0, 0}));
    // Ends that go beyond the face by more than touch_part of the diagonal, 2 sqrt(2).
    const Rows3 above = rows_of({{0, 1, 0}});
    EXPECT_EQ(tree.occluded(above, rows_of({{0, -2e-6, 0}, {0, -4e-6, 0}})), (std::vector<uint8_t>{0, 1}));
}

// Doubled faces are at the same distance to the last bit, whichever corner is their first and however they
// are wound.
TEST(RayTree, MeetsTheFirstOfFacesWithTheSameCorners) {
    const auto single = ball();
    const Eigen::Index count = single->F.rows();
    for (const auto& order :
         std::array<std::array<int, 3>, 4>{{{1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}}}) {
        MeshData doubled = *single;
        Array3i::Dense F(2 * count, 3);
        F.topRows(count) = single->F;
        for (int k = 0; k < 3; ++k) F.block(count, k, count, 1) = single->F.col(order[size_t(k)]);
        doubled.F = std::move(F);
        const Rows3 origins = random_rows(2000, 8, 1.5), directions = random_rows(2000, 9);
        const RayTree::Hits expected = RayTree(*single).cast(origins, directions);
        const RayTree::Hits hits = RayTree(doubled).cast(origins, directions);
        EXPECT_EQ(hits.faces, expected.faces) << order[0] << order[1];
        EXPECT_EQ(hits.distances, expected.distances) << order[0] << order[1];
    }
}

TEST(RayTree, IsOfAMeshWithItsPosesAndChildrenInTheOrderOfMerged) {
    Mesh parent = placed(make_box(), {10, 0, 0});
    parent.add_child(placed(make_box(), {0, 0, 3}));
    const RayTree tree(parent);
    const Mesh whole = joined({parent});
    ASSERT_EQ(tree.face_count(), whole.F().rows());
    const RayTree::Hits hits = tree.cast(rows_of({{10, 0, 9}, {10, 0, -9}, {0, 0, 9}}),
                                         rows_of({{0, 0, -1}, {0, 0, 1}, {0, 0, -1}}));
    EXPECT_NEAR(hits.distances[0], 9 - 3.5, exact);
    EXPECT_NEAR(hits.distances[1], 9 - 0.5, exact);
    EXPECT_EQ(hits.distances[2], infinity);
    EXPECT_GE(hits.faces[0], 12) << "the child's";
    EXPECT_LT(hits.faces[1], 12);
    EXPECT_EQ(RayTree(*parent.snapshot()).face_count(), 12);
}

TEST(RayTree, IsExactFarFromZero) {
    const Vec3d utm(500000, 5400000, 300);
    Mesh box = make_box();
    box.set_offset(utm);
    const RayTree tree(box);
    const RayTree::Hits hits = tree.cast(rows_of({utm + Vec3d(0.1, 0.2, 5)}), rows_of({{0, 0, -1}}));
    // Coordinates of 5.4e6 are 2^-30 = 9.3e-10 apart; x, y and z are rounded by half of it.
    EXPECT_NEAR(hits.distances[0], 4.5, 1e-9);
    EXPECT_LT((hits.points[0] - utm - Vec3d(0.1, 0.2, 0.5)).norm(), 2e-9);
    EXPECT_EQ(tree.contains(rows_of({utm, utm + Vec3d(0.501, 0, 0)})), (std::vector<uint8_t>{1, 0}));
    EXPECT_EQ(tree.occluded(rows_of({utm + Vec3d(2, 0, 0)}), rows_of({utm - Vec3d(2, 0, 0)})),
              (std::vector<uint8_t>{1}));
}

TEST(RayTree, SaysTheSameOnAnyNumberOfThreads) {
    const RayTree tree(make_torus());
    const Rows3 origins = random_rows(5000, 6, 1.5), directions = random_rows(5000, 7);
    const char* given = std::getenv("EASYPBR_THREADS");
    const std::string before = given ? given : "";
    ::setenv("EASYPBR_THREADS", "1", 1);
    const RayTree::Hits alone = tree.cast(origins, directions);
    given ? ::setenv("EASYPBR_THREADS", before.c_str(), 1) : ::unsetenv("EASYPBR_THREADS");
    const RayTree::Hits hits = tree.cast(origins, directions);
    EXPECT_EQ(hits.distances, alone.distances);
    EXPECT_EQ(hits.faces, alone.faces);
}

TEST(RayTree, OneRowStandsForAllAndNoneForNothing) {
    const RayTree tree(make_box());
    const Rows3 one = rows_of({{0, 0, 2}}), two = rows_of({{0, 0, -1}, {0, 0, 1}});
    EXPECT_EQ(tree.cast(one, two).distances, (std::vector<double>{1.5, infinity}));
    EXPECT_EQ(tree.cast(two, one).distances, (std::vector<double>{0.5, infinity}));
    EXPECT_EQ(tree.occluded(one, two).size(), 2u);
    for (const Array3d& rows : {Array3d(), Array3d(one)})
        EXPECT_TRUE(tree.cast(Array3d(), rows).faces.empty());
    EXPECT_TRUE(tree.occluded(Array3d(), Array3d()).empty());
    EXPECT_TRUE(tree.contains(Array3d()).empty());
}

TEST(RayTree, IsThereAfterItWasMovedFrom) {
    RayTree tree(make_box());
    const RayTree taken = std::move(tree);
    EXPECT_EQ(tree.face_count(), taken.face_count());
}

TEST(RayTree, RefusesWhatHasNoAnswer) {
    MeshData cloud;
    cloud.name = "cloud";
    cloud.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(refusal([&] { RayTree{cloud}; }),
              "rays: expected a mesh with faces, got 'cloud' with 2 vertices and 0 faces");
    EXPECT_THROW(visible_vertices(Mesh(cloud), Vec3d(0, 0, 0)), ArgumentError);
    for (const int32_t index : {-1, 2}) {
        MeshData torn = cloud;
        torn.F = Array3i::Dense{{0, 1, index}};
        EXPECT_THROW(RayTree{torn}, ArgumentError) << index;
    }
    const RayTree tree(make_box());
    const Rows3 one = rows_of({{0, 0, 1}}), two = rows_of({{0, 0, 1}, {0, 0, 2}}),
                three = rows_of({{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}), no_number = rows_of({{0, NAN, 0}});
    EXPECT_EQ(refusal([&] { tree.cast(three, two); }),
              "rays: origins and directions: expected as many rows of both, or one of either, got 3 and 2");
    EXPECT_EQ(refusal([&] {
                  tree.cast(two, rows_of({{0, 0, 1}, {0, 0, 0}}));
              }),
              "rays: expected directions other than zero, got zero in row 1 of 2");
    EXPECT_EQ(refusal([&] { tree.cast(no_number, one); }),
              "rays: expected finite origins, got (0, nan, 0) in row 0 of 1");
    EXPECT_THROW(tree.cast(one, no_number), ArgumentError);
    EXPECT_THROW(tree.cast(one, one, -1), ArgumentError);
    EXPECT_THROW(tree.cast(one, one, NAN), ArgumentError);
    EXPECT_THROW(tree.occluded(one, no_number), ArgumentError);
    EXPECT_THROW(tree.occluded(three, two), ArgumentError);
    EXPECT_THROW(tree.contains(no_number), ArgumentError);
    EXPECT_THROW(visible_vertices(make_box(), Vec3d(NAN, 0, 0)), ArgumentError);
    EXPECT_THROW(visible_vertices(make_box(), Camera(), Vec2i(0, 5)), ArgumentError);
    EXPECT_EQ(refusal([&] { visible_vertices(make_box(), Camera(), {}, {}, 0.0); }),
              "camera: near: expected a number > 0, got 0");
}

TEST(RayTree, TakesRaysOfAnyLength) {
    const RayTree tree(make_box());
    // Squares of these are neither finite nor above 0.
    const RayTree::Hits hits =
        tree.cast(rows_of({{0, 0, 2}}), rows_of({{0, 0, -1e300}, {0, 0, -1e-300}, {1e-300, 0, -1}}));
    EXPECT_EQ(hits.distances, (std::vector<double>{1.5, 1.5, 1.5}));
}

/// Of a box, those on a face that looks at the point.
std::vector<uint8_t> facing_vertices(const MeshData& box, const Vec3d& from) {
    std::vector<uint8_t> seen;
    for (Eigen::Index v = 0; v < box.V.rows(); ++v) {
        bool looks = false;
        for (int axis = 0; axis < 3; ++axis) {
            const double side = box.V(v, axis) > 0 ? 1 : -1;
            looks |= side * from[axis] > 0.5;
        }
        seen.push_back(looks);
    }
    return seen;
}

TEST(VisibleVertices, OfABoxAreThoseOfTheFacesThatLookAtThePoint) {
    const Mesh box = make_box();
    for (const Vec3d& from : {Vec3d(5, 0.2, 0.1), Vec3d(5, 3, 0.1), Vec3d(5, 3, -4), Vec3d(0.6, -0.6, 0.6)})
        EXPECT_EQ(visible_vertices(box, from), facing_vertices(*box.snapshot(), from)) << from.transpose();
    EXPECT_EQ(visible_vertices(box, Vec3d(0.1, 0.2, 0.1)), std::vector<uint8_t>(size_t(box.V().rows()), 1));
}

TEST(VisibleVertices, OfAChildAreThoseThatTheParentDoesNotHide) {
    Mesh wall = make_plane(10);  // y is up
    wall.add_child(placed(make_plane(1), {0, -1, 0}));
    const std::vector<uint8_t> seen = visible_vertices(wall, Vec3d(0, 5, 0));
    EXPECT_EQ(seen, (std::vector<uint8_t>{1, 1, 1, 1, 0, 0, 0, 0}));
}

TEST(VisibleVertices, OfACameraLieInItsPicture) {
    // Vertices at whole numbers from -2 to 2, seen from 2 above: half of the picture's height shows 1.2
    // there, half of its width 2.4.
    const Mesh plane = make_plane(4, 4);
    Camera camera = Camera::look_at({0, 2, 0}, {0, 0, 0}, {0, 0, -1});
    camera.fov_y_deg = degrees(2 * std::atan(1.2 / 2));
    const std::vector<uint8_t> seen = visible_vertices(plane, camera, Vec2i(200, 100));
    const auto V = plane.V();
    for (Eigen::Index v = 0; v < V.rows(); ++v) EXPECT_EQ(seen[size_t(v)], std::abs(V(v, 2)) < 1.2f) << v;
    EXPECT_EQ(visible_vertices(plane, camera), std::vector<uint8_t>(25, 1))
        << "without a size: all before it";
    EXPECT_EQ(visible_vertices(plane, camera, {}, {}, 2.5), std::vector<uint8_t>(25, 0));
    camera = Camera::look_at({0, 2, 0}, {0, 5, 0}, {0, 0, -1});
    EXPECT_EQ(visible_vertices(plane, camera), std::vector<uint8_t>(25, 0)) << "behind it";
}

TEST(VisibleVertices, OfAnOrthographicCameraAreSeenAlongItsAxis) {
    Mesh roof = make_plane(2, 2);  // from -1 to 1
    roof.add_child(placed(make_plane(4, 4), {0, -1, 0}));
    Camera camera = Camera::look_at({0, 3, 0}, {0, 0, 0}, {0, 0, -1});
    camera.projection = Projection::orthographic;
    camera.ortho_height = 10;
    const std::vector<uint8_t> seen = visible_vertices(roof, camera, Vec2i(100, 100));
    const auto V = joined({roof}).V();
    for (Eigen::Index v = 0; v < V.rows(); ++v) {
        const float reach = std::max(std::abs(V(v, 0)), std::abs(V(v, 2)));
        // Rays along its border may pass the roof or not.
        if (v >= 9 && reach == 1) continue;
        EXPECT_EQ(seen[size_t(v)], v < 9 || reach > 1) << v;
    }
    // The roof is before the near plane and hides nothing.
    const std::vector<uint8_t> below = visible_vertices(roof, camera, Vec2i(100, 100), {}, 3.5);
    for (size_t v = 0; v < below.size(); ++v) EXPECT_EQ(below[v], v >= 9) << v;
}

// Views infer near and far planes, too.
TEST(VisibleVertices, DoNotDependOnTheCamerasOwnNearAndFar) {
    const Mesh small = make_icosphere(0.001, 3), box = make_box();
    const Vec3d close(0, 0, 0.004);
    const auto seen = [](const Mesh& mesh, const Camera& camera) {
        return visible_vertices(mesh, camera, Vec2i(64, 64));
    };
    EXPECT_EQ(seen(small, Camera::look_at(close, {0, 0, 0})), visible_vertices(small, close));
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Camera camera = Camera::look_at({0.2, 0.1, 200}, {0.2, 0.1, 0});
        camera.projection = projection;
        const std::vector<uint8_t> expected = seen(box, camera);
        EXPECT_EQ(std::ranges::count(expected, 1), 12) << "three vertices at each corner of the face";
        camera.near = 300;
        camera.far = 400;
        EXPECT_EQ(seen(box, camera), expected);
    }
    // What is behind a camera within the content stays unseen.
    const std::vector<uint8_t> ahead = visible_vertices(box, Camera::look_at({0, 0, 0}, {0, 0, 1}));
    for (Eigen::Index v = 0; v < box.V().rows(); ++v) EXPECT_EQ(ahead[size_t(v)], box.V()(v, 2) > 0) << v;
}

TEST(VisibleVertices, CountTheOffset) {
    const Vec3d utm(500000, 5400000, 300);
    const Vec3d from(5, 3, 0.1);
    Mesh box = make_box();
    const std::vector<uint8_t> expected = facing_vertices(*box.snapshot(), from);
    box.set_offset(utm);
    EXPECT_EQ(visible_vertices(box, utm + from), expected);
    const Camera camera = Camera::look_at(from, {0, 0, 0});
    EXPECT_EQ(visible_vertices(box, camera, Vec2i(64, 64)), expected) << "relative to the mesh's offset";
    Camera moved = camera;
    moved.T_world_cam.translation() += Vec3d(100, 0, 0);
    EXPECT_EQ(visible_vertices(box, moved, Vec2i(64, 64), Vec3d(utm - Vec3d(100, 0, 0))), expected);
}

}  // namespace
}  // namespace easypbr::ray_tree_test
