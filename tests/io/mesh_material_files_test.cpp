// What OBJ and PLY keep of materials and textures, and the image files that they write.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/image/texture_loader.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "file_limit.h"
#include "io/flat_image.h"
#include "io/random_mesh.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"

namespace easypbr::mesh_material_files_test {

TEST(MeshMaterialFiles, ObjAndItsMaterialsAreWrittenTogetherOrNotAtAll) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", std::string_view("newmtl old\n"));
    MeshData mesh = random_mesh(7, 300);
    mesh.materials = {Material{}};
    {
        // There is room for the materials, about 150 bytes, only.
        const FileLimit full(1000);
        EXPECT_THROW(Mesh(mesh).save(folder / "m.obj"), FileError);
    }
    EXPECT_EQ(FileBytes(folder / "m.mtl").text(), "newmtl old\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_NE(FileBytes(folder / "m.mtl").text(), "newmtl old\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

TEST(MeshMaterialFiles, ObjKeepsMaterialsAndParts) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    io::save_image(Image(2, 2, 3, PixelType::u8), folder / "t.png");
    MeshData mesh = random_mesh(3, 10);
    Material paint;
    paint.name = "paint";
    paint.base_color = Vec3(0.1f, 0.2f, 0.3f);
    paint.roughness = 0.123f;
    paint.metallic = 1;
    paint.normal_scale = 0.5f;
    paint.base_color_texture.image = std::make_shared<const Image>(2, 2, 3, PixelType::u8);
    paint.base_color_texture.path = (folder / "t.png").string();
    paint.normal_texture = paint.base_color_texture;
    mesh.materials = {Material(), paint};
    mesh.parts = {{"a", 0, 5, 0}, {"b", 5, 15, 1}};
    Mesh(mesh).save(folder / "out/m.obj");
    const auto back = Mesh(folder / "out/m.obj").snapshot();
    ASSERT_EQ(back->materials.size(), 2u);
    const Material& read = back->materials[1];
    EXPECT_EQ(read.name, "paint");
    EXPECT_EQ(read.base_color, paint.base_color);
    EXPECT_EQ(read.roughness, paint.roughness);
    EXPECT_EQ(read.metallic, paint.metallic);
    EXPECT_EQ(read.normal_scale, paint.normal_scale);
    EXPECT_TRUE(read.base_color_texture);
    ASSERT_EQ(back->parts.size(), 2u);
    EXPECT_EQ(back->parts[1].first_face, 5);
    EXPECT_TRUE(same_bits(mesh.F, back->F));
}

TEST(MeshMaterialFiles, ObjWritesImagesThatNoFileHolds) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(3, 10);
    Material red, other;
    red.name = "red";
    red.base_color_texture.image = flat(10);
    red.emissive_texture.image = red.base_color_texture.image;
    red.roughness_texture.image = flat(20);
    red.roughness_texture.channel = 1;
    other.name = "other";
    other.base_color_texture.image = flat(30);
    // A file that is there keeps its name, and its content.
    io::save_image(*flat(40), folder / "my_m_normal.png");
    other.normal_texture.image = flat(40);
    other.normal_texture.path = (folder / "my_m_normal.png").string();
    red.normal_texture.image = flat(50);
    mesh.materials = {red, other};
    mesh.parts = {{"a", 0, 5, 0}, {"b", 5, 15, 1}};
    Mesh(mesh).save(folder / "my m.obj");
    // OBJ, MTL, the normal map that was there, and four images: one of them is used twice.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 7);
    const auto back = Mesh(folder / "my m.obj").snapshot();
    ASSERT_EQ(back->materials.size(), 2u);
    const auto value_of = [](const Texture& texture) {
        return texture ? int(texture.image->at<uint8_t>(1, 1)[0]) : -1;
    };
    EXPECT_EQ(value_of(back->materials[0].base_color_texture), 10);
    EXPECT_EQ(value_of(back->materials[0].emissive_texture), 10);
    EXPECT_EQ(value_of(back->materials[0].roughness_texture), 20);
    EXPECT_EQ(back->materials[0].roughness_texture.channel, 1);
    EXPECT_EQ(value_of(back->materials[0].normal_texture), 50);
    EXPECT_EQ(value_of(back->materials[1].base_color_texture), 30);
    EXPECT_EQ(value_of(back->materials[1].normal_texture), 40);
    EXPECT_TRUE(fs::exists(folder / "my_m_base_color.png"));
}

