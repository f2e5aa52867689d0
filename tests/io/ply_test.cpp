#include <array>
#include <bit>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/ply_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::ply_test {

namespace {

const std::vector<std::string> formats{"ascii", "binary_little_endian", "binary_big_endian"};

MeshData read(const std::string& text) {
    MeshData mesh = io::read_ply(io::Source(std::string_view(text), "test.ply"));
    validate(mesh);
    return mesh;
}

/// A tetrahedron's vertices; 100 keeps them exact in every type.
const std::vector<std::array<double, 3>> corners{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}};

Array3f::Dense expected_corners() {
    Array3f::Dense V(4, 3);
    V << 0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 0, 100;
    return V;
}

Array3i::Dense triangles(std::initializer_list<int> indices) {
    return Eigen::Map<const Array3i::Dense>(indices.begin(), Eigen::Index(indices.size() / 3), 3);
}

/// Header and vertices x y z as float; faces and more follow.
PlyBuilder with_vertices(const std::string& format, const std::string& more_header) {
    PlyBuilder ply(format);
    ply.header("element vertex 4\nproperty float x\nproperty float y\nproperty float z")
        .header(more_header)
        .end_header();
    for (const auto& corner : corners) ply.values("float", corner).end_row();
    return ply;
}

const std::string face_header = "property list uchar int vertex_indices";

}  // namespace

TEST(Ply, ReadsEveryTypeAndSpellingInEveryFormat) {
    const std::vector<std::string> types{"char",   "int8",    "uchar",  "uint8",  "short", "int16",
                                         "ushort", "uint16",  "int",    "int32",  "uint",  "uint32",
                                         "float",  "float32", "double", "float64"};
    for (const std::string& format : formats) {
        for (const std::string& type : types) {
            PlyBuilder ply(format);
            // Property order y, unknown, x, z, and an index list of the same type where that is an integer.
            ply.header("element vertex 4\nproperty " + type + " y\nproperty double extra\nproperty " + type +
                       " x\nproperty " + type + " z");
            const bool integer = type.find("float") == std::string::npos && type != "double";
            const std::string index = integer ? type : "int";
            ply.header("element face 2\nproperty list " + index + " " + index + " vertex_index").end_header();
            for (const auto& c : corners)
                ply.value(type, c[1]).value("double", 0.5).value(type, c[0]).value(type, c[2]).end_row();
            ply.values(index, {3, 0, 1, 2}).end_row().values(index, {3, 0, 3, 1}).end_row();
            const MeshData mesh = read(ply.text());
            EXPECT_EQ(mesh.V, expected_corners()) << format << " " << type;
            EXPECT_EQ(mesh.F, triangles({0, 1, 2, 0, 3, 1})) << format << " " << type;
            EXPECT_TRUE(mesh.source_face.empty());
        }
    }
}

TEST(Ply, ColorsOfEveryTypeAre0To1) {
    const auto color_of = [](const std::string& format, const std::string& type,
                             std::array<double, 3> color) {
        PlyBuilder ply(format);
        ply.header("element vertex 1\nproperty float x\nproperty float y\nproperty float z");
        for (const char* name : {"red", "green", "blue"}) ply.header("property " + type + " " + name);
        ply.end_header();
        ply.values("float", {1, 2, 3}).values(type, color).end_row();
        const MeshData mesh = read(ply.text());
        return Vec3(mesh.C.row(0));
    };
    for (const std::string& format : formats) {
        for (const char* type : {"uchar", "short", "int", "uint", "float", "double"})
            EXPECT_TRUE(color_of(format, type, {255, 51, 0}).isApprox(Vec3(1, 0.2f, 0), 1e-6f)) << type;
        for (const char* type : {"char", "short", "int", "uint", "float", "double"})
            EXPECT_EQ(color_of(format, type, {1, 0, 1}), Vec3(1, 0, 1)) << type;
        for (const char* type : {"ushort", "int", "float", "double"})
            EXPECT_TRUE(color_of(format, type, {65535, 13107, 0}).isApprox(Vec3(1, 0.2f, 0), 1e-6f)) << type;
        // 51 / 127 would be the range of the type.
        EXPECT_TRUE(color_of(format, "char", {51, 0, 102}).isApprox(Vec3(0.2f, 0, 0.4f), 1e-6f));
        EXPECT_EQ(color_of(format, "float", {1.25, 0.5, -0.25}), Vec3(1, 0.5f, 0));
    }
}

