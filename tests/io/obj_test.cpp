// OBJ files: vertices, faces, lines, and which materials are theirs.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/folder.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"
#include "io/obj_text.h"
#include "io/temporary_folder.h"

namespace easypbr::obj_test {

namespace {

using obj_text::read;
using obj_text::square;

Array3i::Dense triangles(std::initializer_list<int> indices) {
    return Eigen::Map<const Array3i::Dense>(indices.begin(), Eigen::Index(indices.size() / 3), 3);
}

}  // namespace

TEST(Obj, ReadsPolygonsNegativeIndicesContinuationsAndWindowsLineEnds) {
    EXPECT_EQ(read(square + "f 1 2 3 4\n").F, triangles({0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(read(square + "f -4 -3 -2\nv 5 5 5\nf -1 -2 1\n").F, triangles({0, 1, 2, 4, 3, 0}));
    EXPECT_EQ(read(square + "f 1 2 \\\n 3 \\\r\n4\n").F, triangles({0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(read("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n\r\n# end\r\nf 1 2 3\r\n").F, triangles({0, 1, 2}));
    EXPECT_EQ(read("  v 0 0 +1e0\n\tv 1 0 0\nv 0 1 0\ng group\no object\ns off\nvp 1\nf 1 2 3 # comment").F,
              triangles({0, 1, 2}));
}

TEST(Obj, CornersMayEndWithSlashes) {
    const Array3i::Dense one = triangles({0, 1, 2});
    EXPECT_EQ(read(square + "f 1/ 2/ 3/\n").F, one);
    EXPECT_EQ(read(square + "f 1// 2// 3//").F, one);
    EXPECT_EQ(read(square + "vt 0 0\nf 1/1/ 2/1/ \\\n3/1/ # end\n").UV.rows(), 4);
    EXPECT_THROW(read(square + "f 1/// 2 3\n"), FormatError);
    EXPECT_THROW(read(square + "f 1/x 2 3\n"), FormatError);
}

TEST(Obj, ReadsVertexColorsAndLines) {
    const MeshData mesh = read("v 0 0 0\nv 1 0 0 1 0.5 0.25\nv 0 1 0 1\nl 1 2 3\nl -1 -3\n");
    ASSERT_EQ(mesh.C.rows(), 3);
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 1, 1)) << "a vertex without a colour is white";
    EXPECT_EQ(Vec3(mesh.C.row(1)), Vec3(1, 0.5f, 0.25f));
    Array2i::Dense edges(3, 2);
    edges << 0, 1, 1, 2, 2, 0;
    EXPECT_EQ(mesh.E, edges);
    EXPECT_EQ(mesh.F.rows(), 0);
}

TEST(Obj, ReadsVertexColorsAsCodes) {
    const MeshData mesh = read("v 0 0 0\nv 1 0 0 255 51 0\nv 0 1 0 102 0 204\nl 1 2 3\n");
    ASSERT_EQ(mesh.C.rows(), 3);
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, 1, 1)) << "a vertex without a colour is white";
    EXPECT_TRUE(Vec3(mesh.C.row(1)).isApprox(Vec3(1, 0.2f, 0), 1e-6f));
    EXPECT_TRUE(Vec3(mesh.C.row(2)).isApprox(Vec3(0.4f, 0, 0.8f), 1e-6f));
    // What was rounded is no code.
    EXPECT_EQ(Vec3(read("v 0 0 0 1.0001 0.5 0\n").C.row(0)), Vec3(1, 0.5f, 0));
}

TEST(Obj, KeepsVerticesWhoseIndicesAgree) {
    const MeshData mesh = read(square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    EXPECT_EQ(mesh.V.rows(), 4);
    EXPECT_TRUE(mesh.source_vertex.empty());
    EXPECT_EQ(Vec2(mesh.UV.row(2)), Vec2(1, 1));
}

TEST(Obj, SplitsVerticesByTheirIndices) {
    const MeshData mesh = read(square +
                               "vt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 0 -1\n"
                               "f 1/1/1 2/2/1 3/1/1\nf 1/1/2 3/1/1 4//1\n");
    // Vertex 1 has two normals; vertex 3 is the same in both faces; vertex 4 has no uv.
    ASSERT_EQ(mesh.V.rows(), 5);
    const std::vector<int> sources(mesh.source_vertex.data(), mesh.source_vertex.data() + 5);
    EXPECT_EQ(sources, (std::vector<int>{0, 0, 1, 2, 3}));
    EXPECT_EQ(mesh.F, triangles({0, 2, 3, 1, 3, 4}));
    EXPECT_EQ(mesh.N(mesh.F(1, 0), 2), -1);
    EXPECT_EQ(Vec2(mesh.UV.row(2)), Vec2(1, 0));
    EXPECT_EQ(Vec2(mesh.UV.row(4)), Vec2(0, 0));
}

TEST(Obj, ComputesNormalsThatOnlySomeFacesLack) {
    const MeshData mesh = read(square + "vn 0 0 -1\nf 1//1 2//1 3//1\nf 1 3 4\n");
    ASSERT_EQ(mesh.N.rows(), 6);
    EXPECT_EQ(mesh.N(mesh.F(0, 0), 2), -1) << "the file's own normal is kept although it points back";
    EXPECT_EQ(Vec3(mesh.N.row(mesh.F(1, 0))), Vec3(0, 0, 1));
}

// A fold of 90 degrees, of which the second face has no normals; the third, which has some, stays whole.
TEST(Obj, ComputedNormalsHaveSharpEdges) {
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nvn 0 0 -1\n"
        "f 1 2 3\nf 1 4 2\nf 1//1 5//1 2//1\n";
    const MeshData mesh = read(text);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(Vec3(mesh.N.row(mesh.F(0, k))), Vec3(0, 0, 1)) << k;
        EXPECT_EQ(Vec3(mesh.N.row(mesh.F(1, k))), Vec3(0, 1, 0)) << k;
        EXPECT_EQ(Vec3(mesh.N.row(mesh.F(2, k))), Vec3(0, 0, -1)) << k;
    }
    EXPECT_EQ(mesh.V.rows(), 5 + 2 + 2) << "the edge in three normals";
}

TEST(Obj, SortsFacesByMaterialInOrderOfUse) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", "newmtl a\nKd 1 0 0\nnewmtl unused\nnewmtl b\nKd 0 1 0\n");
    const MeshData mesh =
        read("mtllib m.mtl\n" + square +
                 "usemtl b\nf 1 2 3\nusemtl a\nf 1 2 3 4\nusemtl b\nf 2 3 4\nusemtl c\nf 4 3 2\n",
             folder / "test.obj");
    ASSERT_EQ(mesh.materials.size(), 3u);
    EXPECT_EQ(mesh.materials[0].name, "b");
    EXPECT_EQ(mesh.materials[1].base_color, Vec3(1, 0, 0));
    EXPECT_EQ(mesh.materials[2].base_color, Material().base_color) << "an undefined material is the default";
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[0].face_count, 2);
    EXPECT_EQ(mesh.parts[1].first_face, 2);
    EXPECT_EQ(mesh.parts[1].face_count, 2);
    EXPECT_EQ(mesh.F, triangles({0, 1, 2, 1, 2, 3, 0, 1, 2, 0, 2, 3, 3, 2, 1}));
    const std::vector<int> sources(mesh.source_face.data(), mesh.source_face.data() + 5);
    EXPECT_EQ(sources, (std::vector<int>{0, 2, 1, 1, 3}));
}

// vtkOBJExporter has no blanks between the corners of lines with texture coordinates.
TEST(Obj, LeavesOutBrokenLines) {
    const auto edges_of = [](const std::string& lines) { return read(square + "vt 0 0\n" + lines).E; };
    {
        const LogCapture log;
        EXPECT_EQ(edges_of("l 1/1 2/1\nl 1 2/ 3//1\n").rows(), 3);
        EXPECT_EQ(edges_of("l 1/1/1 2/1/1\nl 1/1/1 2//1 3/1/\n").rows(), 3);
        EXPECT_EQ(log.text, "");
    }
    for (const char* broken :
         {"l 1/12/2\n", "l 1/1 2/13/1 4/1\n", "l 1/1/1 2\n", "l -1 -2 x\n", "l 3\n", "l\n"}) {
        const LogCapture log;
        const Array2i E = edges_of(broken + std::string("l -1 -2 -4\n"));
        ASSERT_EQ(E.rows(), 2) << broken;
        EXPECT_EQ(E(0, 0), 3) << broken;
        EXPECT_EQ(E(1, 1), 0) << broken;
        EXPECT_NE(log.text.find("test.obj:6: 'l' needs at least 2 vertices"), std::string::npos) << log.text;
    }
    const LogCapture log;
    edges_of("l 1/12/2\nl 2/13/1\n" + std::string("l 1 2\n"));
    EXPECT_NE(log.text.find("2 such lines in all"), std::string::npos) << log.text;
    EXPECT_THROW(edges_of("l 1 2\nl 1/12/"), FormatError) << "cut off";
}

TEST(Obj, LinesMayNameSeveralLibrariesAndFoldersOfAnotherComputer) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "sub");
    write_file(folder / "a.mtl", "newmtl a\nKd 1 0 0\n");
    write_file(folder / "b.mtl", "newmtl b\nKd 0 0 1\n");
    write_file(folder / "my a.mtl", "newmtl a\nKd 0 1 0\n");
    write_file(folder / "sub/c.mtl", "newmtl a\nKd 1 1 0\n");
    const auto color_of = [&](const std::string& library, const std::string& name) {
        return read("mtllib " + library + "\n" + square + "usemtl " + name + "\nf 1 2 3\n",
                    folder / "test.obj")
            .materials.at(0)
            .base_color;
    };
    const LogCapture log;
    for (const char* name : {"a.mtl b.mtl", "b.mtl\t a.mtl # of both", "./a.mtl b.mtl", "./a.mtl ./b.mtl",
                             "C:\\m\\a.mtl C:\\m\\b.mtl"}) {
        EXPECT_EQ(color_of(name, "a"), Vec3(1, 0, 0)) << name;
        EXPECT_EQ(color_of(name, "b"), Vec3(0, 0, 1)) << name;
    }
    for (const char* name : {".\\a.mtl", "C:\\models\\a.mtl", "/home/nobody/models/a.mtl", "models/a.mtl"})
        EXPECT_EQ(color_of(name, "a"), Vec3(1, 0, 0)) << name;
    EXPECT_EQ(color_of("my a.mtl", "a"), Vec3(0, 1, 0)) << "the whole line is a file";
    EXPECT_EQ(color_of("C:\\my files\\my a.mtl", "a"), Vec3(0, 1, 0)) << "and a path";
    EXPECT_EQ(color_of("sub\\c.mtl", "a"), Vec3(1, 1, 0));
    EXPECT_EQ(log.text, "");
    EXPECT_EQ(color_of("a.mtl gone.mtl", "a"), Vec3(1, 0, 0));
    EXPECT_NE(log.text.find("gone.mtl"), std::string::npos) << log.text;
}

