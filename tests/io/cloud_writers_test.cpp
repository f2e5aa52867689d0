// What is written for clouds comes back as it was.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"

namespace easypbr::cloud_writers_test {

namespace {

/// A cloud with every attribute; text has to hold any bits.
MeshData cloud(int n) {
    MeshData mesh;
    const auto wave = [](int i) { return float(std::sin(i * 12.9898) * 0.7); };
    mesh.V = Array3f::Dense::NullaryExpr(n, 3, [&](auto i, auto k) { return wave(int(3 * i + k)); });
    mesh.N = Array3f::Dense(mesh.V.rowwise().normalized());
    mesh.C = ArrayXf::Dense(ArrayXf::Dense::NullaryExpr(
        n, 4, [](auto i, auto k) { return float((i * 7 + k * 50) % 256 * (1 / 255.0)); }));
    mesh.UV = Array2f::Dense::NullaryExpr(n, 2, [&](auto i, auto k) { return wave(int(i + 100 * k)); });
    mesh.T = Array3f::Dense::NullaryExpr(n, 3, [&](auto i, auto k) { return wave(int(i - k)) * 1e-7f; });
    mesh.B = Array1f::Dense::NullaryExpr(n, [&](auto i) { return wave(int(i)) * 1e9f; });
    mesh.L = Array1i::Dense::NullaryExpr(n, [](auto i) { return int32_t(i * 1'000'003 - 1); });
    mesh.I = Array1f::Dense::NullaryExpr(n, [&](auto i) { return 100 + wave(int(i)); });
    mesh.scalars = {{"heat", mesh.I}, {"point error", mesh.B}};
    return mesh;
}

void expect_same(const MeshData& mesh, const MeshData& back, const std::string& name) {
    EXPECT_TRUE(same_bits(mesh.V, back.V)) << name;
    EXPECT_TRUE(same_bits(mesh.N, back.N)) << name;
    EXPECT_TRUE(same_bits(mesh.UV, back.UV)) << name;
    EXPECT_TRUE(same_bits(mesh.T, back.T)) << name;
    EXPECT_TRUE(same_bits(mesh.B, back.B)) << name;
    EXPECT_TRUE(same_bits(mesh.L, back.L)) << name;
    EXPECT_TRUE(same_bits(mesh.I, back.I)) << name;
    ASSERT_EQ(back.scalars.size(), 2u) << name;
    EXPECT_EQ(back.scalars[0].name, "heat") << name;
    EXPECT_EQ(back.scalars[1].name, "point_error") << name;
    EXPECT_TRUE(same_bits(mesh.scalars[1].values, back.scalars[1].values)) << name;
    ASSERT_EQ(back.C.cols(), 4) << name;
    // One rounding of the multiplication by 1 / 255, one of the division.
    EXPECT_LE((mesh.C - back.C).cwiseAbs().maxCoeff(), 1.2e-7f) << name;
}

}  // namespace

TEST(CloudFiles, ComeBackAsTheyWere) {
    const TemporaryFolder folder;
    // More than a writer's and less than a reader's piece, and one point.
    for (const int n : {40'000, 1})
        for (const char* name : {"c.pcd", "c.xyz", "c.txt", "c.asc", "c.csv", "c.npy", "c.npz", "c.ply"}) {
            const MeshData mesh = cloud(n);
            Mesh(mesh).save(folder / name);
            expect_same(mesh, *Mesh(folder / name).snapshot(), fmt::format("{} with {} points", name, n));
        }
}

TEST(CloudFiles, ScalarsKeepNamesThatMeanSomethingElse) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense(Array3f::Dense::Random(6, 3));
    mesh.UV = Array2f::Dense(Array2f::Dense::Random(6, 2));
    mesh.C = ArrayXf::Dense::Constant(6, 3, 1.0f);
    for (const char* name :
         {"T", "V", "F",  "N",     "E",     "C",         "L",   "I",      "u",  "v",           "s",
          "t", "x", "nx", "alpha", "label", "intensity", "rgb", "offset", "_T", "scalar_heat", "_heat"})
        mesh.scalars.push_back({name, Array1f::Dense(Array1f::Dense::Random(6))});
    for (const char* name : {"c.pcd", "c.csv", "c.npy", "c.npz", "c.ply"}) {
        Mesh(mesh).save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        EXPECT_TRUE(same_bits(mesh.UV, back->UV)) << name;
        EXPECT_EQ(back->C.cols(), 3) << name;
        EXPECT_TRUE(back->N.empty() && back->T.empty() && back->F.empty()) << name;
        EXPECT_TRUE(back->L.empty() && back->I.empty()) << name;
        ASSERT_EQ(back->scalars.size(), mesh.scalars.size()) << name;
        for (size_t i = 0; i < mesh.scalars.size(); ++i) {
            const auto found = std::ranges::find(back->scalars, mesh.scalars[i].name, &ScalarArray::name);
            ASSERT_NE(found, back->scalars.end()) << name << " " << mesh.scalars[i].name;
            EXPECT_TRUE(same_bits(mesh.scalars[i].values, found->values)) << name;
        }
    }
}

TEST(CloudFiles, KeepTheOffset) {
    const TemporaryFolder folder;
    MeshData mesh = cloud(1000);
    mesh.offset = {691'000, 5'335'000, 520};
    for (const char* name : {"c.pcd", "c.xyz", "c.csv", "c.npy", "c.npz", "c.ply"}) {
        Mesh(mesh).save(folder / name);
        const auto back = Mesh(folder / name).snapshot();
        ASSERT_EQ(back->V.rows(), 1000) << name;
        for (Eigen::Index i = 0; i < 1000; ++i) {
            const Vec3d given = mesh.offset + mesh.V.row(i).transpose().cast<double>();
            const Vec3d read = back->offset + back->V.row(i).transpose().cast<double>();
            // float64 at 5e6 in the file, and half the spacing of float32 up to 2 in memory.
            ASSERT_LE((read - given).cwiseAbs().maxCoeff(), std::exp2(-24.0) + 1e-9) << name << " " << i;
        }
    }
}

TEST(CloudFiles, ColorsOfDarkCloudsStayDark) {
    const TemporaryFolder folder;
    // All bytes are 0, or at most 1, where numbers alone would be full intensity; or one more.
    for (const int most : {0, 1, 2})
        for (const int columns : {3, 4}) {
            MeshData mesh = cloud(4);
            mesh.C = ArrayXf::Dense(ArrayXf::Dense::NullaryExpr(
                4, columns, [&](auto i, auto k) { return (i + k) % 2 ? float(most) / 255 : 0.0f; }));
            for (const char* name : {"c.xyz", "c.txt", "c.asc", "c.csv", "c.ply", "c.npy"}) {
                io::save_mesh(Mesh(mesh), folder / name);
                const auto back = io::load_mesh(folder / name).snapshot();
                ASSERT_EQ(back->C.cols(), columns) << name;
                // One rounding of the quotient in the file, one of that here.
                EXPECT_LE((mesh.C - back->C).cwiseAbs().maxCoeff(), 1e-9f) << name << " up to " << most;
            }
        }
}

TEST(CloudFiles, NpzKeepsFacesEdgesAndTheirValues) {
    const TemporaryFolder folder;
    MeshData mesh = cloud(10);
    mesh.F = Array3i::Dense::NullaryExpr(4, 3, [](auto i, auto k) { return int32_t(i + k); });
    mesh.E = Array2i::Dense::NullaryExpr(3, 2, [](auto i, auto k) { return int32_t(i + k); });
    mesh.scalars = {{"area", Array1f::Dense::Constant(4, 0.5f)}};
    Mesh(mesh).save(folder / "m.npz");
    const auto back = Mesh(folder / "m.npz").snapshot();
    EXPECT_TRUE(same_bits(mesh.F, back->F));
    EXPECT_TRUE(same_bits(mesh.E, back->E));
    ASSERT_EQ(back->scalars.size(), 1u);
    EXPECT_EQ(back->scalars[0].values[3], 0.5f);
}

TEST(CloudFiles, FormatsOfPointsSayThatFacesAreLeftOut) {
    const TemporaryFolder folder;
    MeshData mesh = cloud(10);
    mesh.F = Array3i::Dense::Zero(2, 3);
    mesh.scalars = {};
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    Mesh(mesh).save(folder / "m.pcd");
    set_log_sink({});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("2 faces"), std::string::npos) << warnings[0];
}

TEST(CloudFiles, WhatAFormatHasNoPlaceForIsNamed) {
    const TemporaryFolder folder;
    MeshData mesh = cloud(10);
    mesh.C = ArrayXf::Dense::Constant(10, 4, 0.5f);
    mesh.scalars = {{"heat", Array1f::Dense::Zero(10)}, {"area", Array1f::Dense::Zero(2)}};
    mesh.F = Array3i::Dense::Zero(2, 3);
    const auto warnings_of = [&](const char* name) {
        std::string warnings;
        set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
        Mesh(mesh).save(folder / name);
        set_log_sink({});
        return warnings;
    };
    const std::string obj = warnings_of("m.obj");
    for (const char* name : {"alpha", "tangents", "labels", "intensities", "'heat'", "'area'"})
        EXPECT_NE(obj.find(name), std::string::npos) << name << " in " << obj;
    EXPECT_NE(warnings_of("m.csv").find("scalars 'area' of faces"), std::string::npos);
    EXPECT_EQ(warnings_of("m.csv").find("heat"), std::string::npos);
    EXPECT_EQ(warnings_of("m.ply"), "");
    EXPECT_EQ(warnings_of("m.npz"), "");
}

TEST(CloudFiles, ObjKeepsTheNormalsOfACloud) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense(Array3f::Dense::Random(10, 3));
    Array3f::Dense N = Array3f::Dense::Random(10, 3);
    N.rowwise().normalize();
    mesh.N = std::move(N);
    mesh.UV = Array2f::Dense(Array2f::Dense::Random(10, 2));
    Mesh(mesh).save(folder / "c.obj");
    const auto back = Mesh(folder / "c.obj").snapshot();
    EXPECT_EQ(Array3f::Dense(back->N), Array3f::Dense(mesh.N));
    EXPECT_EQ(Array2f::Dense(back->UV), Array2f::Dense(mesh.UV));
}

TEST(CloudFiles, ChildrenAreMerged) {
    const TemporaryFolder folder;
    Mesh root = Mesh(cloud(10)), child = Mesh(cloud(5));
    child.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(100, 0, 0)));
    root.add_child(child);
    root.save(folder / "m.xyz");
    const auto back = Mesh(folder / "m.xyz").snapshot();
    ASSERT_EQ(back->V.rows(), 15);
    EXPECT_FLOAT_EQ(back->V(10, 0), child.V()(0, 0) + 100);
}