TEST(Ply, AlphaOfAnotherTypeLeavesColorsAsTheyAre) {
    for (const std::string& format : formats) {
        PlyBuilder ply(format);
        ply.header("element vertex 2\nproperty float x\nproperty float y\nproperty float z")
            .header("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float alpha")
            .end_header();
        for (const double alpha : {255.0, 51.0})
            ply.values("float", {0, 0, alpha}).values("uchar", {200, 0, 0}).value("float", alpha).end_row();
        const MeshData mesh = read(ply.text());
        ASSERT_EQ(mesh.C.cols(), 4) << format;
        EXPECT_FLOAT_EQ(mesh.C(0, 0), 200 / 255.0f) << format;
        EXPECT_FLOAT_EQ(mesh.C(0, 3), 1) << format;
        EXPECT_FLOAT_EQ(mesh.C(1, 3), 0.2f) << format;
    }
}

TEST(Ply, ReadsPackedColors) {
    for (const std::string& format : formats) {
        for (const std::string type : {"float", "uint", "int"}) {
            PlyBuilder ply(format);
            ply.header("element vertex 2\nproperty float x\nproperty float y\nproperty float z")
                .header("property " + type + " rgb")
                .end_header();
            for (const uint32_t bits : {0x00ff3300u, 0x0000ff66u})
                ply.values("float", {1, 2, 3})
                    .value(type, type == "float" ? double(std::bit_cast<float>(bits)) : double(bits))
                    .end_row();
            const MeshData mesh = read(ply.text());
            ASSERT_EQ(mesh.C.cols(), 3) << format << " " << type;
            EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.2f, 0)) << format << " " << type;
            EXPECT_EQ(Vec3(mesh.C.row(1)), Vec3(0, 1, 0.4f)) << format << " " << type;
            EXPECT_TRUE(mesh.scalars.empty()) << format << " " << type;
        }
        PlyBuilder ply(format);
        ply.header("element vertex 1\nproperty float x\nproperty float y\nproperty float z")
            .header("property int rgba")
            .end_header();
        ply.values("float", {1, 2, 3}).value("int", int32_t(0xff0000ffu)).end_row();
        EXPECT_EQ(Vec4(read(ply.text()).C.row(0)), Vec4(0, 0, 1, 1)) << format;
    }
}

TEST(Ply, CutsPolygonsIntoFansAndRemembersThem) {
    for (const std::string& format : formats) {
        PlyBuilder ply = with_vertices(format, "element face 3\n" + face_header);
        ply.values("uchar", {3}).values("int", {0, 1, 2}).end_row();
        ply.values("uchar", {4}).values("int", {0, 1, 2, 3}).end_row();
        ply.values("uchar", {2}).values("int", {0, 1}).end_row();
        const MeshData mesh = read(ply.text());
        EXPECT_EQ(mesh.F, triangles({0, 1, 2, 0, 1, 2, 0, 2, 3})) << format;
        ASSERT_EQ(mesh.source_face.rows(), 3);
        EXPECT_EQ(mesh.source_face(2), 1);
    }
}

TEST(Ply, ReadsManyFacesWhoseLastIsAPentagon) {
    // More rows than are read at once, so that the guess "all triangles" fails late.
    constexpr int faces = 70000;
    for (const std::string& format : formats) {
        PlyBuilder ply = with_vertices(format, "element face " + std::to_string(faces) + "\n" + face_header);
        for (int i = 0; i < faces - 1; ++i)
            ply.value("uchar", 3).values("int", {0, 1, double(i % 4)}).end_row();
        ply.value("uchar", 5).values("int", {3, 2, 1, 0, 2}).end_row();
        const MeshData mesh = read(ply.text());
        ASSERT_EQ(mesh.F.rows(), faces + 2) << format;
        EXPECT_EQ(mesh.F(69998, 2), 69998 % 4);
        EXPECT_EQ(mesh.F.bottomRows(3), triangles({3, 2, 1, 3, 1, 0, 3, 0, 2}));
        EXPECT_EQ(mesh.source_face(faces), faces - 1);
    }
}

