#include "easypbr/geometry/repair.h"

#include <gtest/gtest.h>

#include <limits>

#include "easypbr/core/log.h"
#include "easypbr/geometry/primitives.h"
#include "geometry/measure.h"

namespace easypbr::repair_test {
namespace {

using Rows3 = Array3f::Dense;

TEST(RemoveUnreferencedVertices, KeepsWhatFacesAndEdgesUse) {
    MeshData data;
    data.V = Rows3{{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
    data.F = Array3i::Dense{{1, 3, 4}};
    data.E = Array2i::Dense{{5, 3}};
    data.I = Array1f::Dense{{0, 1, 2, 3, 4, 5}};
    const auto clean = remove_unreferenced_vertices(Mesh(data)).snapshot();
    EXPECT_EQ(Array1f::Dense(clean->I), (Array1f::Dense{{1, 3, 4, 5}}));
    EXPECT_EQ(Array3i::Dense(clean->F), (Array3i::Dense{{0, 1, 2}}));
    EXPECT_EQ(Array2i::Dense(clean->E), (Array2i::Dense{{3, 1}}));
    EXPECT_EQ(Array1i::Dense(clean->source_vertex), (Array1i::Dense{{1, 3, 4, 5}}));
    MeshData points;
    points.V = data.V;
    EXPECT_EQ(remove_unreferenced_vertices(Mesh(points)).V().rows(), 6) << "a cloud is no leftover";
}

TEST(RemoveDuplicateVertices, WeldsWhatIsTheSameInEverything) {
    MeshData data = *make_box().snapshot();
    EXPECT_EQ(remove_duplicate_vertices(Mesh(data)).V().rows(), 24) << "normals differ";
    data.N = {};
    data.UV = {};
    const Mesh welded = remove_duplicate_vertices(Mesh(data));
    EXPECT_EQ(welded.V().rows(), 8);
    EXPECT_EQ(welded.F().rows(), 12);
    EXPECT_EQ(volume(*welded.snapshot()), 1);
    data.scalars = {{"side", Array1f(Array1f::Dense::LinSpaced(24, 0, 23))}};
    EXPECT_EQ(remove_duplicate_vertices(Mesh(data)).V().rows(), 24) << "scalars differ";
}

TEST(RemoveDuplicateVertices, WeldsSeamsWhenAsked) {
    const auto welded = remove_duplicate_vertices(make_box(), {0, false}).snapshot();
    ASSERT_EQ(welded->V.rows(), 8);
    for (Eigen::Index i = 0; i < 8; ++i)
        // The mean of the normals of the three sides at a corner of the unit cube points from its middle.
        EXPECT_LT((welded->N.row(i) - welded->V.row(i).normalized()).norm(), 1e-6f);
    EXPECT_NO_THROW(validate(*welded));
}

TEST(RemoveDuplicateVertices, WithinATolerance) {
    MeshData data;
    // A chain of steps of 0.09: the third is too far from the first, so it begins a new one.
    data.V = Rows3{{0, 0, 0}, {0.09f, 0, 0}, {0.18f, 0, 0}, {-0.09f, 0, 0}, {5, 0, 0}, {5, 0.099f, 0}};
    data.F = Array3i::Dense{{0, 2, 4}, {0, 1, 4}};
    data.E = Array2i::Dense{{4, 5}, {2, 5}};
    const auto welded = remove_duplicate_vertices(Mesh(data), {0.1, true}).snapshot();
    EXPECT_EQ(Array1i::Dense(welded->source_vertex), (Array1i::Dense{{0, 2, 4}}));
    EXPECT_EQ(Array3i::Dense(welded->F), (Array3i::Dense{{0, 1, 2}})) << "the other face has lost its extent";
    EXPECT_EQ(Array2i::Dense(welded->E), (Array2i::Dense{{1, 2}}));
    data.V = Rows3(1e6f * data.V);
    EXPECT_EQ(remove_duplicate_vertices(Mesh(data), {1e-30, true}).V().rows(), 6)
        << "less than floats resolve";
    EXPECT_EQ(remove_duplicate_vertices(Mesh(), {0.1, true}).V().rows(), 0);
}

TEST(RemoveDuplicateVertices, MinusZeroIsZero) {
    MeshData data;
    data.V = Rows3{{0.0f, 1, 0}, {-0.0f, 1, 0}};
    EXPECT_EQ(remove_duplicate_vertices(Mesh(data)).V().rows(), 1);
}

TEST(RemoveDuplicateVertices, RefusesATolerranceThatIsNone) {
    EXPECT_THROW(remove_duplicate_vertices(make_box(), {-1, true}), ArgumentError);
    EXPECT_THROW(remove_duplicate_vertices(make_box(), {std::numeric_limits<double>::quiet_NaN(), true}),
                 ArgumentError);
}

TEST(RemoveDegenerateFaces, KeepsPartsAndValuesOfFaces) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    data.F = Array3i::Dense{{0, 1, 3}, {0, 1, 2}, {1, 4, 3}, {0, 2, 3}, {3, 3, 0}};
    data.L = Array1i(Array1i::Dense{{10, 11, 12, 13, 14}});
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}, {7, 7, 7}};
    data.materials.resize(2);
    data.parts = {{"a", 0, 2, 0}, {"b", 2, 3, 1}};
    const auto clean = remove_degenerate_faces(Mesh(data)).snapshot();
    EXPECT_EQ(Array3i::Dense(clean->F), (Array3i::Dense{{0, 1, 3}, {0, 2, 3}}));
    EXPECT_EQ(Array1i::Dense(clean->L), (Array1i::Dense{{10, 13}}));
    EXPECT_EQ(Array1i::Dense(clean->source_face), (Array1i::Dense{{0, 3}}));
    ASSERT_EQ(clean->parts.size(), 2u);
    EXPECT_EQ(clean->parts[0].face_count, 1);
    EXPECT_EQ(clean->parts[1].first_face, 1);
    EXPECT_EQ(clean->parts[1].face_count, 1);
}

TEST(RemoveDegenerateFaces, ValuesThatWouldBecomeAmbiguousAreLeftOut) {
    MeshData data;
    data.V = Rows3{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}, {0, 2, 1}, {2, 0, 1}, {0, 0, 1}};
    data.L = Array1i(Array1i::Dense{{1, 2, 3, 4}});
    std::string warning;
    set_log_sink([&](LogLevel, std::string_view text) { warning = text; });
    const Mesh clean = remove_degenerate_faces(Mesh(data));
    set_log_sink(nullptr);
    EXPECT_EQ(clean.F().rows(), 3);
    EXPECT_TRUE(clean.L().empty()) << "three labels of faces would be taken for those of the three vertices";
    EXPECT_NE(warning.find("labels belong to its faces"), std::string::npos);
}

TEST(Flip, TurnsWindingAndNormals) {
    const Mesh box = make_box();
    EXPECT_EQ(volume(*flip_winding(box).snapshot()), -1);
    EXPECT_EQ(flip_winding(box).N(), box.N());
    EXPECT_EQ(flip_normals(box).N(), Array3f(-box.N()));
    EXPECT_EQ(volume(*flip_normals(box).snapshot()), 1);
    EXPECT_NO_THROW(flip_winding(Mesh()));
    EXPECT_NO_THROW(flip_normals(Mesh()));
}

}  // namespace
}  // namespace easypbr::repair_test
