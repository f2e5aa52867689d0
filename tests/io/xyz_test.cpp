#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_readers.h"

namespace easypbr::xyz_test {

namespace {

MeshData read(const std::string& text, const std::string& name = "test.xyz") {
    MeshData mesh = io::read_xyz(io::Source(std::string_view(text), name), extension_of(name) == "pts");
    validate(mesh);
    return mesh;
}

/// The warnings that reading gives.
std::vector<std::string> warnings_of(const std::string& text, const std::string& name = "test.xyz") {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    read(text, name);
    set_log_sink({});
    return warnings;
}

std::string names_of(const MeshData& mesh) {
    std::string names;
    if (!mesh.N.empty()) names += "N ";
    if (!mesh.C.empty()) names += fmt::format("C{} ", mesh.C.cols());
    if (!mesh.I.empty()) names += "I ";
    if (!mesh.L.empty()) names += "L ";
    for (const ScalarArray& scalar : mesh.scalars) names += scalar.name + " ";
    return names;
}

}  // namespace

TEST(Xyz, ReadsPositionsBetweenWhateverSeparatesThem) {
    for (const std::string text :
         {"1 2 3\n4 5 6\n", "1\t2\t3\n4\t5\t6", "1,2,3\r\n4,5,6\r\n", "1, 2, 3\n4 ,5 , 6\n", "1;2;3\n4;5;6\n",
          "  1   2 3  \n\n\n4 5 6\n\n", "# comment\n1 2 3\n# another\n4 5 6\n",
          "\xef\xbb\xbf"
          "1 2 3\n4 5 6\n",
          "1e0 +2 3.0\n4 5 6\n"}) {
        const MeshData mesh = read(text);
        ASSERT_EQ(mesh.V.rows(), 2) << text;
        EXPECT_EQ(Vec3(mesh.V.row(0)), Vec3(1, 2, 3)) << text;
        EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6)) << text;
        EXPECT_EQ(names_of(mesh), "") << text;
    }
}

TEST(Xyz, ReadsNamedColumns) {
    for (const std::string header : {"label,X,Y,Z,Red,Green,Blue,height\n", "# label,x,y,z,r,g,b,height\n",
                                     "//label,X,Y,Z,R,G,B,scalar_height\n",
                                     "\"label\",\"x (m)\",\"y (m)\",\"z (m)\",red,green,blue,height[m]\n",
                                     "# made by hand\nclassification,x,y,z,r,g,b,height\n"}) {
        const MeshData mesh = read(header + "7,1,2,3,255,51,0,0.5\n8,4,5,6,0,0,255,0.25\n", "test.csv");
        ASSERT_EQ(mesh.V.rows(), 2) << header;
        EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6)) << header;
        EXPECT_EQ(mesh.L[1], 8) << header;
        EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.2f, 0)) << header;
        EXPECT_EQ(scalar_named(mesh, "height").values[1], 0.25f) << header;
    }
}

// CloudCompare's colours in 0 .. 1, and the texture coordinates of Matterport's scans.
TEST(Xyz, ReadsFloatColorsAndTextureCoordinatesOfOtherPrograms) {
    const MeshData colored = read("//X Y Z Rf Gf Bf\n0 0 0 0.25 0.5 1\n1 0 0 0 0 0\n");
    EXPECT_EQ(names_of(colored), "C3 ");
    // Codes of 16 bits hold 0 and 1 exactly, others to half a code.
    EXPECT_NEAR(colored.C(0, 0), 0.25f, 1 / 65535.0f);
    EXPECT_EQ(colored.C(0, 2), 1);
    EXPECT_EQ(names_of(read("//X Y Z Rf Gf Bf Af\n0 0 0 0 1 1 0.5\n")), "C4 ");
    const MeshData mapped = read("x,y,z,tx,ty\n0,0,0,0.25,0.75\n");
    EXPECT_EQ(names_of(mapped), "");
    ASSERT_EQ(mapped.UV.rows(), 1);
    EXPECT_EQ(mapped.UV(0, 1), 0.75f);
    const MeshData surfels = read("x,y,z,tx,ty,tz\n0,0,0,1,0,0\n");
    EXPECT_TRUE(surfels.UV.empty());
    EXPECT_EQ(surfels.T.rows(), 1);
}

