#include "easypbr/geometry/tubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/log.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::tubes_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Lines of points, each joined to the next one.
Mesh polyline(const std::vector<Vec3>& points, bool is_ring = false) {
    const auto count = Eigen::Index(points.size());
    Array3f::Dense V(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) V.row(i) = points[size_t(i)].transpose();
    Array2i::Dense E(is_ring ? count : count - 1, 2);
    for (Eigen::Index i = 0; i < E.rows(); ++i) E.row(i) << int(i), int((i + 1) % count);
    MeshData data;
    data.V = std::move(V);
    data.E = std::move(E);
    return Mesh(std::move(data));
}

/// The part of a regular polygon of n corners in the square of the radius to them.
double polygon(int n) {
    return n / 2.0 * std::sin(2 * pi / n);
}

/// The half sphere of a round end of n sides: slices between rings of radii cos(i pi / 2 k), k = n / 4, are
/// frusta of pyramids, the last one a pyramid.
double half_ball(int n, double radius) {
    double sum = 0;
    const int steps = n / 4;
    for (int i = 0; i < steps; ++i) {
        const double from = pi / 2 * i / steps, to = pi / 2 * (i + 1) / steps;
        const double a = std::cos(from), b = i + 1 == steps ? 0 : std::cos(to);
        sum += (std::sin(to) - std::sin(from)) * (a * a + a * b + b * b) / 3;
    }
    return sum * polygon(n) * radius * radius * radius;
}

/// Closed, oriented outwards, with finite unit normals that agree with the faces.
void expect_sound(const Mesh& tubes, double least_agreement) {
    const auto data = tubes.snapshot();
    EXPECT_NO_THROW(validate(*data));
    EXPECT_TRUE(is_closed(*data));
    ASSERT_EQ(data->N.rows(), data->V.rows());
    EXPECT_LT((data->N.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-6f);
    EXPECT_GT(normal_agreement(*data).first, least_agreement);
}

TEST(Tubes, ALineIsACapsule) {
    const Mesh tubes = make_tubes(polyline({{0, 0, 0}, {0, 0, 3}}), {.radius = 0.5, .sides = 16});
    // Half a side, and a fourth of a right angle along the ends, whose normals are those of a sphere.
    expect_sound(tubes, std::cos(pi / 16) * std::cos(pi / 8));
    EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 2);
    EXPECT_NEAR(volume(*tubes.snapshot()), 3 * 0.25 * polygon(16) + 2 * half_ball(16, 0.5), 1e-5);
    EXPECT_EQ(tubes.V().col(2).maxCoeff(), 3.5f);
    EXPECT_EQ(tubes.V().col(2).minCoeff(), -0.5f);
}

TEST(Tubes, FlatEndsMakeAPrism) {
    const Mesh tubes =
        make_tubes(polyline({{0, 0, 0}, {0, 0, 3}}), {.radius = 0.5, .sides = 12, .ends = TubeEnds::flat});
    expect_sound(tubes, std::cos(pi / 12) - 1e-5);
    EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 2);
    EXPECT_NEAR(volume(*tubes.snapshot()), 3 * 0.25 * polygon(12), 1e-5);
    EXPECT_EQ(tubes.V().col(2).maxCoeff(), 3);
    EXPECT_EQ(tubes.V().rows(), 4 * 12);
}

TEST(Tubes, AStraightJointChangesNothing) {
    const TubeOptions options{.radius = 0.25, .sides = 12};
    const Mesh whole = make_tubes(polyline({{0, 0, 0}, {4, 0, 0}}), options);
    const Mesh parts = make_tubes(polyline({{0, 0, 0}, {1, 0, 0}, {4, 0, 0}}), options);
    expect_sound(parts, 0.8);
    EXPECT_EQ(parts.V().rows(), whole.V().rows() + 12) << "one ring more";
    EXPECT_NEAR(volume(*parts.snapshot()), volume(*whole.snapshot()), 1e-5);
    EXPECT_NEAR(area(*parts.snapshot()), area(*whole.snapshot()), 1e-5);
}

TEST(Tubes, CornersAreMitred) {
    const Mesh tubes = make_tubes(polyline({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}}),
                                  {.radius = 0.25, .sides = 12, .ends = TubeEnds::flat});
    expect_sound(tubes, std::cos(pi / 12) - 1e-5);
    EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 2);
    // What a mitre takes on the inside it adds on the outside: the volume is that of the lines' length.
    EXPECT_NEAR(volume(*tubes.snapshot()), (2 + 3) * 0.0625 * polygon(12), 1e-5);
}