TEST(CloudFiles, ScalarsKeepNamesInOtherLetters) {
    const TemporaryFolder folder;
    MeshData mesh;
    mesh.V = Array3f::Dense(Array3f::Dense::Random(3, 3));
    for (const char* name : {"温度", "湿度", "größe", "a b", "a_b", "a,b", "heat (K)", "50%"})
        mesh.scalars.push_back({name, Array1f::Dense::Constant(3, float(mesh.scalars.size()))});
    for (const char* file : {"c.pcd", "c.csv", "c.xyz", "c.npy", "c.npz", "c.ply"}) {
        std::vector<std::string> warnings;
        set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
        Mesh(mesh).save(folder / file);
        set_log_sink({});
        ASSERT_EQ(warnings.size(), 1u) << file;
        for (const char* part : {"'a b' as 'a_b_2'", "'a,b' as 'a_b_3'", "'heat (K)' as 'heat__K_'"})
            EXPECT_NE(warnings[0].find(part), std::string::npos) << file << ": " << warnings[0];
        EXPECT_EQ(warnings[0].find("温度"), std::string::npos) << file;
        const auto back = Mesh(folder / file).snapshot();
        ASSERT_EQ(back->scalars.size(), mesh.scalars.size()) << file;
        float value = 0;
        for (const char* name : {"温度", "湿度", "größe", "a_b_2", "a_b", "a_b_3", "heat__K_", "50%"}) {
            const auto found = std::ranges::find(back->scalars, name, &ScalarArray::name);
            ASSERT_NE(found, back->scalars.end()) << file << " " << name;
            EXPECT_EQ(found->values[0], value++) << file << " " << name;
        }
    }
}

}  // namespace easypbr::cloud_writers_test