TEST(Ply, CutsAConcaveQuadInside) {
    // An arrowhead: vertex 1 is the notch, so that only the diagonal 1-3 lies inside.
    PlyBuilder ply("ascii");
    ply.header("element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n" +
               face_header);
    ply.end_header().header("0 2 0\n0 1 0\n2 0 0\n0 5 0").header("4 0 1 2 3");
    const MeshData mesh = read(ply.text());
    ASSERT_EQ(mesh.F.rows(), 2);
    // 0 1 2 would turn the other way than 0 2 3; both halves of the right cut have the quad's orientation.
    for (int i = 0; i < 2; ++i) {
        const Vec3 a = mesh.V.row(mesh.F(i, 0)), b = mesh.V.row(mesh.F(i, 1)), c = mesh.V.row(mesh.F(i, 2));
        EXPECT_GT((b - a).cross(c - a).z(), 0) << "triangle " << i;
    }
}

TEST(Ply, ReadsStrips) {
    for (const std::string& format : formats) {
        PlyBuilder ply = with_vertices(format, "element tristrips 1\nproperty list int int vertex_indices");
        ply.values("int", {9, 0, 1, 2, 3, -1, 3, 2, 2, 1}).end_row();
        // Every second triangle of a strip is wound the other way round; those with a repeated index are
        // none.
        EXPECT_EQ(read(ply.text()).F, triangles({0, 1, 2, 2, 1, 3})) << format;
    }
}

TEST(Ply, SkipsUnknownElements) {
    for (const std::string& format : formats) {
        PlyBuilder ply(format);
        ply.header("comment made by a test\nobj_info nothing\nelement camera 2\nproperty double focal");
        ply.header(
            "property list ushort float samples\nelement vertex 4\nproperty float x\nproperty float y");
        ply.header("property float z\nproperty list uchar int neighbours\nelement face 1")
            .header(face_header);
        ply.header("property uchar flags\nproperty list int double weights").end_header();
        ply.value("double", 1).value("ushort", 2).values("float", {1, 2}).end_row();
        ply.value("double", 1).value("ushort", 0).end_row();
        for (const auto& c : corners) ply.values("float", c).value("uchar", 1).value("int", 7).end_row();
        ply.value("uchar", 3)
            .values("int", {1, 2, 3})
            .value("uchar", 9)
            .value("int", 1)
            .value("double", 0.5)
            .end_row();
        const MeshData mesh = read(ply.text());
        EXPECT_EQ(mesh.V, expected_corners()) << format;
        EXPECT_EQ(mesh.F, triangles({1, 2, 3})) << format;
    }
}

TEST(Ply, ReadsAttributes) {
    for (const std::string& format : formats) {
        PlyBuilder ply(format);
        ply.header(
            "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty float nx");
        ply.header("property float ny\nproperty float nz\nproperty uchar red\nproperty uchar green");
        ply.header("property uchar blue\nproperty uchar alpha\nproperty float s\nproperty double t");
        ply.header("property int label\nproperty float intensity").end_header();
        ply.values("float", {1, 2, 3}).values("float", {0, 0, 2}).values("uchar", {255, 51, 0, 102});
        ply.value("float", 0.25).value("double", 0.75).value("int", -7).value("float", 12.5).end_row();
        const MeshData mesh = read(ply.text());
        EXPECT_EQ(Vec3(mesh.N.row(0)), Vec3(0, 0, 1)) << "normals are made unit";
        ASSERT_EQ(mesh.C.cols(), 4);
        // 1/255 is rounded once and multiplied once: two roundings of half a unit in the last place.
        EXPECT_NEAR(mesh.C(0, 0), 1.0f, 2e-7f);
        EXPECT_NEAR(mesh.C(0, 1), 0.2f, 2e-7f);
        EXPECT_NEAR(mesh.C(0, 3), 0.4f, 2e-7f);
        EXPECT_EQ(mesh.UV(0, 0), 0.25f);
        EXPECT_EQ(mesh.UV(0, 1), 0.75f);
        EXPECT_EQ(mesh.L(0), -7);
        EXPECT_EQ(mesh.I(0), 12.5f);
        EXPECT_EQ(mesh.F.rows(), 0) << "a cloud needs no faces";
    }
}

TEST(Ply, ReadsAttributesUnderTheirOtherNames) {
    const std::vector<std::array<std::string, 2>> uv_names{
        {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    for (const auto& [u, v] : uv_names) {
        const MeshData mesh = read(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nproperty float " +
            u + "\nproperty float " + v +
            "\nproperty float diffuse_red\nproperty float diffuse_green\n"
            "property float diffuse_blue\nend_header\n0 0 0 0.5 0.25 1.5 0.5 -1\n");
        ASSERT_EQ(mesh.UV.rows(), 1);
        EXPECT_EQ(mesh.UV(0, 1), 0.25f);
        EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 0.5f, 0))
            << "real colours are taken as they are, within 0 .. 1";
    }
}

