// Surfaces of fields and of splats, against values derived on paper.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/geometry/isosurface.h"
#include "easypbr/geometry/place.h"
#include "easypbr/geometry/repair.h"
#include "easypbr/geometry/sample.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::isosurface_test {
namespace {

constexpr float constant = 0.28209479f;

/// Whether each edge of a face is one of another face, the other way around, and of no third.
void expect_closed(const Array3i& F) {
    std::map<std::pair<int, int>, int> edges;
    for (Eigen::Index f = 0; f < F.rows(); ++f)
        for (int k = 0; k < 3; ++k) ++edges[{F(f, k), F(f, (k + 1) % 3)}];
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
}

/// Vertices minus edges plus faces, of a closed mesh.
Eigen::Index euler(const MeshData& mesh) {
    return mesh.V.rows() - mesh.F.rows() / 2;
}

struct Splat {
    Vec3 mean{0, 0, 0}, scales{1, 1, 1};
    Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
    float opacity = 1;
    Vec3 color{0.5f, 0.5f, 0.5f};
};

MeshData mesh_of(const std::vector<Splat>& splats) {
    const auto n = Eigen::Index(splats.size());
    Array3f::Dense V(n, 3), scales(n, 3);
    Array4f::Dense rotations(n, 4);
    Array1f::Dense opacities(n);
    ArrayXf::Dense sh(n, 3);
    Array1i::Dense L(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Splat& s = splats[size_t(i)];
        V.row(i) = s.mean.transpose();
        scales.row(i) = s.scales.transpose();
        rotations.row(i) << s.rotation.w(), s.rotation.x(), s.rotation.y(), s.rotation.z();
        opacities(i) = s.opacity;
        sh.row(i) = (s.color.array() - 0.5f).matrix().transpose() / constant;
        L(i) = int(i);
    }
    MeshData mesh;
    mesh.name = "splats";
    mesh.V = std::move(V);
    mesh.L = std::move(L);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    return mesh;
}

// All ways in which the corners of cells can lie, many of them: closed, and every sample on its side.
TEST(Isosurface, OfAnyFieldIsClosed) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-1, 1);
    for (int round = 0; round < 50; ++round) {
        SampleGrid grid;
        grid.size = Eigen::Vector3i(6, 7, 8);
        std::vector<float> values(grid.count(), -1.0f);
        for (int z = 1; z < 7; ++z)
            for (int y = 1; y < 6; ++y)
                for (int x = 1; x < 5; ++x) values[grid.index(x, y, z)] = value(random);
        values[grid.index(2, 2, 2)] = std::numeric_limits<float>::quiet_NaN();
        values[grid.index(3, 3, 3)] = 0;  // on the surface
        const Isosurface surface = isosurface(values, grid, 0);
        expect_closed(surface.F);
        for (const Isosurface::Edge& edge : surface.edges) {
            ASSERT_GE(values[edge.inside], 0);
            ASSERT_FALSE(values[edge.outside] >= 0);
            ASSERT_TRUE(edge.part > 0 && edge.part < 1);
        }
        // Each sample inside is a tetrahedra's corner: outwards means a positive volume.
        MeshData mesh;
        mesh.V = surface.V;
        mesh.F = surface.F;
        ASSERT_GT(volume(mesh), 0);
        ASSERT_TRUE(mesh.V.allFinite());
    }
}

// The field is linear: the plane x + 2 y - z = 1.5 to roundings of float32 coordinates up to 8.
TEST(Isosurface, OfALinearFieldIsAPlane) {
    SampleGrid grid{Eigen::Vector3i(9, 9, 9), Vec3d(-1, -2, -3), 0.5};
    std::vector<float> values;
    for (int z = 0; z < 9; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 9; ++x) {
                const Vec3d p = grid.corner + grid.step * Vec3d(x, y, z);
                values.push_back(float(p.x() + 2 * p.y() - p.z()));
            }
    const Isosurface surface = isosurface(values, grid, 1.5f);
    ASSERT_GT(surface.V.rows(), 100);
    for (Eigen::Index i = 0; i < surface.V.rows(); ++i)
        ASSERT_NEAR(surface.V(i, 0) + 2 * surface.V(i, 1) - surface.V(i, 2), 1.5f, 4e-4f);
    MeshData mesh;
    mesh.V = surface.V;
    mesh.F = surface.F;
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f)
        if (area_vector(mesh, f).norm() > 1e-3) {
            ASSERT_LT(area_vector(mesh, f).normalized().dot(Vec3d(1, 2, -1).normalized()), -0.99);
        }
}

// sigma sqrt(2 ln(opacity / level)). A field that is linear on an edge of length l is off by l^2 |f''| / (8
// |f'|) at most; l is sqrt(3) cells, |f''| at most 0.446 / sigma^2 times the opacity.
TEST(SplatMesh, OfOneSplatIsASphere) {
    for (const auto& [opacity, level] : {std::pair{1.0, 0.3}, std::pair{0.8, 0.2}, std::pair{1.0, 0.5}}) {
        Splat one;
        one.mean = Vec3(3, -2, 1);
        one.scales = Vec3::Constant(0.5f);
        one.opacity = float(opacity);
        const double sigma = 0.5, radius = sigma * std::sqrt(2 * std::log(opacity / level)),
                     cell = 6 * sigma / 64;
        const Mesh mesh = mesh_from_splats(Mesh(mesh_of({one})), {64, level});
        const auto data = mesh.snapshot();
        expect_closed(data->F);
        EXPECT_EQ(euler(*data), 2);
        const double slope = level * radius / (sigma * sigma),
                     bound = 1.1 * 3 * cell * cell * 0.446 * opacity / (sigma * sigma) / (8 * slope) + 1e-6;
        for (Eigen::Index i = 0; i < data->V.rows(); ++i)
            ASSERT_NEAR((data->V.row(i).transpose() - one.mean).norm(), radius, bound) << opacity;
        // A polyhedron of edges of up to sqrt(3) cells lies that much below the sphere: l^2 / (8 r).
        const double ball = 4 * pi / 3 * std::pow(radius, 3);
        EXPECT_NEAR(volume(*data), ball, ball * 3 * (3 * cell * cell / (8 * radius) + bound) / radius);
    }
}

