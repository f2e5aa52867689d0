#include "easypbr/geometry/place.h"

#include <gtest/gtest.h>

#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/merge.h"
#include "geometry/measure.h"
#include "refusal.h"

namespace easypbr::components_test {
namespace {

using Rows3 = Array3f::Dense;

TEST(Components, SeamsAndHardEdgesConnect) {
    EXPECT_EQ(vertex_components(make_box()).maxCoeff(), 0) << "24 vertices at 8 places";
    EXPECT_EQ(face_components(make_torus()).maxCoeff(), 0);
}

TEST(Components, AreNumberedByTheirFirstVertexOrFace) {
    MeshData data;
    data.V = Rows3{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {1, 0, 0}};
    data.F = Array3i::Dense{{4, 5, 6}, {1, 2, 3}};
    data.E = Array2i::Dense{{7, 0}};
    // Vertex 7 is where 2 is, and an edge joins it to 0.
    EXPECT_EQ(Array1i::Dense(vertex_components(Mesh(data))), (Array1i::Dense{{0, 0, 0, 0, 1, 1, 1, 0}}));
    EXPECT_EQ(Array1i::Dense(face_components(Mesh(data))), (Array1i::Dense{{0, 1}}));
    EXPECT_EQ(vertex_components(Mesh()).rows(), 0);
}

TEST(Split, GivesEachPieceAllThatBelongsToIt) {
    MeshData ball = *make_icosphere(1, 2).snapshot();
    const MeshData torus =
        transformed(*make_torus(1, 0.2f).snapshot(), Eigen::Affine3d(Eigen::Translation3d(5, 0, 0)));
    MeshData both = merged(std::vector{ball, torus});
    both.L = Array1i(Array1i::Dense::LinSpaced(both.F.rows(), 0, int(both.F.rows()) - 1));
    const std::vector<Mesh> pieces = split(Mesh(both));
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[0].F().rows(), ball.F.rows());
    EXPECT_EQ(pieces[0].V(), ball.V);
    EXPECT_EQ(pieces[1].L()[0], ball.F.rows()) << "labels of its own faces";
    for (const Mesh& piece : pieces) {
        const auto data = piece.snapshot();
        EXPECT_NO_THROW(validate(*data));
        EXPECT_TRUE(is_closed(*data));
        EXPECT_EQ(data->materials.size(), both.materials.size());
    }
    EXPECT_EQ(euler_characteristic(*pieces[0].snapshot()), 2);
    EXPECT_EQ(euler_characteristic(*pieces[1].snapshot()), 0);
}

TEST(Split, LeavesOutLooseVerticesAndRefusesClouds) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {3, 3, 3}, {1, 0, 0}};
    EXPECT_NE(refusal([&] { split(Mesh(data)); }).find("expected a mesh with faces"), std::string::npos);
    data.E = Array2i::Dense{{0, 2}};
    const std::vector<Mesh> pieces = split(Mesh(data));
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].V().rows(), 2);
    EXPECT_EQ(Array2i::Dense(pieces[0].E()), (Array2i::Dense{{0, 1}}));
}

}  // namespace
}  // namespace easypbr::components_test