// A name that leads out of a folder is that of a file beside the OBJ; what is outside is as if it were
// missing.
TEST(Obj, LibrariesAndImagesOutsideOfAFolderAreNotLookedFor) {
    const TemporaryFolder all;
    fs::create_directories(all / "in");
    for (const char* name : {"m.mtl", "secret.mtl"}) write_file(all / name, "newmtl a\nKd 1 0 0\n");
    write_file(all / "in/m.mtl", "newmtl a\nKd 0 1 0\nmap_Ke ../c.png\n");
    for (const char* name : {"c.png", "in/c.png"}) io::save_image(Image(1, 1, 3, PixelType::u8), all / name);
    const Folder folder(all / "in");
    const FolderScope scope(&folder);
    const auto material_of = [&](const std::string& library) {
        return read("mtllib " + library + "\n" + square + "usemtl a\nf 1 2 3\n", all / "in/test.obj")
            .materials.at(0);
    };
    const Material inside = material_of("../m.mtl");
    EXPECT_EQ(inside.base_color, Vec3(0, 1, 0));
    EXPECT_EQ(fs::path(inside.emissive_texture.path), all / "in/c.png");
    const auto warning_of = [&](const std::string& library) {
        const LogCapture log;
        EXPECT_EQ(material_of(library).base_color, Material().base_color);
        return log.text;
    };
    for (const char* name : {"../secret.mtl", "../gone.mtl"})
        EXPECT_NE(warning_of(name).find("lies outside"), std::string::npos) << name;
}