// The ellipsoid of the level; its vertices have d^T S^-1 d = 2 ln(1 / level). To 2 %: as above, of the
// shortest axis.
TEST(SplatMesh, OfALongSplatIsAnEllipsoid) {
    Splat one;
    one.scales = Vec3(0.2f, 0.4f, 0.8f);
    one.rotation = Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized());
    MeshData splats = mesh_of({one});
    splats.offset = Vec3d(1e6, 0, 0);
    const Mesh mesh = mesh_from_splats(Mesh(splats), {128, 0.3});
    const auto data = mesh.snapshot();
    expect_closed(data->F);
    EXPECT_EQ(euler(*data), 2);
    EXPECT_EQ(data->offset, splats.offset);
    for (Eigen::Index i = 0; i < data->V.rows(); ++i) {
        const Vec3 local = one.rotation.inverse() * data->V.row(i).transpose();
        ASSERT_NEAR(local.cwiseQuotient(one.scales).norm(), std::sqrt(-2 * std::log(0.3)), 0.02);
    }
    const double ellipsoid = 4 * pi / 3 * std::pow(-2 * std::log(0.3), 1.5) * 0.2 * 0.4 * 0.8;
    EXPECT_NEAR(volume(*data), ellipsoid, 0.02 * ellipsoid);
}

// Two splats far apart are two bodies, with a colour and a label each; a ring of them has a hole.
TEST(SplatMesh, HasTheShapeColoursAndLabelsOfItsSplats) {
    Splat red, blue;
    red.color = Vec3(0.9f, 0.1f, 0.1f);
    blue.color = Vec3(0.1f, 0.2f, 0.8f);
    blue.mean = Vec3(6, 0, 0);
    const Mesh two = mesh_from_splats(Mesh(mesh_of({red, blue})), {48, 0.3});
    EXPECT_EQ(split(two).size(), 2u);
    const auto data = two.snapshot();
    for (Eigen::Index i = 0; i < data->V.rows(); ++i) {
        const bool left = data->V(i, 0) < 3;
        ASSERT_EQ(data->L(i), left ? 0 : 1);
        ASSERT_LT((data->C.row(i).transpose() - (left ? red : blue).color).norm(), 1e-4f);
    }
    std::vector<Splat> ring(24);
    for (size_t i = 0; i < ring.size(); ++i) {
        const float angle = float(2 * pi) * float(i) / float(ring.size());
        ring[i].mean = 4 * Vec3(std::cos(angle), std::sin(angle), 0);
        ring[i].opacity = 0.7f;
    }
    const auto torus = mesh_from_splats(Mesh(mesh_of(ring)), {64, 0.3}).snapshot();
    expect_closed(torus->F);
    EXPECT_EQ(euler(*torus), 0);
}

// A flat splat is as thick as half a cell, and an outlier does not take the grid from the others.
TEST(SplatMesh, OfFlatSplatsAndOutliers) {
    std::vector<Splat> sheet;
    for (int i = 0; i < 1600; ++i) {
        Splat one;
        one.mean = Vec3(float(i % 40), float(i / 40), 0.01f * float(i % 7));
        one.scales = Vec3(1, 1, 0);
        sheet.push_back(one);
    }
    sheet[0].mean = Vec3(0, 0, 1e5f);
    const auto data = mesh_from_splats(Mesh(mesh_of(sheet)), {64, 0.3}).snapshot();
    expect_closed(data->F);
    EXPECT_EQ(euler(*data), 2);
    EXPECT_LT(data->V.col(2).cwiseAbs().maxCoeff(), 2);
    EXPECT_GT(volume(*data), 39 * 39 * 0.5);
}

TEST(SplatMesh, NamesBadInput) {
    const Mesh mesh(mesh_of({Splat{}}));
    EXPECT_NE(refusal([&] {
                  mesh_from_splats(mesh, {7, 0.3});
              }).find("resolution: expected a whole number from 8"),
              std::string::npos);
    EXPECT_NE(refusal([&] {
                  mesh_from_splats(mesh, {64, 1});
              }).find("level: expected a number above 0 and below 1"),
              std::string::npos);
    Splat faint;
    faint.opacity = 0.2f;
    EXPECT_NE(refusal([&] {
                  mesh_from_splats(Mesh(mesh_of({faint})), {64, 0.3});
              }).find("nowhere above the level 0.3"),
              std::string::npos);
    EXPECT_NE(refusal([] { mesh_from_splats(Mesh(MeshData{})); }).find("splats"), std::string::npos);
    EXPECT_NE(refusal([] { isosurface({}, {}, 0); }).find("at least 2 samples a side"), std::string::npos);
    EXPECT_NE(refusal([] { isosurface({}, {Eigen::Vector3i(2, 2, 2)}, 0); }).find("expected 8 values"),
              std::string::npos);
}

}  // namespace
}  // namespace easypbr::isosurface_test