TEST(Tubes, ARingIsATorus) {
    std::vector<Vec3> points;
    const int count = 64;
    for (int i = 0; i < count; ++i)
        points.emplace_back(2 * std::cos(float(2 * pi * i / count)), 0,
                            2 * std::sin(float(2 * pi * i / count)));
    const Mesh tubes = make_tubes(polyline(points, true), {.radius = 0.5, .sides = 16});
    expect_sound(tubes, std::cos(pi / 16) * std::cos(pi / 64) - 1e-3);
    EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 0);
    EXPECT_EQ(tubes.V().rows(), count * 16);
    // Mitred prisms along the polygon of length n * 2 R sin(pi / n).
    EXPECT_NEAR(volume(*tubes.snapshot()), count * 4 * std::sin(pi / count) * 0.25 * polygon(16), 1e-4);
}

TEST(Tubes, ARectangleIsARing) {
    const Mesh tubes = make_tubes(polyline({{0, 0, 0}, {3, 0, 0}, {3, 0.1f, 2}, {0, 0.1f, 2}}, true),
                                  {.radius = 0.1, .sides = 12});
    expect_sound(tubes, std::cos(pi / 12) - 1e-5);
    EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 0);
}

TEST(Tubes, ARingInSpaceMeetsItself) {
    // Its frames come back turned: the torsion of a curve on a torus.
    std::vector<Vec3> points;
    const int count = 200;
    for (int i = 0; i < count; ++i) {
        const float t = float(2 * pi * i / count), r = 3 + std::cos(3 * t);
        points.emplace_back(r * std::cos(2 * t), std::sin(3 * t), r * std::sin(2 * t));
    }
    for (const int sides : {3, 5, 12}) {
        const Mesh tubes = make_tubes(polyline(points, true), {.radius = 0.1, .sides = sides});
        // Half a side, half of the turn from point to point (below 0.1), and a twist of less than half a
        // side.
        expect_sound(tubes, std::cos(pi / sides) - 0.02);
        EXPECT_EQ(euler_characteristic(*tubes.snapshot()), 0) << sides;
        double length = 0, longest = 0;
        for (int i = 0; i < count; ++i) {
            const double step = (points[size_t(i)] - points[size_t((i + 1) % count)]).norm();
            length += step;
            longest = std::max(longest, step);
        }
        // A twist d between two rings takes from or adds to each side a tetrahedron of a sixth of side * side
        // d * edge: 2 / 3 tan(pi / n) d of the prism. The whole twist is at most half a side, pi / n.
        const double whole = length * 0.01 * polygon(sides);
        const double twist = pi / sides * longest / length;
        EXPECT_NEAR(volume(*tubes.snapshot()), whole, whole * (2.0 / 3 * std::tan(pi / sides) * twist + 1e-5))
            << sides;
    }
}

TEST(Tubes, BranchesAndSharpTurnsEndInSpheres) {
    // Three lines from one point: three capsules.
    MeshData star = *polyline({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).snapshot();
    Array2i::Dense E(3, 2);
    E << 0, 1, 0, 2, 0, 3;
    star.E = std::move(E);
    const TubeOptions options{.radius = 0.1, .sides = 8};
    const double capsule = 0.01 * polygon(8) + 2 * half_ball(8, 0.1);
    const Mesh tubes = make_tubes(Mesh(star), options);
    expect_sound(tubes, std::cos(pi / 8) * std::cos(pi / 8) - 1e-3);
    EXPECT_NEAR(volume(*tubes.snapshot()), 3 * capsule, 1e-6);
    // A turn of 135 degrees, and a turn back: two capsules each.
    for (const Vec3& last : {Vec3(0.29289322f, 0.70710678f, 0), Vec3(0, 0, 0)}) {
        const Mesh turn = make_tubes(polyline({{0, 0, 0}, {1, 0, 0}, last}), options);
        expect_sound(turn, 0.8);
        EXPECT_NEAR(volume(*turn.snapshot()), 2 * capsule, 1e-6);
    }
}

TEST(Tubes, EdgesShorterThanTheirMitreDoNotTurnInsideOut) {
    // A spiral tighter than its tube.
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i)
        points.emplace_back(0.05f * std::cos(0.7f * float(i)), 0.01f * float(i),
                            0.05f * std::sin(0.7f * float(i)));
    expect_sound(make_tubes(polyline(points), {.radius = 0.2, .sides = 12}), 0.7);
}