// Half is code 128 of data and code 188 of light (255 * 0.73536 = 187.52). The alpha of colours stays theirs.
TEST(MeshMaterialFiles, ObjCodesFloatsByWhatTheyAreUsedAs) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(3, 10);
    auto image = std::make_shared<Image>(2, 2, 4, PixelType::f32);
    std::ranges::fill(image->pixels<float>(), 0.5f);
    Material m;
    m.base_color_texture.image = m.roughness_texture.image = m.normal_texture.image = image;
    m.alpha_mode = AlphaMode::blend;
    mesh.materials = {m};
    Mesh(mesh).save(folder / "m.obj");
    // OBJ, MTL, an image of colours with alpha, and one of data for two uses.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 4);
    const Material back = Mesh(folder / "m.obj").snapshot()->materials.at(0);
    const auto code = [](const Texture& texture, int channel) {
        return int(texture.image->at<uint8_t>(1, 1)[channel]);
    };
    EXPECT_EQ(code(back.base_color_texture, 0), 188);
    EXPECT_EQ(code(back.base_color_texture, 3), 128);
    EXPECT_EQ(back.alpha_mode.value(), AlphaMode::blend);
    EXPECT_FALSE(back.opacity_texture);
    EXPECT_EQ(code(back.roughness_texture, 0), 128);
    EXPECT_EQ(code(back.normal_texture, 2), 128);
}

// As when they are drawn; not of data, and not where the MTL names the file that holds the floats.
TEST(MeshMaterialFiles, ObjWarnsOfColorsAboveOne) {
    const TemporaryFolder folder;
    const MeshData random = random_mesh(3, 10);
    MeshData mesh;
    mesh.V = random.V;
    mesh.F = random.F;
    mesh.UV = random.UV;
    auto image = std::make_shared<Image>(2, 2, 3, PixelType::f32);
    std::ranges::fill(image->pixels<float>(), 6.5f);
    Material m;
    m.roughness_texture.image = image;
    const auto warnings_of = [&] {
        mesh.materials = {m};
        std::string text;
        set_log_sink([&](LogLevel, std::string_view message) { text += std::string(message) + "\n"; });
        Mesh(mesh).save(folder / "m.obj");
        set_log_sink({});
        return text;
    };
    EXPECT_EQ(warnings_of(), "");
    m.base_color_texture.image = m.emissive_texture.image = image;
    EXPECT_EQ(warnings_of(),
              "base_color_texture: colours above 1 were clamped to 1, the largest value is 6.5\n");
    io::save_image(*image, folder / "sun.exr");
    m = {};
    m.emissive_texture = io::load_texture(folder / "sun.exr");
    EXPECT_EQ(warnings_of(), "");
}

