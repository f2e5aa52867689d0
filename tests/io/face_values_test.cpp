// Values of faces that a mesh has no place for: what is said of them.
#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/npy_builder.h"
#include "io/ply_builder.h"

namespace easypbr::face_values_test {
namespace {

using Texts = std::vector<std::string>;

struct Read {
    MeshData mesh;
    Texts warnings;
};

Read read(MeshData (*reader)(const io::Source&), const std::string& bytes) {
    Read result;
    set_log_sink([&](LogLevel, std::string_view message) { result.warnings.emplace_back(message); });
    result.mesh = reader(io::Source(std::string_view(bytes), "test"));
    set_log_sink({});
    validate(result.mesh);
    return result;
}

/// A face of vertices 0 to 2 with a value of each kind and, where it is asked for, a strip of them all.
std::string ply_of(const std::string& format, bool with_strip) {
    PlyBuilder ply(format);
    ply.header("comment TextureFile a.png\ncomment TextureFile b.png\nelement vertex 4\nproperty float x")
        .header("property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices")
        .header("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int label")
        .header("property float quality\nproperty double scalar_area\nproperty int texnumber");
    if (with_strip) ply.header("element tristrips 1\nproperty list int int vertex_indices");
    ply.end_header();
    for (const auto& corner : {std::array{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}})
        ply.values("float", corner).end_row();
    ply.value("uchar", 3).values("int", {0, 1, 2}).values("uchar", {255, 0, 0}).value("int", 7);
    ply.value("float", 0.5).value("double", 0.25).value("int", 1).end_row();
    if (with_strip) ply.values("int", {4, 0, 1, 2, 3}).end_row();
    return ply.text();
}

}  // namespace

// The textures are not there, which is said as well.
TEST(Ply, NamesValuesOfFacesBesideStrips) {
    const auto is_of_textures = [](const std::string& text) { return text.find(".png") != text.npos; };
    const std::string why = " of the faces are left out: there are triangle strips beside them";
    for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        Read with_strip = read(io::read_ply, ply_of(format, true));
        EXPECT_EQ(with_strip.mesh.F.rows(), 3) << "the face and the two triangles of the strip";
        EXPECT_TRUE(with_strip.mesh.C.empty());
        EXPECT_TRUE(with_strip.mesh.L.empty());
        EXPECT_TRUE(with_strip.mesh.scalars.empty());
        std::erase_if(with_strip.warnings, is_of_textures);
        EXPECT_EQ(with_strip.warnings, (Texts{"test: the colours" + why, "test: the texture numbers" + why,
                                              "test: the labels" + why, "test: the scalars 'quality'" + why,
                                              "test: the scalars 'area'" + why}))
            << format;
        Read alone = read(io::read_ply, ply_of(format, false));
        EXPECT_EQ(alone.mesh.L[0], 7);
        EXPECT_EQ(alone.mesh.scalars.size(), 2u);
        std::erase_if(alone.warnings, is_of_textures);
        EXPECT_EQ(alone.warnings, Texts());
    }
}

// "scalar_" is no part of a name, as in PLY. Two triangles; four values are those of the points.
TEST(Npz, NamesScalarsOfFacesThatThePointsHaveToo) {
    const auto floats = [](std::initializer_list<float> list) { return Bytes().add_all(list).str(); };
    const auto [mesh, warnings] =
        read(io::read_npz,
             npz({{"V.npy", npy("'<f4'", "(4, 3)", floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}))},
                  {"F.npy", npy("'<i4'", "(2, 3)", Bytes().add_all<int32_t>({0, 1, 2, 1, 3, 2}).str())},
                  {"heat.npy", npy("'<f4'", "(4,)", floats({1, 2, 3, 4}))},
                  {"scalar_heat.npy", npy("'<f4'", "(2,)", floats({8, 9}))},
                  {"area.npy", npy("'<f4'", "(2,)", floats({0.5f, 0.25f}))}}));
    EXPECT_EQ(warnings,
              (Texts{"test: the scalars 'heat' of the faces are left out: there are others of that name"}));
    EXPECT_EQ(Vec4(scalar_named(mesh, "heat").values), Vec4(1, 2, 3, 4));
    EXPECT_EQ(Vec2(scalar_named(mesh, "area").values), Vec2(0.5f, 0.25f));
    EXPECT_EQ(mesh.scalars.size(), 2u);
}

}  // namespace easypbr::face_values_test