TEST(Tubes, CarryWhatTheVerticesHave) {
    MeshData lines = *polyline({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).snapshot();
    lines.C = Eigen::MatrixXf(Eigen::Matrix3f::Identity());
    lines.L = Eigen::VectorXi(Eigen::Vector3i(4, 5, 6));
    lines.I = Eigen::VectorXf(Eigen::Vector3f(0.1f, 0.2f, 0.3f));
    lines.scalars.push_back({"heat", Eigen::VectorXf(Eigen::Vector3f(1, 2, 3))});
    lines.offset = Vec3d(5e5, 0, 0);
    lines.name = "pipe";
    lines.style.mode = DrawMode::lines;
    const auto tubes = make_tubes(Mesh(lines)).snapshot();
    EXPECT_EQ(tubes->name, "pipe");
    EXPECT_EQ(tubes->offset, lines.offset);
    EXPECT_FALSE(tubes->style.mode.value());
    EXPECT_TRUE(tubes->E.empty());
    for (Eigen::Index v = 0; v < tubes->V.rows(); ++v) {
        const int nearest = int(std::lround(tubes->V(v, 0)));
        ASSERT_EQ(tubes->L[v], 4 + nearest);
        ASSERT_EQ(tubes->C(v, nearest), 1);
        ASSERT_EQ(tubes->I[v], lines.I[nearest]);
        ASSERT_EQ(scalar_named(*tubes, "heat").values[v], 1 + nearest);
    }
    // Automatic: 1 / 200 of the diagonal, which is 2.
    EXPECT_NEAR(tubes->V.col(0).maxCoeff(), 2.01f, 1e-6f);
}

/// A line from x = 5 to 6, and a triangle from 0 to 1 of the second material.
MeshData line_and_triangle() {
    MeshData mesh = *polyline({{5, 0, 0}, {6, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).snapshot();
    mesh.E = Array2i::Dense(Eigen::RowVector2i(0, 1));
    mesh.F = Array3i::Dense(Eigen::RowVector3i(2, 3, 4));
    mesh.materials.resize(2);
    mesh.materials[0].name = "pipe";
    mesh.materials[1].name = "leaf";
    mesh.parts = {{"blade", 0, 1, 1}};
    return mesh;
}

TEST(Tubes, StandBesideTheFaces) {
    MeshData mesh = line_and_triangle();
    mesh.L = Eigen::VectorXi(Eigen::VectorXi::LinSpaced(5, 10, 14));
    mesh.scalars.push_back({"of faces", Eigen::VectorXf(Eigen::VectorXf::Constant(1, 7))});
    mesh.source_face = Eigen::VectorXi(Eigen::VectorXi::Constant(1, 3));
    mesh.style.mode = DrawMode::lines;
    mesh.children = {Mesh(MeshData())};
    const Mesh tube = make_tubes(polyline({{5, 0, 0}, {6, 0, 0}}), {.radius = 0.1});
    const auto whole = make_tubes(Mesh(mesh), {.radius = 0.1}).snapshot();
    EXPECT_NO_THROW(validate(*whole));
    EXPECT_TRUE(whole->E.empty());
    EXPECT_FALSE(whole->style.mode.value());
    EXPECT_EQ(whole->children.size(), 1u);
    ASSERT_EQ(whole->V.rows(), 3 + tube.V().rows());
    ASSERT_EQ(whole->F.rows(), 1 + tube.F().rows());
    EXPECT_EQ(whole->F.row(0), Eigen::RowVector3i(0, 1, 2));
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(whole->V.row(k), mesh.V.row(2 + k)) << k;
        EXPECT_EQ(whole->N.row(k), Eigen::RowVector3f(0, 0, 1)) << k;
        EXPECT_EQ(whole->L[k], 12 + k);
    }
    EXPECT_EQ(whole->V.bottomRows(tube.V().rows()), tube.V());
    for (Eigen::Index v = 3; v < whole->V.rows(); ++v)
        ASSERT_EQ(whole->L[v], whole->V(v, 0) < 5.5f ? 10 : 11) << v;
    const Array1f& values = scalar_named(*whole, "of faces").values;
    ASSERT_EQ(values.rows(), whole->F.rows());
    EXPECT_EQ(values[0], 7);
    EXPECT_TRUE(values.bottomRows(tube.F().rows()).array().isNaN().all());
    ASSERT_EQ(whole->parts.size(), 2u);
    EXPECT_EQ(whole->parts[0].name, "blade");
    EXPECT_EQ(whole->materials[size_t(whole->parts[0].material)].name, "leaf");
    EXPECT_EQ(whole->parts[1].first_face, 1);
    EXPECT_EQ(whole->parts[1].face_count, tube.F().rows());
    EXPECT_EQ(whole->materials[size_t(whole->parts[1].material)].name, "pipe");
    EXPECT_EQ(whole->source_face[0], 3);
}

// Two triangles at a right angle: each of the common edge's vertices gets a normal for either.
TEST(Tubes, LeaveSharpEdgesOfFacesSharp) {
    MeshData mesh = *polyline({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}, {5, 0, 0}, {6, 0, 0}}).snapshot();
    mesh.E = Array2i::Dense(Eigen::RowVector2i(4, 5));
    mesh.F = Array3i::Dense(Eigen::Matrix<int, 2, 3, Eigen::RowMajor>{{0, 1, 2}, {1, 0, 3}});
    const auto whole = make_tubes(Mesh(mesh), {.radius = 0.1}).snapshot();
    for (Eigen::Index f = 0; f < 2; ++f)
        for (int k = 0; k < 3; ++k)
            EXPECT_LT(
                (whole->N.row(whole->F(f, k)).transpose() - area_vector(*whole, f).normalized().cast<float>())
                    .norm(),
                1e-6f)
                << f << " " << k;
}

// Two triangles that differ by 30 degrees, which no crease parts: drawn flat, each has its own normal. So it
// has beside tubes, whose normals stay those of cylinders.
TEST(Tubes, LeaveFlatFacesFlat) {
    const auto sine = float(std::sin(pi / 6)), cosine = float(std::cos(pi / 6));
    MeshData mesh =
        *polyline({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -cosine, -sine}, {5, 0, 0}, {6, 0, 0}}).snapshot();
    mesh.E = Array2i::Dense(Eigen::RowVector2i(4, 5));
    mesh.F = Array3i::Dense(Eigen::Matrix<int, 2, 3, Eigen::RowMajor>{{0, 1, 2}, {1, 0, 3}});
    mesh.style.flat = true;
    MeshData with_normals = mesh;
    with_normals.N = Array3f::Dense(Eigen::RowVector3f(0, 0, 1).replicate(6, 1));
    const Mesh tube = make_tubes(polyline({{5, 0, 0}, {6, 0, 0}}), {.radius = 0.1});
    for (const MeshData& flat : {mesh, with_normals}) {
        const auto whole = make_tubes(Mesh(flat), {.radius = 0.1}).snapshot();
        EXPECT_NO_THROW(validate(*whole));
        EXPECT_FALSE(whole->style.flat.value());
        for (Eigen::Index f = 0; f < whole->F.rows(); ++f) {
            const Vec3 normal = area_vector(*whole, f).normalized().cast<float>();
            for (int k = 0; k < 3; ++k) {
                const Vec3 N = whole->N.row(whole->F(f, k));
                // Of a tube as without faces; of a flat face its own, but for the rounding of float32.
                if (f >= 2) {
                    EXPECT_EQ(N, Vec3(tube.N().row(tube.F()(f - 2, k)))) << f << " " << k;
                } else {
                    EXPECT_LT((N - normal).norm(), 1e-6f) << f << " " << k;
                }
            }
        }
    }
}