TEST(MeshMaterialFiles, ObjImagesReplaceNoneOfOtherFiles) {
    const TemporaryFolder folder;
    const auto save = [&](const char* name, uint8_t value) {
        MeshData mesh = random_mesh(3, 10);
        mesh.materials.resize(1);
        mesh.materials[0].base_color_texture.image = flat(value);
        Mesh(mesh).save(folder / name);
    };
    const auto value_of = [&](const char* name) {
        const Texture texture = Mesh(folder / name).snapshot()->materials.at(0).base_color_texture;
        return texture ? int(texture.image->at<uint8_t>(1, 1)[0]) : -1;
    };
    save("car 1.obj", 10);
    save("car_1.obj", 20);
    EXPECT_EQ(value_of("car 1.obj"), 10);
    EXPECT_EQ(value_of("car_1.obj"), 20);
    // Saved again, each replaces its own.
    save("car_1.obj", 30);
    save("car 1.obj", 40);
    EXPECT_EQ(value_of("car 1.obj"), 40);
    EXPECT_EQ(value_of("car_1.obj"), 30);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 6);
    // What lines of MTL take for something else is replaced in the images' names; image files with such names
    // are found.
    for (const char* name : {"a\\b.obj", "-n.obj", " lead.obj", "a #1.obj"}) {
        save(name, 50);
        EXPECT_EQ(value_of(name), 50) << name;
    }
    io::save_image(*flat(60), folder / "c\\d.png");
    MeshData mesh = random_mesh(3, 10);
    mesh.materials.resize(1);
    mesh.materials[0].base_color_texture.path = (folder / "c\\d.png").string();
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_EQ(value_of("m.obj"), 60);
}

TEST(MeshMaterialFiles, ObjRefusesNamesThatNoLineHolds) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(3, 10);
    Mesh(mesh).save(folder / "a\nb.obj");
    fs::remove(folder / "a\nb.obj");
    mesh.materials.resize(1);
    EXPECT_THROW(Mesh(mesh).save(folder / "a\nb.obj"), ArgumentError);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(MeshMaterialFiles, ObjWritesMaterialsThatAreTheSameOnce) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(3, 10);
    Material red;
    red.name = "red";
    Material other = red, unnamed;
    other.roughness = 0.25f;
    mesh.materials = {red, red, other, unnamed};
    mesh.parts = {{"a", 0, 5, 0}, {"b", 5, 5, 1}, {"c", 10, 5, 2}, {"d", 15, 5, 3}};
    Mesh(mesh).save(folder / "m.obj");
    const auto back = Mesh(folder / "m.obj").snapshot();
    ASSERT_EQ(back->materials.size(), 3u);
    EXPECT_EQ(back->materials[0].name, "red");
    EXPECT_EQ(back->parts[0].face_count, 10);
    EXPECT_EQ(back->materials[1].name, "red_2");
    EXPECT_EQ(back->materials[1].roughness, 0.25f);
    EXPECT_EQ(back->materials[2].name, "material");
}

TEST(MeshMaterialFiles, ObjImagesAppearWithItOrNotAtAll) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(7, 300);
    mesh.materials.resize(1);
    mesh.materials[0].base_color_texture.image = flat(1);
    {
        // There is room for image and materials, not for the geometry.
        const FileLimit full(1000);
        EXPECT_THROW(Mesh(mesh).save(folder / "m.obj"), FileError);
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

namespace {

/// A triangle whose OBJ names t.png of `value`, as it is read.
Mesh textured_triangle(const fs::path& folder, uint8_t value) {
    io::save_image(*flat(value), folder / "t.png");
    write_file(folder / "in.mtl", std::string_view("newmtl m\nmap_Kd t.png\n"));
    write_file(folder / "in.obj",
               std::string_view("mtllib in.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\n"
                                "f 1/1 2/1 3/1\n"));
    return Mesh(folder / "in.obj");
}

/// What t.png is replaced by; no two files are written within the steps of a file system's clock.
void replace_texture(const fs::path& folder, uint8_t value) {
    const auto time = fs::last_write_time(folder / "t.png");
    io::save_image(*flat(value), folder / "t.png");
    fs::last_write_time(folder / "t.png", time + std::chrono::seconds(5));
}

int value_in(const fs::path& mesh) {
    const Texture texture = Mesh(mesh).snapshot()->materials.at(0).base_color_texture;
    return texture ? int(texture.image->at<uint8_t>(1, 1)[0]) : -1;
}

}  // namespace

TEST(MeshMaterialFiles, ObjNamesATextureWhileItsFileHoldsIt) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    textured_triangle(folder.path(), 10).save(folder / "out/m.obj");
    EXPECT_NE(FileBytes(folder / "out/m.mtl").text().find("map_Kd ../t.png\n"), std::string_view::npos);
    EXPECT_FALSE(fs::exists(folder / "out/m_base_color.png"));
}