TEST(Ply, KeepsOtherPropertiesAsScalars) {
    for (const std::string& format : formats) {
        PlyBuilder ply(format);
        ply.header("element vertex 4\nproperty float x\nproperty float y\nproperty float z");
        ply.header("property uchar quality\nproperty double scalar_Height\nproperty int Scalar_Label");
        ply.header("element face 2\nproperty list uchar int vertex_indices\nproperty int class");
        ply.header("property float area").end_header();
        int i = 0;
        for (const auto& corner : corners) {
            ply.values("float", corner).value("uchar", 10 + i).value("double", -0.5 * i).value("int", 3 * i);
            ply.end_row(), ++i;
        }
        ply.value("uchar", 4).values("int", {0, 1, 2, 3}).value("int", 7).value("float", 1.5).end_row();
        ply.value("uchar", 3).values("int", {0, 1, 3}).value("int", 9).value("float", 2.5).end_row();
        const MeshData mesh = read(ply.text());
        ASSERT_EQ(mesh.scalars.size(), 3u) << format;
        EXPECT_EQ(scalar_named(mesh, "quality").values[3], 13);
        EXPECT_EQ(scalar_named(mesh, "Height").values[3], -1.5f) << "without CloudCompare's prefix";
        EXPECT_EQ(mesh.L[3], 9) << "labels of the vertices win over those of the faces";
        const Array1f area = scalar_named(mesh, "area").values;
        ASSERT_EQ(area.rows(), 3);
        EXPECT_EQ(Vec3(area), Vec3(1.5f, 1.5f, 2.5f)) << "both triangles of the quad have its value";
    }
}

TEST(Ply, ReadsLabelsOfFaces) {
    PlyBuilder ply = with_vertices("ascii", "element face 2\n" + face_header + "\nproperty uchar label");
    ply.values("uchar", {3}).values("int", {0, 1, 2}).value("uchar", 4).end_row();
    ply.values("uchar", {3}).values("int", {0, 1, 3}).value("uchar", 5).end_row();
    const MeshData mesh = read(ply.text());
    ASSERT_EQ(mesh.L.rows(), 2);
    EXPECT_EQ(mesh.L[1], 5);
}

TEST(Ply, FacesKeepTheirValuesWhenThereAreAsManyVertices) {
    const std::string tetrahedron =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float heat\nelement face 4\nproperty list uchar int vertex_indices\nproperty int label\n"
        "property float q\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n"
        "3 0 1 2 5 .5\n3 0 1 3 6 .25\n3 1 2 3 7 .125\n3 0 2 3 8 .75\n";
    const MeshData mesh = read(tetrahedron);
    EXPECT_EQ(mesh.F, triangles({0, 1, 2, 0, 1, 3, 1, 2, 3, 0, 2, 3}))
        << "no face uses the vertex that is new";
    ASSERT_EQ(mesh.L.rows(), 4);
    EXPECT_EQ(element_of(mesh, mesh.L.rows()), PerElement::face);
    EXPECT_EQ(Eigen::Vector4i(mesh.L), Eigen::Vector4i(5, 6, 7, 8));
    const Array1f q = scalar_named(mesh, "q").values;
    ASSERT_EQ(q.rows(), 4);
    EXPECT_EQ(Vec4(q), Vec4(0.5f, 0.25f, 0.125f, 0.75f));
    ASSERT_EQ(mesh.V.rows(), 5);
    EXPECT_EQ(Vec3(mesh.V.row(4)), Vec3(0, 0, 1));
    EXPECT_EQ(scalar_named(mesh, "heat").values[4], 4) << "values of the vertices have one more";
    EXPECT_EQ(mesh.source_vertex[4], 3);
    EXPECT_EQ(mesh.source_vertex[2], 2);
}