TEST(Xyz, TellsColumnsWithoutNamesFromTheirNumbers) {
    const auto expect = [](const std::string& rows, const std::string& names,
                           const std::string& file = "t.xyz") {
        EXPECT_EQ(names_of(read(rows, file)), names) << rows;
    };
    expect("1 2 3 0.5\n1 2 3 17\n", "I ");
    expect("1 2 3 255 128 0\n1 2 3 4 5 6\n", "C3 ");
    expect("1 2 3 0.6 0 0.8\n1 2 3 0 1 0\n", "N ");
    expect("1 2 3 0.5 0.5 0.5\n1 2 3 0 1 0.25\n", "C3 ");
    expect("1 2 3 100.5 0.5 -7\n1 2 3 0 1 0.25\n", "column_4 column_5 column_6 ");
    expect("1 2 3 255 128 0 0 0 1\n1 2 3 4 5 6 0 1 0\n", "N C3 ");
    expect("1 2 3 0 0 1 255 128 0\n1 2 3 0 1 0 4 5 6\n", "N C3 ");
    expect("1 2 3 0.5 255 128 0\n1 2 3 0.25 4 5 6\n", "C3 I ");
    expect("1 2 3 255 128 0 4\n1 2 3 4 5 6 7\n", "C3 L ");
    expect("1 2 3 255 128 0 0.5\n1 2 3 4 5 6 0.75\n", "C3 I ");
    expect("1 2 3 0.5 255 128 0 0 0 1 7\n1 2 3 1.5 4 5 6 0 1 0 8\n", "N C3 I L ");
    // PTS has intensities before colours, also where both would do.
    expect("2\n1 2 3 7 255 128 0\n1 2 3 8 4 5 6\n", "C3 I ", "t.pts");
    EXPECT_EQ(read("2\n1 2 3 7 255 128 0\n1 2 3 8 4 5 6\n", "t.pts").I[1], 8);
}

TEST(Xyz, KeepsMillimetres) {
    std::string text = "Easting;Northing;Height\n";
    for (int i = 0; i < 100; ++i)
        text += fmt::format("{};{};520.5\n", 691'000.125 + i, 5'335'000.25 + 0.001 * i);
    const MeshData mesh = read(text, "far.csv");
    for (int i = 0; i < 100; ++i) {
        const Vec3d p = mesh.offset + mesh.V.row(i).transpose().cast<double>();
        // Half the spacing of float32 numbers up to 128.
        EXPECT_LE((p - Vec3d(691'000.125 + i, 5'335'000.25 + 0.001 * i, 520.5)).cwiseAbs().maxCoeff(),
                  std::exp2(-18.0));
    }
}

TEST(Xyz, LeavesOutRowsWithoutPositionAndColumnsOfWords) {
    const std::string text = "x,y,z,name,heat\n1,2,3,tree,5\nnan,2,3,bush,6\n,2,3,,7\n4,5,6,old tree,\n";
    const auto warnings = warnings_of(text, "test.csv");
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("words are left out: name"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("2 of 4 points"), std::string::npos) << warnings[1];
    const MeshData mesh = read(text, "test.csv");
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6));
    EXPECT_EQ(scalar_named(mesh, "heat").values[0], 5);
    EXPECT_TRUE(std::isnan(scalar_named(mesh, "heat").values[1])) << "an empty cell has no value";
    EXPECT_EQ(mesh.source_vertex[1], 3);
}

TEST(Xyz, CommentsMayStandAnywhere) {
    for (const std::string text :
         {"1 2 3\n// between\n4 5 6\n", "1 2 3 # behind\n4 5 6 #behind\n", "1 2 3 // behind\n4 5 6\n",
          "1,2,3 # behind, with a comma\n4,5,6\n", "x y z\n1 2 3\n4 5 6 # end\n"}) {
        EXPECT_TRUE(warnings_of(text).empty()) << text;
        const MeshData mesh = read(text);
        ASSERT_EQ(mesh.V.rows(), 2) << text;
        EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6)) << text;
        EXPECT_EQ(names_of(mesh), "") << text;
    }
}

TEST(Xyz, QuotedCellsMayHoldDelimiters) {
    const std::string text = "\"name, of it\",x,y,z,heat\n\"a, b\",1,2,3,4\n\"say \"\"c;\"\"\",4,5,6,\"7\"\n";
    const MeshData mesh = read(text, "a.csv");
    ASSERT_EQ(mesh.V.rows(), 2);
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6));
    EXPECT_EQ(scalar_named(mesh, "heat").values[1], 7) << "a number in quotes";
    const auto warnings = warnings_of(text, "a.csv");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("words are left out: name, of it"), std::string::npos) << warnings[0];
}

