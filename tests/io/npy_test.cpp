#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/npy_builder.h"

namespace easypbr::npy_test {

namespace {

MeshData read(const std::string& bytes) {
    MeshData mesh = io::read_npy(io::Source(std::string_view(bytes), "test.npy"));
    validate(mesh);
    return mesh;
}

MeshData read_archive(const std::vector<std::pair<std::string, std::string>>& entries) {
    const std::string bytes = npz(entries);
    MeshData mesh = io::read_npz(io::Source(std::string_view(bytes), "test.npz"));
    validate(mesh);
    return mesh;
}

template <class T>
std::string values(std::initializer_list<T> list) {
    return Bytes().add_all(list).str();
}

std::string reversed(const std::string& numbers, size_t size) {
    std::string out = numbers;
    for (size_t i = 0; i + size <= out.size(); i += size)
        std::reverse(out.begin() + long(i), out.begin() + long(i + size));
    return out;
}

const std::string triangle = npy("'<f4'", "(3, 3)", values<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));

}  // namespace

TEST(Npy, ReadsPositionsOfEveryTypeOrderAndVersion) {
    const auto expect = [](const std::string& bytes, const std::string& what) {
        const MeshData mesh = read(bytes);
        ASSERT_EQ(mesh.V.rows(), 2) << what;
        EXPECT_EQ(Vec3(mesh.V.row(0)), Vec3(1, 2, 3)) << what;
        EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6)) << what;
    };
    const std::string f4 = values<float>({1, 2, 3, 4, 5, 6}), f8 = values<double>({1, 2, 3, 4, 5, 6});
    expect(npy("'<f4'", "(2, 3)", f4), "float32");
    expect(npy("'<f8'", "(2, 3)", f8), "float64");
    expect(npy("'>f8'", "(2, 3)", reversed(f8, 8)), "big-endian");
    expect(npy("'<i8'", "(2, 3)", values<int64_t>({1, 2, 3, 4, 5, 6})), "int64");
    expect(npy("'|u1'", "(2, 3)", values<uint8_t>({1, 2, 3, 4, 5, 6})), "uint8");
    expect(npy("'<f2'", "(2, 3)", values<uint16_t>({0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600})),
           "float16");
    expect(npy("'<f4'", "(2, 3)", values<float>({1, 4, 2, 5, 3, 6}), true), "Fortran order");
    expect(npy("'<f4'", "(2, 1, 3)", f4), "three dimensions");
    expect(npy("'<f4'", "(2, 3)", f4, false, 2), "version 2");
}

TEST(Npy, TellsColumnsFromTheirNumbers) {
    const MeshData mesh =
        read(npy("'<f8'", "(2, 7)", values<double>({1, 2, 3, 0.5, 255, 51, 0, 4, 5, 6, 0.25, 0, 0, 255})));
    EXPECT_EQ(mesh.I[1], 0.25f);
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.2f, 0));
    const MeshData columns =
        read(npy("'<f8'", "(2, 4)", values<double>({1, 4, 2, 5, 3, 6, 0.5, 0.25}), true));
    EXPECT_EQ(columns.I[1], 0.25f);
}

TEST(Npy, ReadsStructuredArraysByTheirNames) {
    const std::string descr =
        "[('xyz', '<f4', (3,)), ('rgb', '|u1', (3,)), ('', '|V1'), (('heat of it', 'heat'), '<f8'), "
        "('label', '<i8'), "
        "('name', '<U2')]";
    Bytes data;
    for (int i = 0; i < 2; ++i) {
        data.add_all({1.0f + 3 * i, 2.0f + 3 * i, 3.0f + 3 * i}).add_all<uint8_t>({255, 51, 0, 99});
        data.add(0.5 * i).add(int64_t(i ? 1'000'000'000'000 : 7)).add(uint64_t(0));
    }
    const MeshData mesh = read(npy(descr, "(2,)", data.str()));
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6));
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.2f, 0));
    EXPECT_EQ(scalar_named(mesh, "heat").values[1], 0.5f);
    EXPECT_EQ(mesh.L[0], 7);
    EXPECT_EQ(mesh.L[1], -1) << "what no label can be is none";
    EXPECT_EQ(mesh.scalars.size(), 1u);
}

TEST(Npy, ReadsPackedColorsOfStructuredArrays) {
    const uint32_t bits = 0x80ff3300;  // Alpha 128, red 255, green 51, blue 0.
    const Vec4 color(1, 0.2f, 0, float(128 / 255.0));
    const std::string data = Bytes().add_all({1.0f, 2.0f, 3.0f}).add(bits).str();
    for (const std::string order : {"<", ">"})
        for (const std::string type : {"f4", "u4", "i4"})
            for (const std::string name : {"rgb", "rgba"}) {
                std::string descr;
                for (const char* axis : {"x", "y", "z"})
                    descr += "('" + std::string(axis) + "', '" + order + "f4'), ";
                descr = "[" + descr + "('" + name + "', '" + order + type + "')]";
                const std::string array = npy(descr, "(1,)", order == "<" ? data : reversed(data, 4));
                for (const MeshData& mesh : {read(array), read_archive({{"points.npy", array}})}) {
                    EXPECT_EQ(Vec3(mesh.V.row(0)), Vec3(1, 2, 3)) << descr;
                    ASSERT_EQ(mesh.C.cols(), name == "rgba" ? 4 : 3) << descr;
                    EXPECT_EQ(Vec3(mesh.C.row(0).head(3)), Vec3(color.head(3))) << descr;
                    EXPECT_EQ(mesh.C.row(0)[mesh.C.cols() - 1], color[mesh.C.cols() - 1]) << descr;
                    EXPECT_TRUE(mesh.scalars.empty()) << descr;
                }
            }
}