TEST(Ply, ColorsOfFacesSplitVertices) {
    for (const std::string& format : formats) {
        // Red, red and a quarter transparent green; vertices 1 and 2 belong to all.
        PlyBuilder ply(format);
        ply.header("element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 3");
        ply.header(face_header + "\nproperty uchar red\nproperty uchar green\nproperty uchar blue");
        ply.header("property uchar alpha\nproperty int label\nelement edge 1\nproperty int vertex1");
        ply.header("property int vertex2").end_header();
        for (const auto& corner : corners) ply.values("float", corner).end_row();
        ply.values("float", {7, 7, 7}).end_row();
        const auto face = [&](std::array<double, 3> vertices, std::array<double, 4> color, int label) {
            ply.value("uchar", 3)
                .values("int", vertices)
                .values("uchar", color)
                .value("int", label)
                .end_row();
        };
        face({0, 1, 2}, {255, 0, 0, 255}, 4);
        face({0, 2, 1}, {255, 0, 0, 255}, 5);
        face({1, 3, 2}, {0, 51, 0, 204}, 6);
        ply.values("int", {3, 1}).end_row();
        const MeshData mesh = read(ply.text());
        const Vec4 red(1, 0, 0, 1), green(0, 0.2f, 0, 0.8f);
        ASSERT_EQ(mesh.C.cols(), 4) << format;
        ASSERT_EQ(mesh.V.rows(), 7) << "vertices of faces of one colour are one";
        for (int corner = 0; corner < 3; ++corner) {
            EXPECT_EQ(Vec4(mesh.C.row(mesh.F(0, corner))), red);
            EXPECT_EQ(Vec4(mesh.C.row(mesh.F(1, corner))), red);
            EXPECT_TRUE(Vec4(mesh.C.row(mesh.F(2, corner))).isApprox(green, 1e-6f));
        }
        const std::vector<int> sources(mesh.source_vertex.data(), mesh.source_vertex.data() + 7);
        EXPECT_EQ(sources, (std::vector<int>{0, 1, 1, 2, 2, 3, 4}));
        EXPECT_EQ(Vec4(mesh.C.row(6)), Vec4(1, 1, 1, 1)) << "no face uses it";
        EXPECT_EQ(Vec3(mesh.V.row(mesh.E(0, 0))), Vec3(0, 0, 100)) << "edges follow";
        EXPECT_EQ(Eigen::Vector3i(mesh.L), Eigen::Vector3i(4, 5, 6));
        EXPECT_TRUE(mesh.scalars.empty());
    }
}

TEST(Ply, ColorsOfFacesAndTextureCoordinatesSplitVertices) {
    const MeshData mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
        "property float red\nproperty float green\nproperty float blue\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2 6 0 0 1 0 0 1 1 0 0\n3 1 3 2 6 1 0 1 1 0.5 0.5 0 1 0\n");
    // Vertex 2 has two texture coordinates, vertex 1 has one and two colours.
    ASSERT_EQ(mesh.V.rows(), 6);
    EXPECT_EQ(Vec2(mesh.UV.row(mesh.F(0, 2))), Vec2(0, 1));
    EXPECT_EQ(Vec2(mesh.UV.row(mesh.F(1, 2))), Vec2(0.5f, 0.5f));
    for (int corner = 0; corner < 3; ++corner) {
        EXPECT_EQ(Vec3(mesh.C.row(mesh.F(0, corner))), Vec3(1, 0, 0));
        EXPECT_EQ(Vec3(mesh.C.row(mesh.F(1, corner))), Vec3(0, 1, 0));
    }
    const std::vector<int> sources(mesh.source_vertex.data(), mesh.source_vertex.data() + 6);
    EXPECT_EQ(sources, (std::vector<int>{0, 1, 1, 2, 2, 3}));
}

TEST(Ply, ColorsOfVerticesWinOverThoseOfFaces) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const MeshData mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
        "property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nend_header\n0 0 0 0 0 255\n1 0 0 0 0 255\n0 1 0 0 0 255\n3 0 1 2 255 0 0\n");
    set_log_sink({});
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(0, 0, 1));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("colours of the faces are left out"), std::string::npos) << warnings[0];
}

TEST(Ply, NamesValuesOfFacesThatTheVerticesHaveToo) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const MeshData mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "property float quality\nproperty int label\nelement face 1\n"
        "property list uchar int vertex_indices\nproperty float quality\nproperty float area\n"
        "property int label\nend_header\n0 0 0 .25 1\n1 0 0 .5 2\n0 1 0 .75 3\n3 0 1 2 9 8 7\n");
    set_log_sink({});
    EXPECT_EQ(Vec3(scalar_named(mesh, "quality").values), Vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(Eigen::Vector3i(mesh.L), Eigen::Vector3i(1, 2, 3));
    EXPECT_EQ(scalar_named(mesh, "area").values[0], 8);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("'quality' of the faces are left out"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("labels of the faces are left out"), std::string::npos) << warnings[1];
}