TEST(Obj, GivesTheSameMeshHoweverItIsCutIntoPieces) {
    // About 3 MB, so that it is parsed in several pieces; relative and absolute indices, continued lines,
    // materials.
    std::string text;
    constexpr int strips = 60000;
    for (int i = 0; i < strips; ++i) {
        text += fmt::format("v {} 0 0\nv {} 1 0 0.5 0.5 0.5\n", i, i);
        if (i % 1000 == 0) text += fmt::format("usemtl m{}\n", i / 1000 % 7);
        if (i)
            text += i % 2 ? "f -4 -2 \\\n -1 -3\n"
                          : fmt::format("f {} {} {} {}\n", 2 * i - 1, 2 * i + 1, 2 * i + 2, 2 * i);
    }
    ASSERT_GT(text.size(), 2'500'000u);
    const MeshData mesh = read(text);
    ASSERT_EQ(mesh.V.rows(), 2 * strips);
    ASSERT_EQ(mesh.F.rows(), 2 * (strips - 1));
    EXPECT_EQ(mesh.parts.size(), 7u);
    for (int f = 0; f < mesh.F.rows(); f += 2) {
        // Face k joins strips k and k + 1: vertices 2k, 2k + 2, 2k + 3, 2k + 1.
        const int k = mesh.source_face(f);
        ASSERT_EQ(mesh.F.middleRows(f, 2),
                  triangles({2 * k, 2 * k + 2, 2 * k + 3, 2 * k, 2 * k + 3, 2 * k + 1}));
    }
    for (const MeshPart& part : mesh.parts)
        for (int f = part.first_face; f < part.first_face + part.face_count; ++f)
            ASSERT_EQ(mesh.materials[size_t(part.material)].name,
                      fmt::format("m{}", (mesh.source_face(f) + 1) / 1000 % 7));
}

TEST(Obj, WritesNormalsOfFacesWhereAMeshIsDrawnFlat) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    mesh.F = Array3i(Array3i::Dense{{0, 2, 1}, {0, 1, 3}});
    for (const bool has_uv : {false, true}) {
        if (has_uv) mesh.UV = Array2f(Array2f::Dense{{0, 0}, {1, 0}, {0, 1}, {1, 1}});
        mesh.style.flat = true;
        Mesh(mesh).save(folder / "flat.obj");
        const auto flat = Mesh(folder / "flat.obj").snapshot();
        ASSERT_EQ(flat->F.rows(), 2);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(Vec3(flat->N.row(flat->F(0, k))), Vec3(0, 0, -1));
            EXPECT_EQ(Vec3(flat->N.row(flat->F(1, k))), Vec3(0, -1, 0));
        }
        mesh.style.flat = false;
        Mesh(mesh).save(folder / "smooth.obj");
        EXPECT_TRUE(Mesh(folder / "smooth.obj").snapshot()->N.empty());
    }
}

}  // namespace easypbr::obj_test