TEST(Xyz, TheLastCellMayBeEmpty) {
    for (const std::string header : {"x,y,z,s\n", "x,y,z,s,\n"}) {
        const MeshData mesh = read(header + "1,2,3,\n4,5,6,7\n", "a.csv");
        ASSERT_EQ(mesh.V.rows(), 2) << header;
        EXPECT_TRUE(std::isnan(scalar_named(mesh, "s").values[0]));
        EXPECT_EQ(scalar_named(mesh, "s").values[1], 7);
    }
    const MeshData two = read("x,y,z,s,w\n1,2,3,,\n4,5,6,7,8\n", "a.csv");
    EXPECT_TRUE(std::isnan(scalar_named(two, "w").values[0]));
    EXPECT_EQ(scalar_named(two, "w").values[1], 8);
    EXPECT_EQ(read("1,2,3,\n4,5,6,7\n", "a.csv").I[1], 7) << "without a header";
    // A delimiter at the end of all rows separates nothing.
    for (const std::string text : {"1,2,3,\n4,5,6,\n", "x,y,z\n1,2,3,\n4,5,6,\n", "x,y,z,\n1,2,3,\n4,5,6,\n",
                                   "x,y,z,\n1,2,3\n4,5,6\n"}) {
        EXPECT_EQ(read(text, "a.csv").V.rows(), 2) << text;
        EXPECT_EQ(names_of(read(text, "a.csv")), "") << text;
    }
}

TEST(Xyz, CellsBetweenTabsMayBeEmptyBelowNames) {
    const MeshData mesh = read("heat\tx\ty\tz\tdepth of it\n5\t1\t2\t3\t\n\t4\t5\t6\t7\n\t7\t8\t9\t\r\n");
    ASSERT_EQ(mesh.V.rows(), 3);
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6));
    EXPECT_EQ(Vec3(mesh.V.row(2)), Vec3(7, 8, 9));
    const Array1f &heat = scalar_named(mesh, "heat").values,
                  &depth = scalar_named(mesh, "depth of it").values;
    EXPECT_EQ(heat[0], 5);
    EXPECT_TRUE(std::isnan(heat[1]));
    EXPECT_TRUE(std::isnan(depth[0]));
    EXPECT_EQ(depth[1], 7);
    EXPECT_TRUE(std::isnan(depth[2]));
    // Tabs that align columns are blanks.
    EXPECT_EQ(Vec3(read("x\ty\tz\n1\t\t2\t\t3\n").V.row(0)), Vec3(1, 2, 3));
    EXPECT_EQ(Vec3(read("x\ty\tz\n  1\t2 \t 3\n").V.row(0)), Vec3(1, 2, 3));
}

TEST(Xyz, LabelsThatAreNoneAreCounted) {
    const std::string text =
        "x,y,z,label\n1,2,3,4.0\n1,2,3,4.5\n1,2,3,4294967296\n1,2,3,-2147483648\n"
        "1,2,3,2147483647\n1,2,3,\n";
    const MeshData mesh = read(text, "a.csv");
    EXPECT_EQ(std::vector<int>(mesh.L.data(), mesh.L.data() + mesh.L.size()),
              (std::vector<int>{4, -1, -1, INT32_MIN, INT32_MAX, -1}));
    const auto warnings = warnings_of(text, "a.csv");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 values of 'label' are no integers"), std::string::npos) << warnings[0];
}

TEST(Xyz, InfiniteColorsAreFullOrNone) {
    const MeshData mesh = read("x y z red green blue\n0 0 0 inf .5 -inf\n1 0 0 .25 1 0\n", "test.xyz");
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.5f, 0));
    EXPECT_EQ(Vec3(mesh.C.row(1)), Vec3(0.25f, 1, 0));
}

TEST(Xyz, PtsHasItsCount) {
    EXPECT_EQ(read("2\n1 2 3\n4 5 6\n", "a.pts").V.rows(), 2);
    EXPECT_EQ(read("1\n1 2 3\n4 5 6\n", "a.pts").V.rows(), 1);
    const auto warnings = warnings_of("1\n1 2 3\n4 5 6\n", "a.pts");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("1 rows behind the 1 points"), std::string::npos) << warnings[0];
}

TEST(Xyz, HoldsForOnePointAndForManyChunks) {
    EXPECT_EQ(read("1 2 3\n").V.rows(), 1);
    // 3 MB: rows are counted and read in pieces of 1 MB.
    std::string text;
    for (int i = 0; i < 200'000; ++i) text += fmt::format("{} {} {} {}\n", i % 1000, i / 1000, 5, i);
    const MeshData mesh = read(text);
    ASSERT_EQ(mesh.V.rows(), 200'000);
    for (int i = 0; i < 200'000; i += 777) {
        EXPECT_EQ(Vec3(mesh.V.row(i)), Vec3(float(i % 1000), float(i / 1000), 5));
        EXPECT_EQ(mesh.I[i], float(i));
    }
}

TEST(Xyz, WarnsWhereFloatsDoNotTellNumbersApart) {
    const auto warnings = warnings_of("x,y,z,id,heat\n0,0,0,123456789,0.123456789\n1,0,0,123456791,0.2\n");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("'id'"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("123456789 and 123456791"), std::string::npos) << warnings[0];
}

}  // namespace easypbr::xyz_test