TEST(Npy, NamedColorsWinOverPackedOnes) {
    const std::string descr =
        "[('xyz', '<f4', (3,)), ('rgb', '<f4'), ('r', '|u1'), ('g', '|u1'), ('b', '|u1')]";
    const std::string data =
        Bytes().add_all({1.0f, 2.0f, 3.0f}).add(0x00ff0000u).add_all<uint8_t>({0, 255, 0}).str();
    const MeshData mesh = read(npy(descr, "(1,)", data));
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(0, 1, 0));
    EXPECT_TRUE(mesh.scalars.empty());
}

TEST(Npy, WarnsWhereFloatTakesWhatTellsIntensitiesApart) {
    const auto warnings_of = [](double first, double second) {
        std::vector<std::string> warnings;
        set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
        const MeshData mesh = read(npy("'<f8'", "(2, 4)", values<double>({0, 0, 0, first, 1, 1, 1, second})));
        set_log_sink({});
        EXPECT_EQ(mesh.I[1], float(second));
        return warnings;
    };
    // Numbers of float32 are 128 apart at 1.7e9.
    const auto warnings = warnings_of(1.7e9, 1.7e9 + 0.5);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("intensities are kept as float32, which holds 1700000000 and 1700000000.5"),
              std::string::npos)
        << warnings[0];
    EXPECT_TRUE(warnings_of(0.25, 0.1).empty());
}

TEST(Npy, KeepsMillimetres) {
    Bytes data;
    for (int i = 0; i < 100; ++i) data.add_all<double>({691'000.125 + i, 5'335'000.25 + 0.001 * i, 520.5});
    const MeshData mesh = read(npy("'<f8'", "(100, 3)", data.str()));
    for (int i = 0; i < 100; ++i) {
        const Vec3d p = mesh.offset + mesh.V.row(i).transpose().cast<double>();
        // Half the spacing of float32 numbers up to 128.
        EXPECT_LE((p - Vec3d(691'000.125 + i, 5'335'000.25 + 0.001 * i, 520.5)).cwiseAbs().maxCoeff(),
                  std::exp2(-18.0));
    }
}

TEST(Npz, ReadsNamedArrays) {
    const MeshData mesh =
        read_archive({{"V.npy", triangle},
                      {"F.npy", npy("'<i8'", "(1, 3)", values<int64_t>({0, 1, 2}))},
                      {"N.npy", npy("'<f8'", "(3, 3)", values<double>({0, 0, 2, 0, 0, 2, 0, 0, 2}))},
                      {"C.npy", npy("'|u1'", "(3, 3)", values<uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255}))},
                      {"UV.npy", npy("'<f4'", "(3, 2)", values<float>({0, 1, 2, 3, 4, 5}))},
                      {"L.npy", npy("'<i4'", "(3,)", values<int32_t>({7, 8, 9}))},
                      {"I.npy", npy("'<f4'", "(3, 1)", values<float>({1, 2, 3}))},
                      {"E.npy", npy("'<u4'", "(1, 2)", values<uint32_t>({2, 0}))},
                      {"heat.npy", npy("'<f4'", "(3,)", values<float>({10, 11, 12}))},
                      {"area.npy", npy("'<f4'", "(1,)", values<float>({0.5}))},
                      {"pair.npy", npy("'<f4'", "(3, 2)", values<float>({1, 2, 3, 4, 5, 6}))},
                      {"offset.npy", npy("'<f8'", "(3,)", values<double>({1000, 2000, 3000}))},
                      {"readme.txt", "not an array"}});
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(1, 0, 0));
    EXPECT_EQ(mesh.offset, Vec3d(1000, 2000, 3000));
    EXPECT_EQ(mesh.F(0, 2), 2);
    EXPECT_EQ(Vec3(mesh.N.row(2)), Vec3(0, 0, 1));
    EXPECT_EQ(Vec3(mesh.C.row(1)), Vec3(0, 1, 0));
    EXPECT_EQ(Vec2(mesh.UV.row(1)), Vec2(2, 3));
    EXPECT_EQ(mesh.L[2], 9);
    EXPECT_EQ(mesh.I[2], 3);
    EXPECT_EQ(mesh.E(0, 0), 2);
    EXPECT_EQ(scalar_named(mesh, "heat").values[2], 12);
    EXPECT_EQ(scalar_named(mesh, "area").values.rows(), 1);
    EXPECT_EQ(scalar_named(mesh, "pair_1").values[2], 6);
}

TEST(Npz, ReadsWhatOthersCallTheirArrays) {
    for (const char* name : {"points", "xyz", "Vertices", "arr_0"}) {
        const MeshData mesh = read_archive({{std::string(name) + ".npy", triangle}});
        EXPECT_EQ(mesh.V.rows(), 3) << name;
    }
    const MeshData mesh = read_archive({{"points.npy", triangle},
                                        {"colors.npy", npy("'<f4'", "(3, 4)", std::string(48, '\0'))},
                                        {"labels.npy", npy("'<i8'", "(3,)", values<int64_t>({1, 2, 3}))}});
    EXPECT_EQ(mesh.C.cols(), 4);
    EXPECT_EQ(mesh.L[2], 3);
}

TEST(Npz, NamesOfOneLetterCountByCase) {
    const std::string numbers = npy("'<f4'", "(3,)", values<float>({4, 5, 6}));
    std::vector<std::pair<std::string, std::string>> entries{{"v.npy", triangle}};
    const std::vector<std::string> names{"b", "c", "e", "g", "i", "l", "n", "r", "s", "t", "u", "x"};
    for (const std::string& name : names) entries.emplace_back(name + ".npy", numbers);
    const MeshData mesh = read_archive(entries);
    EXPECT_EQ(mesh.scalars.size(), names.size());
    for (const std::string& name : names) EXPECT_EQ(scalar_named(mesh, name).values[2], 6) << name;
    EXPECT_TRUE(mesh.B.empty() && mesh.I.empty() && mesh.L.empty() && mesh.C.empty() && mesh.E.empty());
    const MeshData capitals =
        read_archive({{"V.npy", triangle}, {"T.npy", triangle}, {"B.npy", numbers}, {"I.npy", numbers}});
    EXPECT_TRUE(capitals.scalars.empty());
    EXPECT_EQ(capitals.T(1, 0), 1);
    EXPECT_EQ(capitals.B[2], 6);
    EXPECT_EQ(capitals.I[2], 6);
}

// Four vertices and three faces: three values are those of the faces.
TEST(Npz, ValuesOfFacesMayHaveNamesOfOneLetter) {
    const MeshData mesh = read_archive(
        {{"points.npy", npy("'<f4'", "(4, 3)", values<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}))},
         {"f.npy", npy("'<i4'", "(3, 3)", values<int32_t>({0, 1, 2, 0, 2, 3, 0, 3, 1}))},
         {"e.npy", npy("'<f4'", "(3,)", values<float>({4, 5, 6}))},
         {"l.npy", npy("'<f4'", "(3,)", values<float>({7, 8, 9}))}});
    EXPECT_EQ(mesh.F.rows(), 3);
    EXPECT_EQ(scalar_named(mesh, "e").values[2], 6);
    EXPECT_EQ(scalar_named(mesh, "l").values[2], 9);
    EXPECT_TRUE(mesh.L.empty());
}

