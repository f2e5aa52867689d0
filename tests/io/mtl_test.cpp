// Materials of OBJ files.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh.h"
#include "io/gltf_decoded.h"
#include "io/obj_text.h"
#include "io/temporary_folder.h"

namespace easypbr::mtl_test {

namespace {

using obj_text::read;
using obj_text::square;

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

TEST(Mtl, ReadsMaterialFactors) {
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

TEST(Mtl, DissolveCountsBesideTransparency) {
    const TemporaryFolder folder;
    const LogCapture log;
    EXPECT_EQ(read_material("d 0.5\nTr 0\n", folder).opacity, 0.5f);
    EXPECT_EQ(read_material("Tr 0\nd 0.5\n", folder).opacity, 0.5f);
    EXPECT_EQ(read_material("d 0\n", folder).opacity, 0);
    EXPECT_EQ(log.text, "");
}

// What MeshLab, OpenMVS and mvs-texturing write for opaque materials.
TEST(Mtl, ATransparencyOf1IsOpaque) {
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
TEST(Mtl, TheTransparencyOfVtkIsAnOpacity) {
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

TEST(Mtl, ReadsMaps) {
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

TEST(Mtl, GreyBumpMapsAreHeightMapsHoweverTheyAreStored) {
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

TEST(Mtl, NamesMayBeginLikeNumbersStandInQuotesAndHaveComments) {
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

TEST(Mtl, FindsMaterialsWhateverStandsAroundTheirNames) {
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

// Files of both are there: those of the MTL's folder are meant.
TEST(Mtl, ImagesAreThoseOfTheFolderOfTheMtl) {
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

// An opacity of 100/255 is neither there nor not; what a JPEG file makes of black and white is.
TEST(Mtl, OpacityMapsBlendUnlessTheyAreBlackAndWhite) {
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

TEST(Mtl, OpacityMapsAreTheAlphaOfTheirImages) {
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
TEST(Mtl, TheAlphaOfTheBaseColorCountsOnce) {
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
TEST(Mtl, WritesTheChannelOfAnOpacity) {
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

// A mask whose alpha is neither 0 nor 1 everywhere: readers blend it.
TEST(Mtl, AlphaModesThatReadersDoNotChooseAreNamed) {
    const TemporaryFolder folder;
    io::save_image(row_of(4, {255, 0, 0, 128, 0, 255, 0, 0}), folder / "soft.png");
    io::save_image(row_of(4, {255, 0, 0, 255, 0, 255, 0, 0}), folder / "hard.png");
    const auto is_named = [&](const char* keyword, const char* image, AlphaMode mode, float opacity) {
        MeshData mesh = read(square + "f 1 2 3\n");
        mesh.materials = {read_material(fmt::format("{} {}\n", keyword, image), folder)};
        mesh.materials[0].alpha_mode = mode;
        mesh.materials[0].opacity = opacity;
        const LogCapture log;
        io::save_mesh(Mesh(mesh), folder / "out.obj");
        const bool is_same =
            *io::load_mesh(folder / "out.obj").snapshot()->materials.at(0).alpha_mode == mode;
        const bool named = log.text.find("material.alpha_mode") != std::string::npos;
        EXPECT_NE(named, is_same) << keyword << " " << image << " " << int(mode) << " " << opacity;
        return named;
    };
    for (const char* keyword : {"map_Kd", "map_d"}) {
        EXPECT_TRUE(is_named(keyword, "soft.png", AlphaMode::mask, 1)) << keyword;
        EXPECT_FALSE(is_named(keyword, "soft.png", AlphaMode::blend, 1)) << keyword;
        EXPECT_FALSE(is_named(keyword, "hard.png", AlphaMode::mask, 1)) << keyword;
        EXPECT_TRUE(is_named(keyword, "hard.png", AlphaMode::blend, 1)) << keyword;
        EXPECT_TRUE(is_named(keyword, "hard.png", AlphaMode::mask, 0.5f)) << keyword;
        EXPECT_FALSE(is_named(keyword, "hard.png", AlphaMode::blend, 0.5f)) << keyword;
    }
}

// 0.2126 * 200 + 0.7152 * 100 + 0.0722 * 50 = 117.65.
TEST(Mtl, TheLuminanceOfAnImageMayBeAskedFor) {
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

TEST(Mtl, WarnsOfMissingLibrariesAndTextures) {
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

TEST(Mtl, AKdOf06BesideColorsIsNoDefault) {
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

TEST(Mtl, AKdOf06BesideATextureIsNoDefault) {
    const TemporaryFolder folder;
    io::save_image(row_of(3, {1, 2, 3}), folder / "t.png");
    const Material given = read_material("Kd 0.6 0.6 0.6\nmap_Kd t.png\n", folder);
    ASSERT_TRUE(given.base_color_texture);
    EXPECT_EQ(given.color_factor(false, true), Vec3(0.6f, 0.6f, 0.6f));
    EXPECT_EQ(read_material("map_Kd t.png\n", folder).color_factor(false, true), Vec3(1, 1, 1));
    // Written, the default is white beside the texture.
    MeshData mesh = read(square + "vt 0 0\nf 1/1 2/1 3/1\n", folder / "test.obj");
    Material plain = given;
    plain.base_color_given = false;
    mesh.materials = {plain};
    Mesh(mesh).save(folder / "written.obj");
    EXPECT_EQ(Mesh(folder / "written.obj").snapshot()->materials.at(0).base_color, Vec3(1, 1, 1));
}

}  // namespace easypbr::mtl_test