TEST(Tubes, LeaveTangentsOfFacesWhereNothingIsSplit) {
    MeshData mesh = line_and_triangle();
    mesh.UV = Array2f::Dense(mesh.V.leftCols(2));
    mesh.uv_tangents = Array4f::Dense(Eigen::RowVector4f(0.6f, 0.8f, 0, -1).replicate(5, 1));
    const auto whole = make_tubes(Mesh(mesh), {.radius = 0.1}).snapshot();
    EXPECT_NO_THROW(validate(*whole));
    ASSERT_EQ(whole->uv_tangents.rows(), whole->V.rows());
    EXPECT_EQ(whole->uv_tangents.topRows(3), mesh.uv_tangents.topRows(3));
}

// Without faces, too, the normals of tubes are what is drawn, in memory as after a file.
TEST(Tubes, AreNotFlatWhereTheLinesAre) {
    MeshData line = *polyline({{5, 0, 0}, {6, 0, 0}}).snapshot();
    line.style.flat = true;
    line.style.line_width = 3.0f;
    const auto tube = make_tubes(Mesh(line)).snapshot();
    EXPECT_FALSE(tube->style.flat.value());
    EXPECT_EQ(tube->style.line_width.value(), 3.0f);
}

TEST(Tubes, PointsWithoutEdgeAndFaceAreLeftOutWithAWarning) {
    MeshData mesh = line_and_triangle();
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view text) { warnings.emplace_back(text); });
    (void)make_tubes(Mesh(mesh), {.radius = 0.1});
    EXPECT_TRUE(warnings.empty());
    mesh.name = "scan";
    mesh.F = {};
    mesh.parts = {};
    EXPECT_FALSE(make_tubes(Mesh(mesh), {.radius = 0.1}).V().row(0).isZero());
    set_log_sink({});
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "mesh 'scan': 3 of its 5 vertices belong to no edge and no face: left out"});
}

