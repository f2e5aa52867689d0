// How textures lie on faces of files in formats that have less for it than glTF.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/texture_mapping.h"
#include "io/flat_image.h"
#include "io/temporary_folder.h"

namespace easypbr::texture_mapping_test {

namespace {

/// A square whose texture coordinates are its corners.
MeshData textured_square(const fs::path& image) {
    MeshData mesh;
    mesh.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {0, 2, 3}});
    mesh.UV = Array2f(Array2f::Dense{{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    mesh.materials.resize(1);
    mesh.materials[0].base_color_texture.image = flat(1);
    mesh.materials[0].base_color_texture.path = image.string();
    return mesh;
}

/// What is said while a mesh is written.
std::string warnings_of(const MeshData& mesh, const fs::path& path) {
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    Mesh(mesh).save(path);
    set_log_sink({});
    return warnings;
}

Vec2 uv_in_image(const MeshData& mesh, int row) {
    const Mat3& M = mesh.materials.at(0).base_color_texture.uv_transform;
    return (M * Vec3(mesh.UV(row, 0), mesh.UV(row, 1), 1)).head<2>();
}

}  // namespace

TEST(TextureMapping, TextureTransformsBecomePartOfTheTextureCoordinates) {
    const TemporaryFolder folder;
    io::save_image(*flat(1), folder / "t.png");
    MeshData mesh = textured_square(folder / "t.png");
    Mat3 turned, scaled;
    turned << 0, -2, 0.5f, 2, 0, 0.25f, 0, 0, 1;
    scaled << 2, 0, 0.5f, 0, 3, 0.25f, 0, 0, 1;
    for (const Mat3& M : {turned, scaled})
        for (const char* name : {"m.obj", "m.ply"}) {
            mesh.materials[0].base_color_texture.uv_transform = M;
            EXPECT_EQ(warnings_of(mesh, folder / name), "");
            const auto back = Mesh(folder / name).snapshot();
            // All numbers are quarters, which floats hold.
            for (int i = 0; i < 4; ++i) EXPECT_EQ(uv_in_image(*back, i), uv_in_image(mesh, i)) << name << i;
        }
}

TEST(TextureMapping, TextureTransformsThatDifferAreLeftOutWithAWarning) {
    const TemporaryFolder folder;
    io::save_image(*flat(1), folder / "t.png");
    MeshData mesh = textured_square(folder / "t.png");
    mesh.materials[0].roughness_texture = mesh.materials[0].base_color_texture;
    mesh.materials[0].base_color_texture.uv_transform << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    EXPECT_NE(warnings_of(mesh, folder / "m.obj").find("no place for texture transforms: left out"),
              std::string::npos);
    EXPECT_EQ(Array2f::Dense(Mesh(folder / "m.obj").UV()), Array2f::Dense(mesh.UV));
    // The same where two materials share vertices.
    mesh.materials[0].roughness_texture = {};
    mesh.materials.resize(2);
    mesh.parts = {{"a", 0, 1, 0}, {"b", 1, 1, 1}};
    EXPECT_NE(warnings_of(mesh, folder / "m.obj").find("texture transforms"), std::string::npos);
    // With vertices of its own each part has its own coordinates.
    mesh.V = Array3f(Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    mesh.UV = Array2f(Array2f::Dense{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}});
    mesh.F = Array3i(Array3i::Dense{{0, 1, 2}, {3, 4, 5}});
    EXPECT_EQ(warnings_of(mesh, folder / "m.obj"), "");
    EXPECT_EQ(Array2f::Dense(Mesh(folder / "m.obj").UV()),
              (Array2f::Dense{{0, 0}, {0, 1}, {-1, 1}, {0, 0}, {1, 1}, {0, 1}}));
}

TEST(TextureMapping, WrapsWithoutAPlaceAreNamedWhereCoordinatesLeaveTheImage) {
    const TemporaryFolder folder;
    io::save_image(*flat(1), folder / "t.png");
    MeshData mesh = textured_square(folder / "t.png");
    Texture& texture = mesh.materials[0].base_color_texture;
    const auto is_named = [&](const char* name, Wrap u, Wrap v) {
        texture.wrap_u = u, texture.wrap_v = v;
        return warnings_of(mesh, folder / name).find("no place for wraps of textures") != std::string::npos;
    };
    EXPECT_FALSE(is_named("m.obj", Wrap::mirror, Wrap::mirror)) << "all is within the image";
    texture.uv_transform.diagonal() << 2, 2, 1;
    EXPECT_TRUE(is_named("m.obj", Wrap::mirror, Wrap::mirror));
    EXPECT_TRUE(is_named("m.obj", Wrap::clamp, Wrap::repeat));
    EXPECT_EQ(Mesh(folder / "m.obj").snapshot()->materials.at(0).base_color_texture.wrap_u, Wrap::repeat);
    EXPECT_FALSE(is_named("m.obj", Wrap::clamp, Wrap::clamp));
    EXPECT_EQ(Mesh(folder / "m.obj").snapshot()->materials.at(0).base_color_texture.wrap_v, Wrap::clamp);
    EXPECT_FALSE(is_named("m.obj", Wrap::repeat, Wrap::repeat));
    EXPECT_TRUE(is_named("m.ply", Wrap::clamp, Wrap::clamp));
    EXPECT_FALSE(is_named("m.ply", Wrap::repeat, Wrap::repeat));
}

TEST(TextureMapping, FiltersWithoutAPlaceAreNamed) {
    const TemporaryFolder folder;
    io::save_image(*flat(1), folder / "t.png");
    MeshData mesh = textured_square(folder / "t.png");
    Texture& texture = mesh.materials[0].base_color_texture;
    for (const char* name : {"m.obj", "m.ply"}) {
        texture.filter = Filter::linear;
        EXPECT_EQ(warnings_of(mesh, folder / name), "");
        texture.filter = Filter::nearest;
        EXPECT_NE(warnings_of(mesh, folder / name).find("no place for filters of textures: left out"),
                  std::string::npos)
            << name;
    }
    EXPECT_EQ(warnings_of(mesh, folder / "m.glb"), "") << "glTF has samplers";
}

// Codes of opacity have no curve: 0.1 is code 26, within 32 of 0, as light it would be code 89. 0.2 is
// code 51.
TEST(TextureMapping, MasksOfFloatsAreThoseOfTheirNumbers) {
    for (const bool is_mask : {true, false}) {
        auto image = std::make_shared<Image>(1, 2, 1, PixelType::f32);
        image->at<float>(0, 0)[0] = is_mask ? 0.1f : 0.2f;
        image->at<float>(0, 1)[0] = 1;
        Texture texture;
        texture.image = image;
        EXPECT_EQ(io::obj_alpha_mode(1, texture), is_mask ? AlphaMode::mask : AlphaMode::blend);
    }
}

}  // namespace easypbr::texture_mapping_test
