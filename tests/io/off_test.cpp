#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_readers.h"

namespace easypbr::off_test {

namespace {

MeshData read(const std::string& text) {
    MeshData mesh = io::read_off(io::Source(std::string_view(text), "test.off"));
    validate(mesh);
    return mesh;
}

}  // namespace

TEST(Off, ReadsPolygonsCommentsAndCountsOnEitherLine) {
    for (const std::string head :
         {"OFF\n4 2 5\n", "OFF 4 2 5\n", "# made by a test\nOFF # kind\n\n4 2 5 # counts\n", "OFF4 2 5\n"}) {
        const MeshData mesh =
            read(head + "0 0 0\n1 0 0 # corner\n\n1 1 0\n# comment\n0 1 0\n4 0 1 2 3\n3 2 1 0\n");
        ASSERT_EQ(mesh.V.rows(), 4);
        EXPECT_EQ(Vec3(mesh.V.row(2)), Vec3(1, 1, 0));
        ASSERT_EQ(mesh.F.rows(), 3);
        EXPECT_EQ(mesh.source_face(1), 0);
        EXPECT_EQ(mesh.F(2, 0), 2);
        EXPECT_TRUE(mesh.C.empty());
    }
}

const std::string square = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Off, FacesMayHaveColors) {
    const MeshData mesh = read(square + "3 0 1 2 255 0 0 # red\n3 0 2 3 0 0 51\n");
    ASSERT_EQ(mesh.V.rows(), 6) << "a vertex for each colour";
    ASSERT_EQ(mesh.C.cols(), 3);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(Vec3(mesh.C.row(mesh.F(0, k))), Vec3(1, 0, 0));
        // Codes of 16 bits are exact for those of 8.
        EXPECT_FLOAT_EQ(mesh.C(mesh.F(1, k), 2), 0.2f);
    }
    EXPECT_EQ(Vec3(mesh.V.row(mesh.F(1, 1))), Vec3(1, 1, 0));
    EXPECT_EQ(mesh.source_vertex(mesh.F(1, 1)), 2);
    const MeshData some = read(square + "3 0 1 2 0 0.5 0 0.25\n3 0 2 3\n");
    ASSERT_EQ(some.C.cols(), 4);
    EXPECT_NEAR(some.C(some.F(0, 0), 3), 0.25f, 1e-5f) << "codes of 16 bits";
    EXPECT_EQ(some.C.row(some.F(1, 0)).minCoeff(), 1) << "white";
}

// Samples of the faces do not hit the one.
TEST(Off, OneFaceOfManyMayHaveAColor) {
    constexpr int count = 20001, colored = 12346;
    std::string text = fmt::format("OFF\n4 {} 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n", count);
    for (int i = 0; i < count; ++i) text += i == colored ? "3 0 1 2 255 0 0\n" : "3 0 2 3\n";
    const MeshData mesh = read(text);
    ASSERT_EQ(mesh.C.rows(), mesh.V.rows());
    EXPECT_EQ(Vec3(mesh.C.row(mesh.F(colored, 0))), Vec3(1, 0, 0));
    EXPECT_EQ(Vec3(mesh.C.row(mesh.F(0, 0))), Vec3(1, 1, 1)) << "white beside it";
}

TEST(Off, SaysWhichColorsOfFacesAreLeftOut) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    EXPECT_TRUE(read(square + "3 0 1 2 7\n3 0 2 3 9\n").C.empty());
    const std::string colored = "COFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n3 0 1 2 1 0 0\n";
    EXPECT_EQ(Vec3(read(colored).C.row(0)), Vec3(0, 0, 1));
    EXPECT_TRUE(read(square + "3 0 1 2\n3 0 2 3\n").C.empty());
    set_log_sink({});
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("2 faces have colours of a colour map"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("the vertices have colours"), std::string::npos) << warnings[1];
}

TEST(Off, ReadsAttributesInTheOrderOfTheManual) {
    const MeshData mesh = read("STCNOFF\n1 0 0\n1 2 3  0 1 0  255 0 51 255  0.25 0.75\n");
    EXPECT_EQ(Vec3(mesh.N.row(0)), Vec3(0, 1, 0));
    ASSERT_EQ(mesh.C.cols(), 4);
    EXPECT_FLOAT_EQ(mesh.C(0, 2), 0.2f);
    EXPECT_EQ(Vec2(mesh.UV.row(0)), Vec2(0.25f, 0.75f));
    EXPECT_EQ(read("NOFF\n1 0 0\n1 2 3 0 0 1\n").N(0, 2), 1);
    EXPECT_EQ(read("COFF\n1 0 0\n1 2 3 1 0.5 0\n").C(0, 1), 0.5f) << "real colours are taken as they are";
    EXPECT_EQ(read("COFF\n1 0 0\n1 2 3 1.0001 0.5 0\n").C(0, 1), 0.5f) << "what was rounded is no code";
    EXPECT_EQ(read("OFF\n1 0 0\n1 2 3 255 0 0\n").C.cols(), 3) << "colours of a plain OFF";
}

}  // namespace easypbr::off_test