TEST(Tubes, RadiiOfVerticesMakeCones) {
    TubeOptions options{
        .radii = Eigen::VectorXf(Eigen::Vector2f(0.5f, 0.25f)), .sides = 12, .ends = TubeEnds::flat};
    const Mesh tubes = make_tubes(polyline({{0, 0, 0}, {0, 3, 0}}), options);
    // A frustum of a pyramid, whose normals lean.
    EXPECT_NEAR(volume(*tubes.snapshot()), 3 * polygon(12) * (0.25 + 0.125 + 0.0625) / 3, 1e-5);
    expect_sound(tubes, std::cos(pi / 12) - 1e-3);
    options.radii = Eigen::VectorXf(Eigen::Vector2f(0.5f, 0));
    EXPECT_EQ(refusal([&] {
                  make_tubes(polyline({{0, 0, 0}, {0, 3, 0}}), options);
              }),
              "make_tubes: radius of vertex 1: expected a number > 0, got 0");
}

TEST(Tubes, PointsAtOnePlaceAreOneAndEdgesAreJoinedOnce) {
    MeshData lines =
        *polyline({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {9, 9, 9}, {9, 9, 9}}).snapshot();
    const Mesh plain = make_tubes(polyline({{0, 0, 0}, {1, 0, 0}, {1, 0, 2}}), {.radius = 0.1});
    Array2i::Dense E(8, 2);
    E << 0, 1, 1, 2, 2, 3, 3, 4, 4, 3, 0, 0, 1, 0, 5, 6;
    lines.E = std::move(E);
    const Mesh tubes = make_tubes(Mesh(lines), {.radius = 0.1});
    expect_sound(tubes, 0.8);
    EXPECT_EQ(tubes.V().rows(), plain.V().rows());
    EXPECT_NEAR(volume(*tubes.snapshot()), volume(*plain.snapshot()), 1e-6);
}

TEST(Tubes, CanBeGivenUpAtEachRing) {
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) points.emplace_back(float(i), 0.0f, 0.0f);
    const Mesh line = polyline(points);
    int asked = 0;
    const auto make = [&](int last) {
        const InterruptScope scope([&] { return ++asked == last; });
        (void)make_tubes(line, {.radius = 0.1, .sides = 3});
    };
    make(0);
    EXPECT_GE(asked, 2000);
    asked = 0;
    EXPECT_THROW(make(1000), Interrupted);
    EXPECT_EQ(asked, 1000);
}

TEST(Tubes, WhatCannotBeIsRefused) {
    const Mesh line = polyline({{0, 0, 0}, {1, 0, 0}}), point = polyline({{1, 1, 1}, {1, 1, 1}});
    EXPECT_EQ(refusal([&] { make_tubes(point); }),
              "make_tubes: expected a mesh with edges (E) of a length above 0, got '' with 2 vertices and 1 "
              "edges");
    EXPECT_EQ(refusal([&] { make_tubes(line, {.radius = nan}); }),
              "make_tubes: radius: expected a number > 0, got nan");
    EXPECT_THROW(make_tubes(line, {.sides = 2}), ArgumentError);
    EXPECT_THROW(make_tubes(line, {.radii = Eigen::VectorXf(Eigen::VectorXf::Ones(3))}), ArgumentError);
    EXPECT_THROW(make_tubes(line, {.radius = 1.0, .radii = Eigen::VectorXf(Eigen::VectorXf::Ones(2))}),
                 ArgumentError);
}

}  // namespace
}  // namespace easypbr::tubes_test
