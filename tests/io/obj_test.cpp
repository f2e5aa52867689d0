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
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"
#include "io/temporary_folder.h"

namespace easypbr::obj_test {

namespace {

MeshData read(const std::string& text, const fs::path& path = "test.obj") {
    MeshData mesh = io::read_obj(io::Source(std::string_view(text), path), {});
    validate(mesh);
    return mesh;
}

Array3i::Dense triangles(std::initializer_list<int> indices) {
    return Eigen::Map<const Array3i::Dense>(indices.begin(), Eigen::Index(indices.size() / 3), 3);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Reads a mesh whose only material is written as MTL lines.
Material read_material(const std::string& lines, const TemporaryFolder& folder) {
    write_file(folder / "m.mtl", "newmtl red paint\n" + lines);
    const MeshData mesh =
        read("mtllib m.mtl\n" + square + "usemtl red paint\nf 1 2 3\n", folder / "test.obj");
    EXPECT_EQ(mesh.materials.size(), 1u);
    return mesh.materials.at(0);
}

/// An image of one row.
Image row_of(int channels, std::initializer_list<uint8_t> values) {
    Image image(int(values.size()) / channels, 1, channels, PixelType::u8);
    std::ranges::copy(values, image.pixels<uint8_t>().begin());
    return image;
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

TEST(Obj, ReadsMaterialFactors) {
    const TemporaryFolder folder;
    const Material pbr = read_material("Kd 0.25 0.5 1\nKe 2 0 0\nPr 0.3\nPm 0.7\nd 0.5\nNs 10\n", folder);
    EXPECT_EQ(pbr.name, "red paint");
    EXPECT_EQ(pbr.base_color, Vec3(0.25f, 0.5f, 1)) << "Kd is linear";
    EXPECT_EQ(pbr.emissive, Vec3(2, 0, 0));
    EXPECT_EQ(pbr.roughness, 0.3f);
    EXPECT_EQ(pbr.metallic, 0.7f);
    EXPECT_EQ(pbr.opacity, 0.5f);
    EXPECT_EQ(*pbr.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(read_material("Tr 0.25\n", folder).opacity, 0.75f);
    EXPECT_TRUE(read_material("illum 0\n", folder).unlit);
    EXPECT_FALSE(read_material("illum 2\n", folder).unlit);
    // alpha = sqrt(2 / (Ns + 2)): 1 for Ns = 0, 1/4 for Ns = 30; roughness = sqrt(alpha).
    EXPECT_FLOAT_EQ(read_material("Ns 0\n", folder).roughness, 1);
    EXPECT_FLOAT_EQ(read_material("Ns 30\n", folder).roughness, 0.5f);
    EXPECT_EQ(read_material("Kd nan 0 0\nPr 7\n", folder).base_color, Material().base_color);
    EXPECT_EQ(read_material("Pr 7\n", folder).roughness, 1);
}

TEST(Obj, DissolveCountsBesideTransparency) {
    const TemporaryFolder folder;
    const LogCapture log;
    EXPECT_EQ(read_material("d 0.5\nTr 0\n", folder).opacity, 0.5f);
    EXPECT_EQ(read_material("Tr 0\nd 0.5\n", folder).opacity, 0.5f);
    EXPECT_EQ(read_material("d 0\n", folder).opacity, 0);
    EXPECT_EQ(log.text, "");
}

// What MeshLab, OpenMVS and mvs-texturing write for opaque materials.
TEST(Obj, ATransparencyOf1IsOpaque) {
    const TemporaryFolder folder;
    for (const char* line : {"Tr 1\n", "Tr 1.000000\n"}) {
        const LogCapture log;
        const Material material = read_material(line, folder);
        EXPECT_EQ(material.opacity, 1) << line;
        EXPECT_FALSE(material.alpha_mode.value()) << "opaque";
        EXPECT_NE(log.text.find("'Tr 1' without 'd' is taken as opaque"), std::string::npos) << log.text;
        EXPECT_NE(log.text.find("material 'red paint'"), std::string::npos) << log.text;
    }
    const LogCapture log;
    EXPECT_EQ(read_material("Tr 1\nd 0.25\n", folder).opacity, 0.25f);
    EXPECT_EQ(log.text, "");
}

// vtkOBJExporter: its comment, and GetOpacity() as Tr.
TEST(Obj, TheTransparencyOfVtkIsAnOpacity) {
    const TemporaryFolder folder;
    const LogCapture log;
    const auto opacity_of = [&](const std::string& head, const std::string& line) {
        write_file(folder / "m.mtl", head + "newmtl mtl0\nKd 1 0 0\n" + line);
        return read("mtllib m.mtl\n" + square + "usemtl mtl0\nf 1 2 3\n", folder / "test.obj")
            .materials.at(0)
            .opacity;
    };
    const std::string vtk = "# wavefront mtl file written by the visualization toolkit\n\n";
    EXPECT_EQ(opacity_of(vtk, "Tr 0.25\n"), 0.25f);
    EXPECT_EQ(opacity_of(vtk, "Tr 1\n"), 1);
    EXPECT_EQ(opacity_of(vtk, "Tr 0.25\nd 0.5\n"), 0.5f);
    EXPECT_EQ(opacity_of("# another\n", "# not of the Visualization Toolkit\nTr 0.25\n"), 0.75f)
        << "no comment before the first material";
    EXPECT_EQ(log.text, "");
}

// vtkOBJExporter has no blanks between the corners of lines with texture coordinates.
TEST(Obj, LeavesOutBrokenLines) {
    const auto edges_of = [](const std::string& lines) { return read(square + "vt 0 0\n" + lines).E; };
    {
        const LogCapture log;
        EXPECT_EQ(edges_of("l 1/1 2/1\nl 1 2/ 3//1\n").rows(), 3);
        EXPECT_EQ(log.text, "");
    }
    for (const char* broken : {"l 1/12/2\n", "l 1/1 2/13/1 4/1\n", "l -1 -2 x\n", "l 3\n", "l\n"}) {
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

TEST(Obj, ReadsMaps) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "maps");
    // The normal that is not tilted.
    io::save_image(row_of(3, {128, 128, 255}), folder / "maps/a b.png");
    io::save_image(Image(2, 2, 1, PixelType::u8), folder / "grey.png");
    const Material m = read_material(
        "Kd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 -clamp on maps\\a b.png\nmap_Pr grey.png\n"
        "map_Pm -imfchan g maps/a b.png\nmap_Ke maps/a b.png\nmap_d grey.png\n"
        "norm -bm 0.5 maps/a b.png\n",
        folder);
    ASSERT_TRUE(m.base_color_texture);
    EXPECT_EQ(m.base_color, Vec3(1, 1, 1)) << "black beside a map means the map alone";
    EXPECT_EQ(m.base_color_texture.wrap_u, Wrap::clamp);
    EXPECT_EQ(Vec3(m.base_color_texture.uv_transform * Vec3(1, 1, 1)), Vec3(2.5f, 3, 1));
    EXPECT_TRUE(m.roughness_texture);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.metallic_texture.channel, 1);
    EXPECT_EQ(m.emissive, Vec3(1, 1, 1));
    EXPECT_EQ(*m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(m.base_color_texture.image, m.normal_texture.image) << "an image is read once";
    EXPECT_TRUE(read_material("bump maps/a b.png\n", folder).normal_texture);
    EXPECT_FALSE(read_material("bump grey.png\n", folder).normal_texture) << "a height map is no normal map";
}

TEST(Obj, GreyBumpMapsAreHeightMapsHoweverTheyAreStored) {
    const TemporaryFolder folder;
    // 1 of 100 texels may be a stray one.
    Image heights(100, 1, 3, PixelType::u8);
    std::ranges::fill(heights.pixels<uint8_t>(), uint8_t(90));
    heights.at<uint8_t>(7, 0)[2] = 250;
    io::save_image(heights, folder / "h.png");
    io::save_image(row_of(4, {10, 10, 10, 255, 200, 200, 200, 255}), folder / "h_alpha.png");
    io::save_image(row_of(3, {128, 128, 255, 218, 218, 218}), folder / "n.png");
    for (const char* line : {"bump h.png\n", "map_Bump -bm 0.5 h.png\n", "map_bump h_alpha.png\n"}) {
        const LogCapture log;
        EXPECT_FALSE(read_material(line, folder).normal_texture) << line;
        EXPECT_NE(log.text.find("height maps are not supported"), std::string::npos) << log.text;
    }
    EXPECT_TRUE(read_material("bump n.png\n", folder).normal_texture);
    EXPECT_TRUE(read_material("norm h.png\n", folder).normal_texture);
}

TEST(Obj, NamesMayBeginLikeNumbersStandInQuotesAndHaveComments) {
    const TemporaryFolder folder;
    for (const char* name : {"1.png", "a b.png", "c #1.png"})
        io::save_image(Image(2, 2, 3, PixelType::u8), folder / name);
    const auto file_of = [&](const std::string& line) {
        return fs::path(read_material(line, folder).base_color_texture.path).filename().string();
    };
    EXPECT_EQ(file_of("map_Kd -s 2 2 1.png\n"), "1.png");
    EXPECT_EQ(file_of("map_Kd -o 0.5 1.png\n"), "1.png");
    EXPECT_EQ(file_of("map_Kd \"a b.png\"\n"), "a b.png");
    EXPECT_EQ(file_of("map_Kd a b.png # of the wall\n"), "a b.png");
    EXPECT_EQ(file_of("map_Kd \"a b.png\" # of the wall\n"), "a b.png");
    EXPECT_EQ(file_of("map_Kd c #1.png\n"), "c #1.png") << "a name with a '#'";
    const Material scaled = read_material("map_Kd -s 2 3 1.png\n", folder);
    EXPECT_EQ(Vec3(scaled.base_color_texture.uv_transform * Vec3(1, 1, 1)), Vec3(2, 3, 1));
}

TEST(Obj, FindsMaterialsWhateverStandsAroundTheirNames) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl",
               "newmtl \"red\"\nKd 1 0 0\nnewmtl blue # sky\nKd 0 0 1\n"
               "newmtl Material #25\nKd 0 1 0\nnewmtl Material #26\nKd 0 1 1\n");
    const auto color_of = [&](const std::string& name) {
        return read("mtllib m.mtl # of this file\n" + square + "usemtl " + name + "\nf 1 2 3\n",
                    folder / "test.obj")
            .materials.at(0)
            .base_color;
    };
    EXPECT_EQ(color_of("red"), Vec3(1, 0, 0));
    EXPECT_EQ(color_of("\"red\""), Vec3(1, 0, 0));
    EXPECT_EQ(color_of("red # of bricks"), Vec3(1, 0, 0));
    EXPECT_EQ(color_of("blue"), Vec3(0, 0, 1));
    EXPECT_EQ(color_of("Material #25"), Vec3(0, 1, 0)) << "no comment";
    EXPECT_EQ(color_of("Material #26"), Vec3(0, 1, 1)) << "no comment";
}

// An opacity of 100/255 is neither there nor not; what a JPEG file makes of black and white is.
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
    for (const char* name : {"a.mtl b.mtl", "b.mtl\t a.mtl # of both", "./a.mtl b.mtl"}) {
        EXPECT_EQ(color_of(name, "a"), Vec3(1, 0, 0)) << name;
        EXPECT_EQ(color_of(name, "b"), Vec3(0, 0, 1)) << name;
    }
    for (const char* name : {".\\a.mtl", "C:\\models\\a.mtl", "/home/nobody/models/a.mtl", "models/a.mtl"})
        EXPECT_EQ(color_of(name, "a"), Vec3(1, 0, 0)) << name;
    EXPECT_EQ(color_of("my a.mtl", "a"), Vec3(0, 1, 0)) << "the whole line is a file";
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

// Files of both are there: those of the MTL's folder are meant.
TEST(Obj, ImagesAreThoseOfTheFolderOfTheMtl) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "sub");
    for (const char* name : {"c.png", "sub/c.png", "d.png"})
        io::save_image(Image(1, 1, 3, PixelType::u8), folder / name);
    write_file(folder / "sub/m.mtl", "newmtl a\nmap_Kd c.png\nmap_Ke d.png\n");
    const Material material =
        read("mtllib sub/m.mtl\n" + square + "usemtl a\nf 1 2 3\n", folder / "test.obj").materials.at(0);
    EXPECT_EQ(fs::path(material.base_color_texture.path), folder / "sub/c.png");
    EXPECT_EQ(fs::path(material.emissive_texture.path), folder / "d.png");
}

TEST(Obj, OpacityMapsBlendUnlessTheyAreBlackAndWhite) {
    const TemporaryFolder folder;
    const auto mode_of = [&](std::initializer_list<uint8_t> texels, const std::string& lines = "") {
        Image image(int(texels.size()), 1, 1, PixelType::u8);
        std::copy(texels.begin(), texels.end(), image.pixels<uint8_t>().begin());
        io::save_image(image, folder / "d.png");
        return *read_material(lines + "map_d d.png\n", folder).alpha_mode;
    };
    EXPECT_EQ(mode_of({0, 255}), AlphaMode::mask);
    EXPECT_EQ(mode_of({3, 251}), AlphaMode::mask);
    EXPECT_EQ(mode_of({100, 100}), AlphaMode::blend);
    EXPECT_EQ(mode_of({0, 255, 128}), AlphaMode::blend);
    EXPECT_EQ(mode_of({0, 255}, "d 0.5\n"), AlphaMode::blend) << "opacity multiplies the map";
}

TEST(Obj, OpacityMapsAreTheAlphaOfTheirImages) {
    const TemporaryFolder folder;
    io::save_image(row_of(4, {255, 0, 0, 255, 0, 255, 0, 0}), folder / "cut.png");
    io::save_image(row_of(4, {255, 0, 0, 100, 0, 255, 0, 0}), folder / "clear.png");
    io::save_image(row_of(4, {255, 0, 0, 255, 0, 255, 0, 255}), folder / "solid.png");
    io::save_image(row_of(2, {255, 0, 0, 255}), folder / "grey_cut.png");
    const auto channel_of = [&](const std::string& line) {
        return read_material(line, folder).opacity_texture.channel;
    };
    EXPECT_EQ(channel_of("map_d cut.png\n"), 3);
    EXPECT_EQ(*read_material("map_d cut.png\n", folder).alpha_mode, AlphaMode::mask);
    EXPECT_EQ(*read_material("map_d clear.png\n", folder).alpha_mode, AlphaMode::blend);
    EXPECT_EQ(channel_of("map_d grey_cut.png\n"), 1);
    EXPECT_EQ(channel_of("map_d solid.png\n"), 0) << "alpha says nothing";
    EXPECT_EQ(channel_of("map_d -imfchan r cut.png\n"), 0);
    EXPECT_EQ(channel_of("map_d -imfchan m solid.png\n"), 3);
    EXPECT_EQ(channel_of("map_d -imfchan m grey_cut.png\n"), 1);
    EXPECT_EQ(channel_of("map_d -imfchan g grey_cut.png\n"), 0) << "grey stands for green";
    EXPECT_EQ(read_material("map_Pr cut.png\n", folder).roughness_texture.channel, 0);
}

// The alpha of the base colour multiplies the opacity: 0.5 would become 0.25.
TEST(Obj, TheAlphaOfTheBaseColorCountsOnce) {
    const TemporaryFolder folder;
    io::save_image(row_of(4, {255, 0, 0, 128, 0, 255, 0, 0}), folder / "c.png");
    const Material one = read_material("map_Kd c.png\nmap_d c.png\n", folder);
    EXPECT_TRUE(one.base_color_texture);
    EXPECT_FALSE(one.opacity_texture);
    EXPECT_EQ(*one.alpha_mode, AlphaMode::blend);
    const Material scaled = read_material("map_Kd c.png\nmap_d -s 2 2 c.png\n", folder);
    EXPECT_EQ(scaled.opacity_texture.channel, 3) << "another place of the image";
    // Written as map_d, and read back.
    MeshData mesh = read(square + "f 1 2 3\n");
    mesh.materials = {one};
    const LogCapture log;
    io::save_mesh(Mesh(mesh), folder / "out.obj");
    EXPECT_EQ(log.text.find("alpha_mode"), std::string::npos) << log.text;
    const Material back = io::load_mesh(folder / "out.obj").snapshot()->materials.at(0);
    EXPECT_EQ(*back.alpha_mode, AlphaMode::blend);
    EXPECT_FALSE(back.opacity_texture);
}

// A red channel of an image with alpha is no alpha when it is read back.
TEST(Obj, WritesTheChannelOfAnOpacity) {
    const TemporaryFolder folder;
    io::save_image(row_of(4, {255, 0, 0, 128, 0, 255, 0, 0}), folder / "c.png");
    io::save_image(row_of(2, {255, 0, 0, 128}), folder / "g.png");
    for (const auto& [line, channel] : std::vector<std::pair<std::string, int>>{
             {"map_d -imfchan r c.png\n", 0}, {"map_d c.png\n", 3}, {"map_d g.png\n", 1}}) {
        MeshData mesh = read(square + "f 1 2 3\n");
        mesh.materials = {read_material(line, folder)};
        EXPECT_EQ(mesh.materials[0].opacity_texture.channel, channel) << line;
        io::save_mesh(Mesh(mesh), folder / "out.obj");
        EXPECT_EQ(io::load_mesh(folder / "out.obj").snapshot()->materials.at(0).opacity_texture.channel,
                  channel)
            << line;
    }
}

// 0.2126 * 200 + 0.7152 * 100 + 0.0722 * 50 = 117.65.
TEST(Obj, TheLuminanceOfAnImageMayBeAskedFor) {
    const TemporaryFolder folder;
    io::save_image(row_of(3, {200, 100, 50}), folder / "c.png");
    io::save_image(row_of(3, {200, 200, 200}), folder / "g.png");
    const Texture colored = read_material("map_Pr -imfchan l c.png\n", folder).roughness_texture;
    ASSERT_EQ(colored.image->channels(), 1);
    EXPECT_EQ(*colored.image->at<uint8_t>(0, 0), 118);
    EXPECT_EQ(colored.path, "") << "no file holds it";
    const Texture grey = read_material("map_Pr -imfchan l g.png\n", folder).roughness_texture;
    EXPECT_EQ(fs::path(grey.path).filename(), "g.png");
}

TEST(Obj, WarnsOfMissingLibrariesAndTextures) {
    const TemporaryFolder folder;
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const Material m = read_material("map_Kd gone.png\n", folder);
    read("mtllib gone.mtl\n" + square + "usemtl a\nf 1 2 3\n", folder / "test.obj");
    set_log_sink({});
    EXPECT_FALSE(m.base_color_texture);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("gone.png"), std::string::npos);
    EXPECT_NE(warnings[1].find("gone.mtl"), std::string::npos);
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

TEST(Obj, AKdOf06BesideColorsIsNoDefault) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", "newmtl a\nKd 0.6 0.6 0.6\nnewmtl b\nNs 10\n");
    const auto material_of = [&](const std::string& name, const std::string& color) {
        return read(fmt::format("mtllib m.mtl\nv 0 0 0{0}\nv 1 0 0{0}\nv 0 1 0{0}\nusemtl {1}\nf 1 2 3\n",
                                color, name),
                    folder / "test.obj")
            .materials.at(0);
    };
    EXPECT_FALSE(material_of("a", " 1 0 0").has_default_color());
    EXPECT_TRUE(material_of("a", "").has_default_color());
    EXPECT_TRUE(material_of("b", " 1 0 0").has_default_color());
}

}  // namespace easypbr::obj_test