TEST(Npz, CutsPolygonsAndKeepsTheirValues) {
    const MeshData mesh =
        read_archive({{"V.npy", npy("'<f4'", "(4, 3)", values<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}))},
                      {"F.npy", npy("'<i4'", "(1, 4)", values<int32_t>({0, 1, 2, 3}))},
                      {"L.npy", npy("'<i4'", "(1,)", values<int32_t>({5}))}});
    EXPECT_EQ(mesh.F.rows(), 2);
    EXPECT_EQ(mesh.L.rows(), 2);
    EXPECT_EQ(mesh.L[1], 5);
}

TEST(Npz, FacesKeepTheirValuesWhenThereAreAsManyVertices) {
    // Two quads are four triangles of four vertices.
    const MeshData mesh =
        read_archive({{"V.npy", npy("'<f4'", "(4, 3)", values<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}))},
                      {"F.npy", npy("'<i4'", "(2, 4)", values<int32_t>({0, 1, 2, 3, 3, 2, 1, 0}))},
                      {"L.npy", npy("'<i4'", "(2,)", values<int32_t>({5, 6}))}});
    ASSERT_EQ(mesh.L.rows(), 4);
    EXPECT_EQ(element_of(mesh, mesh.L.rows()), PerElement::face);
    EXPECT_EQ(mesh.L[1], 5);
    EXPECT_EQ(mesh.L[2], 6);
    EXPECT_EQ(mesh.V.rows(), 5);
}

TEST(Npz, LeavesOutWhatItDoesNotUnderstandWithAWarning) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    read_archive({{"V.npy", triangle},
                  {"pose.npy", npy("'<f8'", "(4, 4)", std::string(128, '\0'))},
                  {"words.npy", npy("'<U3'", "(3,)", std::string(36, '\0'))},
                  {"objects.npy", npy("'|O'", "(3,)", std::string(24, '\0'))}});
    set_log_sink({});
    ASSERT_EQ(warnings.size(), 3u);
    EXPECT_NE(warnings[0].find("'words'"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("Python objects"), std::string::npos) << warnings[1];
    EXPECT_NE(warnings[2].find("'pose' of shape (4, 4)"), std::string::npos) << warnings[2];
}

}  // namespace easypbr::npy_test