TEST(MeshMaterialFiles, ObjWritesTexturesWhoseFilesAreGoneOrHaveChanged) {
    const TemporaryFolder folder;
    const Mesh mesh = textured_triangle(folder.path(), 10);
    replace_texture(folder.path(), 20);
    mesh.save(folder / "changed.obj");
    EXPECT_EQ(value_in(folder / "changed.obj"), 10);
    EXPECT_EQ(int(io::load_image(folder / "t.png").at<uint8_t>(0, 0)[0]), 20);
    fs::remove(folder / "t.png");
    mesh.save(folder / "gone.obj");
    EXPECT_EQ(value_in(folder / "gone.obj"), 10);
    // Of a mesh whose textures are in another state than those of the file that it is saved as.
    const Mesh saved(folder / "gone.obj");
    const fs::path painted = folder / "gone_base_color.png";
    io::save_image(*flat(30), painted);
    fs::last_write_time(painted, fs::last_write_time(painted) + std::chrono::seconds(5));
    saved.save(folder / "gone.obj");
    EXPECT_EQ(value_in(folder / "gone.obj"), 10);
    EXPECT_EQ(int(io::load_image(painted).at<uint8_t>(0, 0)[0]), 30) << "what a person painted stays";
}

TEST(MeshMaterialFiles, PlyWarnsOfATextureWhoseFileHasChanged) {
    const TemporaryFolder folder;
    const Mesh mesh = textured_triangle(folder.path(), 10);
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    mesh.save(folder / "same.ply");
    EXPECT_EQ(warnings.find("its file"), std::string::npos) << warnings;
    replace_texture(folder.path(), 20);
    mesh.save(folder / "changed.ply");
    set_log_sink({});
    EXPECT_NE(warnings.find("changed.ply: the texture is left out: its file " + (folder / "t.png").string() +
                            " is gone or has changed"),
              std::string::npos)
        << warnings;
    EXPECT_NE(FileBytes(folder / "same.ply").text().find("TextureFile"), std::string_view::npos);
    EXPECT_EQ(FileBytes(folder / "changed.ply").text().find("TextureFile"), std::string_view::npos);
}

TEST(MeshMaterialFiles, FilesOfMeshesAndTexturesAreKeptAsAbsolutePaths) {
    const TemporaryFolder folder;
    textured_triangle(folder.path(), 10);
    const auto mesh = Mesh(fs::relative(folder / "in.obj")).snapshot();
    EXPECT_TRUE(mesh->source.is_absolute()) << mesh->source;
    EXPECT_TRUE(fs::equivalent(mesh->source, folder / "in.obj"));
    const fs::path texture = mesh->materials.at(0).base_color_texture.path;
    EXPECT_TRUE(texture.is_absolute()) << texture;
    EXPECT_TRUE(fs::equivalent(texture, folder / "t.png"));
}

TEST(MeshMaterialFiles, PlySaysWhichTexturesItLeavesOut) {
    const TemporaryFolder folder;
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    MeshData mesh = random_mesh(3, 10);
    mesh.materials.resize(1);
    Mesh(mesh).save(folder / "m.ply");
    EXPECT_EQ(warnings, "");
    mesh.materials[0].base_color_texture.image = flat(1);
    Mesh(mesh).save(folder / "m.ply");
    set_log_sink({});
    EXPECT_NE(warnings.find("no place for material.base_color_texture: left out"), std::string::npos)
        << warnings;
}