TEST(Ply, LeavesOutPointsOfCloudsWithoutPosition) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const MeshData mesh = read(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty int label\nproperty float heat\nend_header\n"
        "nan 0 0 1 5\n1 2 3 2 6\n0 0 inf 3 7\n4 5 6 4 8\n");
    set_log_sink({});
    ASSERT_EQ(mesh.V.rows(), 2);
    EXPECT_EQ(Vec3(mesh.V.row(1)), Vec3(4, 5, 6));
    EXPECT_EQ(mesh.L[1], 4);
    EXPECT_EQ(scalar_named(mesh, "heat").values[0], 6);
    EXPECT_EQ(mesh.source_vertex[1], 3);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 of 4 points"), std::string::npos) << warnings[0];
}

TEST(Ply, SplitsVerticesByCornerTexcoords) {
    for (const std::string& format : formats) {
        // Two triangles share vertices 1 and 2; vertex 1 has one uv in both, vertex 2 has two.
        PlyBuilder ply = with_vertices(format, "element face 2\n" + face_header +
                                                   "\nproperty list uchar float texcoord\nelement edge 1\n"
                                                   "property int vertex1\nproperty int vertex2");
        ply.value("uchar", 3)
            .values("int", {0, 1, 2})
            .value("uchar", 6)
            .values("float", {0, 0, 1, 0, 0, 1})
            .end_row();
        ply.value("uchar", 3)
            .values("int", {1, 3, 2})
            .value("uchar", 6)
            .values("float", {1, 0, 0.5, 0.5, 1, 1})
            .end_row();
        ply.values("int", {3, 2}).end_row();
        const MeshData mesh = read(ply.text());
        ASSERT_EQ(mesh.V.rows(), 5) << format;
        const std::vector<int> sources(mesh.source_vertex.data(), mesh.source_vertex.data() + 5);
        EXPECT_EQ(sources, (std::vector<int>{0, 1, 2, 2, 3}));
        EXPECT_EQ(Vec2(mesh.UV.row(mesh.F(0, 2))), Vec2(0, 1));
        EXPECT_EQ(Vec2(mesh.UV.row(mesh.F(1, 2))), Vec2(1, 1));
        EXPECT_EQ(Vec2(mesh.UV.row(mesh.F(1, 1))), Vec2(0.5f, 0.5f));
        EXPECT_EQ(mesh.F(0, 1), mesh.F(1, 0)) << "equal uv stay one vertex";
        EXPECT_EQ(Vec3(mesh.V.row(mesh.E(0, 0))), Vec3(0, 0, 100)) << "edges follow";
    }
}

TEST(Ply, LoadsTexturesBesideTheFileAndWarnsOfMissingOnes) {
    const TemporaryFolder folder;
    io::save_image(Image(2, 2, 3, PixelType::u8), folder / "here.png");
    const std::string text =
        "ply\r\nformat ascii 1.0\r\ncomment TextureFile here.png\r\ncomment TextureFile gone.png\r\n"
        "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
        "element face 2\r\nproperty list uchar int vertex_indices\r\nproperty int texnumber\r\n"
        "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2 1\r\n3 2 1 0 0\r\n";
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const MeshData mesh = io::read_ply(io::Source(std::string_view(text), folder / "test.ply"));
    set_log_sink({});
    ASSERT_EQ(mesh.materials.size(), 2u);
    EXPECT_TRUE(mesh.materials[0].base_color_texture);
    EXPECT_EQ(mesh.materials[0].base_color, Vec3(1, 1, 1));
    EXPECT_FALSE(mesh.materials[1].base_color_texture);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("gone.png"), std::string::npos);
    // Faces are sorted by their texture.
    ASSERT_EQ(mesh.parts.size(), 2u);
    EXPECT_EQ(mesh.F, triangles({2, 1, 0, 0, 1, 2}));
    EXPECT_EQ(mesh.source_face(0), 1);
}

TEST(Ply, ReadsBinaryRowsAfterAWindowsHeader) {
    PlyBuilder ply("binary_little_endian");
    ply.header(
        "element vertex 1\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nend_header\r");
    ply.values("float", {13, 10, 2});
    EXPECT_EQ(Vec3(read(ply.text()).V.row(0)), Vec3(13, 10, 2));
}

}  // namespace easypbr::ply_test
