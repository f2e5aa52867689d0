// Files of 3D Gaussian splats: PLY as the reference implementation writes it, and .splat.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/splat_names.h"
#include "io/bytes.h"
#include "io/ply_builder.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"

namespace easypbr::splat_files_test {
namespace {

constexpr double constant = 0.28209479177387814;
const std::vector<std::string> formats{"ascii", "binary_little_endian", "binary_big_endian"};

/// Names of the properties for a degree, in the order of the reference implementation.
std::vector<std::string> property_names(int degree) {
    std::vector<std::string> names{"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"};
    const int rest = 3 * ((degree + 1) * (degree + 1) - 1);
    for (int i = 0; i < rest; ++i) names.push_back("f_rest_" + std::to_string(i));
    for (const char* name : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        names.emplace_back(name);
    return names;
}

/// What the tests put into a property of a splat.
double value_of(const std::string& name, int splat) {
    if (name[0] == 'n') return 0;
    if (name == "rot_0") return 1;
    return 0.01 * double(name.size() * 7 + size_t(name.back())) + splat - 1;
}

std::string ply_of(const std::string& format, const std::vector<std::string>& names, int count = 2) {
    PlyBuilder ply(format);
    ply.header("element vertex " + std::to_string(count));
    for (const std::string& name : names) ply.header("property float " + name);
    ply.end_header();
    for (int i = 0; i < count; ++i) {
        for (const std::string& name : names) ply.value("float", value_of(name, i));
        ply.end_row();
    }
    return ply.text();
}

MeshData read(const std::string& text) {
    MeshData mesh = io::read_ply(io::Source(std::string_view(text), "test.ply"));
    validate(mesh);
    return mesh;
}

TEST(SplatFiles, PlyOfAllDegreesAndFormats) {
    for (const std::string& format : formats)
        for (int degree = 0; degree <= 3; ++degree) {
            const MeshData mesh = read(ply_of(format, property_names(degree)));
            const SplatArrays& splats = mesh.splats;
            ASSERT_EQ(mesh.V.rows(), 2);
            ASSERT_EQ(splats.degree(), degree);
            EXPECT_TRUE(mesh.N.empty());
            EXPECT_TRUE(mesh.scalars.empty());
            EXPECT_EQ(mesh.up, Vec3d(0, -1, 0));
            const int rest = (degree + 1) * (degree + 1) - 1;
            for (int i = 0; i < 2; ++i) {
                const auto value = [&](const std::string& name) { return value_of(name, i); };
                // exp() of single precision numbers of this size, and their rounding.
                for (int k = 0; k < 3; ++k) {
                    const double scale = std::exp(value("scale_" + std::to_string(k)));
                    EXPECT_NEAR(splats.scales(i, k), scale, 1e-6 * scale);
                    EXPECT_FLOAT_EQ(splats.sh(i, k), float(value("f_dc_" + std::to_string(k))));
                    for (int l = 0; l < rest; ++l)
                        EXPECT_FLOAT_EQ(splats.sh(i, 3 * (l + 1) + k),
                                        float(value("f_rest_" + std::to_string(k * rest + l))));
                }
                EXPECT_NEAR(splats.opacities(i), 1 / (1 + std::exp(-value("opacity"))), 1e-6);
                for (int k = 0; k < 4; ++k)
                    EXPECT_FLOAT_EQ(splats.rotations(i, k), float(value("rot_" + std::to_string(k))));
            }
        }
}

TEST(SplatFiles, FlatSplatsHaveNoThirdScale) {
    std::vector<std::string> names = property_names(0);
    std::erase(names, "scale_2");
    const MeshData mesh = read(ply_of("binary_little_endian", names));
    EXPECT_EQ(mesh.splats.scales(0, 2), 0);
    EXPECT_GT(mesh.splats.scales(0, 1), 0);
}

TEST(SplatFiles, CloudsWithOtherScalarsStayClouds) {
    EXPECT_TRUE(read(ply_of("ascii", {"x", "y", "z", "opacity", "scale_0"})).splats.empty());
}

std::string message_of(const std::string& text) {
    try {
        read(text);
    } catch (const FormatError& error) {
        return error.what();
    }
    return {};
}

TEST(SplatFiles, SayWhatIsWrong) {
    std::vector<std::string> names = property_names(3);
    std::erase(names, "rot_2");
    EXPECT_NE(message_of(ply_of("ascii", names)).find("'rot_2' is missing"), std::string::npos);
    names = property_names(3);
    std::erase(names, "f_rest_44");
    EXPECT_NE(message_of(ply_of("ascii", names)).find("found 44"), std::string::npos);
    std::string whole = ply_of("binary_little_endian", property_names(1));
    EXPECT_NE(message_of(whole.substr(0, whole.size() - 10)).find("truncated"), std::string::npos);
    // The last number is rot_3 of the second splat; that before the last eight scale_0... opacity.
    const float nan = std::nanf("");
    std::memcpy(whole.data() + whole.size() - 8 * sizeof nan, &nan, sizeof nan);
    EXPECT_NE(message_of(whole).find("splat 1 of 2"), std::string::npos);
}

TEST(SplatFiles, WrittenAndReadPlyIsTheSame) {
    MeshData mesh = read(ply_of("ascii", property_names(3)));
    mesh.up = Vec3d(0, 1, 0);
    const TemporaryFolder folder;
    io::save_mesh(Mesh(mesh), folder.path() / "a.ply");
    const auto back = io::load_mesh(folder.path() / "a.ply").snapshot();
    EXPECT_EQ(back->V, mesh.V);
    EXPECT_EQ(back->up, mesh.up);
    EXPECT_EQ(back->splats.sh, mesh.splats.sh);
    EXPECT_EQ(back->splats.rotations, mesh.splats.rotations);
    // log() and exp() of single precision.
    EXPECT_TRUE(back->splats.scales.isApprox(mesh.splats.scales, 1e-6f));
    EXPECT_TRUE(back->splats.opacities.isApprox(mesh.splats.opacities, 1e-6f));
}

TEST(SplatFiles, ScalarsMayHaveTheNamesOfSplats) {
    MeshData cloud;
    cloud.V = Array3f::Dense(Array3f::Dense::Random(2, 3));
    std::vector<std::string> names = property_names(1);
    for (const char* name : {"f_rest_9", "packed_position", "packed_rotation", "packed_scale", "packed_color",
                             "_opacity", "Opacity"})
        names.emplace_back(name);
    std::erase_if(names, [](const std::string& name) { return name.size() == 1 || name.starts_with("n"); });
    for (const std::string& name : names)
        cloud.scalars.push_back({name, Array1f::Dense(Array1f::Dense::Random(2))});
    MeshData splats = cloud;
    splats.splats = read(ply_of("ascii", property_names(1))).splats;
    const TemporaryFolder folder;
    for (const MeshData* mesh : {&cloud, &splats})
        for (const char* file : {"a.ply", "a.csv", "a.pcd", "a.npy", "a.npz"}) {
            if (mesh == &splats && std::string(file) != "a.ply") continue;  // They have no splats.
            io::save_mesh(Mesh(*mesh), folder.path() / file);
            const auto back = io::load_mesh(folder.path() / file).snapshot();
            EXPECT_TRUE(same_bits(back->splats.sh, mesh->splats.sh)) << file;
            ASSERT_EQ(back->scalars.size(), names.size()) << file;
            for (size_t i = 0; i < names.size(); ++i)
                EXPECT_TRUE(same_bits(scalar_named(*back, names[i]).values, mesh->scalars[i].values))
                    << file << " " << names[i];
        }
}

TEST(SplatFiles, WrittenExtremesAreFinite) {
    MeshData mesh = read(ply_of("ascii", property_names(0)));
    Array1f::Dense opacities(2);
    opacities << 0, 1;
    mesh.splats.opacities = std::move(opacities);
    mesh.splats.scales = Array3f(Array3f::Dense::Zero(2, 3));
    const MeshData back = read(io::encode_ply(mesh, {}));
    EXPECT_NEAR(back.splats.opacities(0), 0, 1e-6);
    EXPECT_NEAR(back.splats.opacities(1), 1, 1e-6);
    EXPECT_NEAR(back.splats.scales(0, 0), 0, 1e-6);
}

std::string splat_file() {
    Bytes bytes;
    bytes.add_all<float>({1, 2, 3, 0.1f, 0.2f, 0.3f}).add_all<uint8_t>({255, 128, 0, 51, 255, 128, 0, 192});
    bytes.add_all<float>({-1, -2, -3, 0.4f, 0.5f, 0.6f}).add_all<uint8_t>({0, 0, 0, 255, 128, 128, 128, 128});
    return bytes.str();
}

// What is written for splats has the names by which readers tell them, beside positions and normals.
TEST(SplatFiles, WrittenNamesAreThoseOfReaders) {
    const std::vector<std::string> names = property_names(3);
    const std::string text = io::encode_ply(read(ply_of("ascii", names)), ".");
    std::istringstream lines(text.substr(0, text.find("end_header")));
    const std::string property = "property float ";
    size_t count = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::string name = line.starts_with(property) ? line.substr(property.size()) : "x";
        if (name.size() <= 2) continue;  // x, nx
        ++count;
        EXPECT_TRUE(io::is_splat_name(name)) << name;
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
    }
    EXPECT_EQ(count, names.size() - 6);
}

MeshData read_records(const std::string& text) {
    MeshData mesh = io::read_splat(io::Source(std::string_view(text), "test.splat"));
    validate(mesh);
    return mesh;
}

TEST(SplatFiles, RecordsOf32Bytes) {
    const MeshData mesh = read_records(splat_file());
    ASSERT_EQ(mesh.V.rows(), 2);
    EXPECT_EQ(mesh.V(1, 2), -3);
    EXPECT_EQ(mesh.splats.scales(0, 1), 0.2f);
    EXPECT_EQ(mesh.splats.degree(), 0);
    EXPECT_NEAR(0.5 + constant * double(mesh.splats.sh(0, 1)), 128 / 255.0, 1e-6);
    EXPECT_NEAR(mesh.splats.opacities(0), 51 / 255.0, 1e-6);
    EXPECT_EQ(mesh.splats.rotations.row(0), Eigen::RowVector4f(127 / 128.0f, 0, -1, 0.5f));
    EXPECT_EQ(mesh.splats.rotations.row(1), Eigen::RowVector4f(1, 0, 0, 0));
}

TEST(SplatFiles, DamagedRecordsAreRefused) {
    std::string text = splat_file();
    EXPECT_THROW(read_records(text.substr(0, 63)), FormatError);
    EXPECT_THROW(read_records(""), FormatError);
    const float nan = std::nanf("");
    std::memcpy(text.data() + 32 + 12, &nan, sizeof nan);
    EXPECT_THROW(read_records(text), FormatError);
}

}  // namespace
}  // namespace easypbr::splat_files_test