TEST(MeshMaterialFiles, PlyRefersToItsTexture) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    io::save_image(Image(2, 2, 3, PixelType::u8), folder / "t.png");
    MeshData mesh = random_mesh(3, 10);
    mesh.materials.emplace_back();
    mesh.materials[0].base_color_texture.path = (folder / "t.png").string();
    Mesh(mesh).save(folder / "out/m.ply");
    const auto back = Mesh(folder / "out/m.ply").snapshot();
    ASSERT_EQ(back->materials.size(), 1u);
    EXPECT_TRUE(back->materials[0].base_color_texture);
}

TEST(MeshMaterialFiles, ObjColorsAreWrittenBesideWhite) {
    const TemporaryFolder folder;
    MeshData mesh = random_mesh(7, 30);
    mesh.C = ArrayXf::Dense::Constant(mesh.V.rows(), 3, 0.5f);
    mesh.materials.resize(1);
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_EQ(Mesh(folder / "m.obj").snapshot()->materials.at(0).base_color, Vec3(1, 1, 1));
}

TEST(MeshMaterialFiles, ColorsOfMaterialsBecomeThoseOfVertices) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    mesh.F = Array3i::Dense{{0, 1, 2}, {3, 4, 5}};
    mesh.materials.resize(2);
    mesh.materials[0].base_color = Vec3(1, 0, 0);
    mesh.materials[1].base_color = Vec3(0, 0, 1);
    mesh.materials[1].opacity = 0.5f;
    mesh.materials[1].clearcoat = 1;
    mesh.parts = {{"red", 0, 1, 0}, {"blue", 1, 1, 1}};
    for (const char* name : {"m.ply", "m.npz"}) {
        std::string warnings;
        set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
        Mesh(mesh).save(folder / name);
        set_log_sink({});
        EXPECT_NE(warnings.find("no place for material.clearcoat: left out"), std::string::npos) << warnings;
        const auto back = Mesh(folder / name).snapshot();
        ASSERT_EQ(back->C.cols(), 4) << name;
        // The curve of sRGB takes 1 to 1 within the rounding of its power.
        EXPECT_LE((Eigen::Vector4f(back->C.row(0)) - Eigen::Vector4f(1, 0, 0, 1)).norm(), 1e-6f) << name;
        // An opacity of 0.5 is 128 of 255 in PLY.
        EXPECT_LE((Eigen::Vector4f(back->C.row(5)) - Eigen::Vector4f(0, 0, 1, 0.5f)).norm(),
                  0.5f / 255 + 1e-6f)
            << name;
    }
    // Vertex 2 would have both colours.
    mesh.F = Array3i::Dense{{0, 1, 2}, {2, 4, 5}};
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    Mesh(mesh).save(folder / "m.ply");
    set_log_sink({});
    for (const char* name : {"material.base_color", "material.opacity", "material.clearcoat"})
        EXPECT_NE(warnings.find(name), std::string::npos) << warnings;
    EXPECT_TRUE(Mesh(folder / "m.ply").snapshot()->C.empty());
}

TEST(MeshMaterialFiles, ObjNamesWhatMaterialsLose) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.F = Array3i::Dense{{0, 1, 2}};
    mesh.materials.resize(1);
    mesh.materials[0].metallic = 1;
    mesh.materials[0].emissive = Vec3(1, 2, 3);
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    Mesh(mesh).save(folder / "m.obj");
    EXPECT_EQ(warnings, "");
    mesh.materials[0].transmission = 1;
    mesh.materials[0].alpha_mode = AlphaMode::blend;
    mesh.materials[0].occlusion_texture.image = flat(1);
    Mesh(mesh).save(folder / "m.obj");
    set_log_sink({});
    EXPECT_NE(
        warnings.find("material.transmission, material.occlusion_texture, material.alpha_mode: left out"),
        std::string::npos)
        << warnings;
}

}  // namespace easypbr::mesh_material_files_test
