// Real files. The numbers were counted from the files by other programs (awk; Python's struct), not by the
// readers.
#include <string>

#include "easypbr/core/file.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "test_data.h"

namespace easypbr::mesh_files_test {

namespace {

struct Expected {
    const char* name;
    int vertices, faces, normals, uv, materials;
};

}  // namespace

TEST(RealMeshes, HaveTheirCounts) {
    REQUIRE_TEST_DATA();
    const Expected files[] = {
        {"bunny.ply", 34834, 69451, 0, 0, 0},
        {"head.obj", 38345, 76686, 0, 0, 1},
        {"nefertiti.obj", 49971, 99938, 0, 0, 1},
        {"room_scene.obj", 2248, 1120, 2248, 0, 1},
        {"sphere.obj", 7080, 3480, 7080, 7080, 1},
        {"spot.obj", 3225, 5856, 0, 3225, 1},
        {"lantern/lantern_obj.obj", 16001, 24634, 16001, 16001, 2},
        {"misc/brain.ply", 18844, 36752, 0, 0, 0},
        {"misc/rangemap.ply", 44461, 86766, 0, 0, 0},
        {"misc/bunny10k_textured.obj", 6451, 9999, 0, 6451, 1},
        {"misc/office_chair.obj", 3476, 6893, 0, 0, 3},
        {"clouds/lion.ply", 341989, 0, 0, 0, 0},
    };
    for (const Expected& file : files) {
        const auto mesh = Mesh(test_data(file.name)).snapshot();
        EXPECT_EQ(mesh->V.rows(), file.vertices) << file.name;
        EXPECT_EQ(mesh->F.rows(), file.faces) << file.name;
        EXPECT_EQ(mesh->N.rows(), file.normals) << file.name;
        EXPECT_EQ(mesh->UV.rows(), file.uv) << file.name;
        EXPECT_EQ(int(mesh->materials.size()), file.materials) << file.name;
        EXPECT_EQ(mesh->source, test_data(file.name));
    }
}

TEST(RealMeshes, TexturedPlyHasItsCornersAndItsImage) {
    REQUIRE_TEST_DATA();
    const auto mesh = Mesh(test_data("misc/matteonormb.ply")).snapshot();
    EXPECT_EQ(mesh->V.rows(), 1500);
    EXPECT_EQ(mesh->F.rows(), 500);
    EXPECT_EQ(mesh->source_vertex.maxCoeff(), 291);
    ASSERT_EQ(mesh->materials.size(), 1u);
    EXPECT_TRUE(mesh->materials[0].base_color_texture);
}

TEST(RealMeshes, StlIsWelded) {
    REQUIRE_TEST_DATA();
    const fs::path path = test_data("misc/knot_max_simplified.STL");
    const auto smooth = io::load_mesh(path, {180}).snapshot();
    EXPECT_EQ(smooth->F.rows(), 1600);
    EXPECT_EQ(smooth->V.rows(), 800) << "at 180 degrees no edge is sharp";
    const auto sharp = io::load_mesh(path).snapshot();
    EXPECT_GT(sharp->V.rows(), 800);
    EXPECT_LE(sharp->V.rows(), 4800);
    EXPECT_EQ(sharp->source_vertex.maxCoeff(), 799);
}

TEST(RealMeshes, LoadTheSameTwice) {
    REQUIRE_TEST_DATA();
    for (const char* name :
         {"lantern/lantern_obj.obj", "misc/knot_max_simplified.STL", "misc/matteonormb.ply"}) {
        const auto a = Mesh(test_data(name)).snapshot(), b = Mesh(test_data(name)).snapshot();
        EXPECT_EQ(a->V, b->V) << name;
        EXPECT_EQ(a->F, b->F) << name;
        EXPECT_EQ(a->UV, b->UV) << name;
    }
}

}  // namespace easypbr::mesh_files_test
