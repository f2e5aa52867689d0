// Splats in packed files: SPZ, and SuperSplat's compressed PLY. The files are made here, code by code, and
// the expected values by the formulas of the formats in double precision.
#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/mesh/content_format.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/scene/mesh.h"
#include "io/packed_splats.h"
#include "io/temporary_folder.h"
#include "refusal.h"

namespace easypbr::packed_splats_test {
namespace {

using namespace packed_splats;

// SPZ.

MeshData read_spz(const std::string& packed) {
    MeshData mesh = io::read_spz(io::Source(std::string_view(packed), "test.spz"));
    validate(mesh);
    return mesh;
}

TEST(PackedSplats, SpzOfBothVersions) {
    for (const uint32_t version : {2u, 3u}) {
        const MeshData mesh = read_spz(io::gzip(spz_content(version).str()));
        const SplatArrays& splats = mesh.splats;
        ASSERT_EQ(mesh.V.rows(), 2);
        EXPECT_EQ(mesh.up, Vec3d(0, 1, 0));
        EXPECT_EQ(mesh.V.row(0), Eigen::RowVector3f(1, -1, 1 / 4096.0f));
        EXPECT_EQ(mesh.V.row(1), Eigen::RowVector3f(-1 / 4096.0f, 8388607 / 4096.0f, -2048));
        EXPECT_EQ(splats.opacities(0), 0);
        EXPECT_EQ(splats.opacities(1), 1);
        // Single precision exp() and quotients of these sizes.
        const auto near = [](double found, double expected) {
            EXPECT_NEAR(found, expected, 2e-6 * std::max(1.0, std::abs(expected)));
        };
        near(double(splats.scales(0, 0)), std::exp(-10.0));
        near(double(splats.scales(0, 1)), 1);
        near(double(splats.scales(1, 2)), std::exp(100 / 16.0 - 10));
        near(double(splats.sh(0, 0)), -0.5 / 0.15);
        near(double(splats.sh(1, 2)), (30 / 255.0 - 0.5) / 0.15);
        ASSERT_EQ(splats.degree(), 1);
        near(double(splats.sh(0, 3)), -1);
        near(double(splats.sh(1, 11)), (17 * 15 - 128) / 128.0);
        EXPECT_NEAR(splats.rotations.row(0).norm(), 1, 1e-5);
        if (version == 2) {
            near(double(splats.rotations(0, 1)), 250 / 127.5 - 1);
            near(double(splats.rotations(1, 2)), 191 / 127.5 - 1);
        } else {
            const double unit = std::numbers::sqrt2 / 2 / 511;
            near(double(splats.rotations(0, 1)), 100 * unit);
            near(double(splats.rotations(0, 3)), -200 * unit);
            near(double(splats.rotations(0, 0)), 300 * unit);
            EXPECT_GT(splats.rotations(0, 2), 0.7f);
            EXPECT_EQ(splats.rotations.row(1), Eigen::RowVector4f(1, 0, 0, 0));
        }
    }
}

TEST(PackedSplats, DamagedSpzSaysWhy) {
    const auto said = [](const std::string& packed) { return refusal<Error>([&] { read_spz(packed); }); };
    EXPECT_TRUE(has(said(""), "empty"));
    EXPECT_TRUE(has(said("no gzip at all, but long enough for one"), "no SPZ file"));
    EXPECT_TRUE(has(said(io::gzip("something else that is long enough")), "no SPZ file"));
    EXPECT_TRUE(has(said(io::gzip(spz_header(4, 1, 0).str())), "version 4"));
    EXPECT_TRUE(has(said(io::gzip(spz_header(3, 1, 5).str())), "degree 5"));
    EXPECT_TRUE(has(said(io::gzip(spz_header(3, 1, 0, 77).str())), "77 fractional bits"));
    EXPECT_TRUE(has(said(io::gzip(spz_header(3, 0, 0).str())), "no splats"));
    // More than the file can hold, however well it is compressed.
    EXPECT_TRUE(has(said(io::gzip(spz_header(3, 2000000000, 3).str())), "2000000000 splats"));
    EXPECT_TRUE(has(said(io::gzip(spz_header(3, 3, 1).str() + spz_content(3).str().substr(16))), "3 splats"));
    const std::string whole = io::gzip(spz_content(3).str());
    EXPECT_TRUE(has(said(whole.substr(0, whole.size() / 2)), "truncated"));
    EXPECT_EQ(io::format_of_content(whole), "spz");
}

std::string zstandard(const std::string& bytes) {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
    return packed;
}

/// The same two splats in version 4: a plain header, an extension, the table of sizes, and the arrays.
struct Spz4 {
    explicit Spz4(int degree_ = 1) : degree(degree_) {
        const std::string content = spz_content(3).str().substr(16);
        size_t begin = 0;
        for (const size_t size : {18, 2, 6, 6, 8, 18}) {
            arrays.push_back(content.substr(begin, size));
            begin += size;
        }
    }
    std::string file() const {
        Bytes table;
        std::string packed;
        for (size_t i = 0; i < arrays.size(); ++i) {
            const std::string one = zstandard(arrays[i]);
            table.add_all<uint64_t>({one.size(), arrays[i].size() + (i == 0 ? wrong_size : 0)});
            packed += one;
        }
        Bytes header;
        header.add_all<uint32_t>({0x5053474e, version, count});
        header.add_all<uint8_t>(
            {uint8_t(degree), 12, uint8_t(extension.empty() ? 0 : 2), uint8_t(arrays.size())});
        header.add_all<uint32_t>({uint32_t(32 + extension.size()), 0, 0, 0});
        return header.str() + extension + table.str() + packed;
    }

    uint32_t version = 4, count = 2;
    int degree;
    uint64_t wrong_size = 0;
    std::string extension;
    std::vector<std::string> arrays;
};

void expect_same(const MeshData& a, const MeshData& b) {
    EXPECT_EQ(a.V, b.V);
    EXPECT_EQ(a.splats.scales, b.splats.scales);
    EXPECT_EQ(a.splats.rotations, b.splats.rotations);
    EXPECT_EQ(a.splats.opacities, b.splats.opacities);
    EXPECT_EQ(a.splats.sh, b.splats.sh);
}

// The layout of nianticlabs/spz: magic, version, count, degree, fractional bits, flags, arrays, the table's
// place.
TEST(PackedSplats, SpzOfVersionFourHoldsTheSame) {
    const MeshData third = read_spz(io::gzip(spz_content(3).str()));
    Spz4 plain;
    EXPECT_EQ(io::format_of_content(plain.file()), "spz");
    expect_same(read_spz(plain.file()), third);
    Spz4 extended;
    extended.extension = "an extension of any length";
    expect_same(read_spz(extended.file()), third);
    // Degree 0 has no array of harmonics; of degree 4, which nobody draws, the first three degrees are read.
    Spz4 level(0);
    level.arrays.pop_back();
    EXPECT_EQ(read_spz(level.file()).splats.degree(), 0);
    Spz4 fourth(4);
    fourth.arrays.back() = std::string(2 * 72, '\x80');
    fourth.arrays.back()[72] = '\xff';  // the second splat's first
    const MeshData mesh = read_spz(fourth.file());
    EXPECT_EQ(mesh.splats.degree(), 3);
    EXPECT_EQ(mesh.splats.sh(0, 3), 0);
    EXPECT_EQ(mesh.splats.sh(1, 3), 127 / 128.0f);
}

TEST(PackedSplats, DamagedSpzOfVersionFourSaysWhy) {
    const auto said = [](const Spz4& spz, size_t cut = 0) {
        const std::string file = spz.file();
        return refusal<Error>([&] { read_spz(file.substr(0, file.size() - cut)); });
    };
    EXPECT_EQ(said(Spz4()), "taken");
    EXPECT_TRUE(has(refusal<Error>([] { read_spz(Spz4().file().substr(0, 20)); }), "32 bytes"));
    EXPECT_TRUE(has(said(Spz4(), 1), "beyond the file's end"));
    EXPECT_TRUE(has(refusal<Error>([] { read_spz(Spz4().file().substr(0, 60)); }), "table of arrays"));
    Spz4 spz;
    spz.version = 5;
    EXPECT_TRUE(has(said(spz), "version 5"));
    spz = Spz4();
    spz.count = 3;
    EXPECT_TRUE(has(said(spz), "an array of 18 bytes for 3 splats, which take 27"));
    spz = Spz4();
    spz.count = 4000000000u;
    EXPECT_TRUE(has(said(spz), "4000000000 splats"));
    spz = Spz4();
    spz.wrong_size = 1;
    EXPECT_TRUE(has(said(spz), "an array of 19 bytes"));
    spz = Spz4();
    spz.arrays.pop_back();
    EXPECT_TRUE(has(said(spz), "5 arrays"));
    std::string damaged = Spz4().file();
    damaged[32 + 6 * 16 + 8] ^= 0x55;
    EXPECT_NE(refusal<Error>([&] { read_spz(damaged); }), "taken");
}

TEST(PackedSplats, WrittenSpzDiffersByItsCodes) {
    const MeshData mesh = various_splats(1000);
    const MeshData back = read_spz(io::encode_spz(mesh));
    ASSERT_EQ(back.V.rows(), 1000);
    // Half a step: coordinates below 10 leave 19 bits, rounding of floats of that size twice as much again.
    EXPECT_LE((back.V - mesh.V).cwiseAbs().maxCoeff(), 0.5f / (1 << 19) + 1e-6f);
    EXPECT_LE((back.splats.opacities - mesh.splats.opacities).cwiseAbs().maxCoeff(), 0.5f / 255 + 1e-6f);
    EXPECT_LE((back.splats.scales.array().log() - mesh.splats.scales.array().log()).abs().maxCoeff(),
              0.5f / 16 + 1e-5f);
    EXPECT_LE((back.splats.sh.leftCols(3) - mesh.splats.sh.leftCols(3)).cwiseAbs().maxCoeff(),
              0.5f / (0.15f * 255) + 1e-5f);
    // Steps of 8 and 16 codes of 1/128, and the rounding to a code before.
    EXPECT_LE((back.splats.sh.middleCols(3, 9) - mesh.splats.sh.middleCols(3, 9)).cwiseAbs().maxCoeff(),
              4.5f / 128 + 1e-5f);
    EXPECT_LE((back.splats.sh.rightCols(36) - mesh.splats.sh.rightCols(36)).cwiseAbs().maxCoeff(),
              8.5f / 128 + 1e-5f);
    // Half a step of sqrt(1/2) / 511 in each of three; the largest errs by three times as much where all are
    // as large.
    EXPECT_LE(largest_turn(back.splats.rotations, mesh.splats.rotations), 3 * 0.5f * 0.7072f / 511);
}

TEST(PackedSplats, SpzTurnsWhatPointsDown) {
    MeshData mesh = various_splats(10);
    mesh.up = Vec3d(0, -1, 0);
    const MeshData back = read_spz(io::encode_spz(mesh));
    EXPECT_EQ(back.up, Vec3d(0, 1, 0));
    for (int i = 0; i < 10; ++i) {
        EXPECT_NEAR(back.V(i, 0), mesh.V(i, 0), 1e-5);
        EXPECT_NEAR(back.V(i, 1), -mesh.V(i, 1), 1e-5);
        EXPECT_NEAR(back.V(i, 2), -mesh.V(i, 2), 1e-5);
    }
    // The harmonics of degree 1 are -y, z, -x: the first two change their signs, within the codes' steps.
    EXPECT_NEAR(back.splats.sh(0, 3), -mesh.splats.sh(0, 3), 4.5 / 128 + 1e-5);
    EXPECT_NEAR(back.splats.sh(0, 6), -mesh.splats.sh(0, 6), 4.5 / 128 + 1e-5);
    EXPECT_NEAR(back.splats.sh(0, 9), mesh.splats.sh(0, 9), 4.5 / 128 + 1e-5);
}

TEST(PackedSplats, SpzSaysWherePositionsAreCoarse) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    MeshData mesh = various_splats(100);
    io::encode_spz(mesh);
    EXPECT_TRUE(warnings.empty());
    mesh.offset = Vec3d(691'000, 5'335'000, 500);
    io::encode_spz(mesh);
    set_log_sink({});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_TRUE(has(warnings[0], "steps of 1,")) << warnings[0];
}

TEST(PackedSplats, SpzHoldsSplatsAlone) {
    MeshData points;
    points.V = Array3f(Array3f::Dense::Zero(2, 3));
    EXPECT_TRUE(has(refusal<Error>([&] { io::encode_spz(points); }), "no splats"));
    MeshData far = various_splats(2);
    far.offset = Vec3d(1e7, 0, 0);
    EXPECT_TRUE(has(refusal<Error>([&] { io::encode_spz(far); }), "beyond"));
    const TemporaryFolder folder;
    io::save_mesh(Mesh(various_splats(3)), folder / "a.spz");
    EXPECT_EQ(io::load_mesh(folder / "a.spz").snapshot()->V.rows(), 3);
}

// SuperSplat's PLY.

struct PackedPly {
    int count = 300;
    int harmonics = 9;
    int chunks = 2;
    bool chunk_colors = true;
    std::string drop;  ///< a property that is left out of the header

    std::string text() const {
        std::string out =
            "ply\nformat binary_little_endian 1.0\nelement chunk " + std::to_string(chunks) + "\n";
        std::vector<std::string> names{"min_x",       "min_y",       "min_z",       "max_x",
                                       "max_y",       "max_z",       "min_scale_x", "min_scale_y",
                                       "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"};
        if (chunk_colors) names.insert(names.end(), {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"});
        for (const std::string& name : names)
            if (name != drop) out += "property float " + name + "\n";
        out += "element vertex " + std::to_string(count) + "\n";
        for (const std::string name : {"position", "rotation", "scale", "color"})
            if ("packed_" + name != drop) out += "property uint packed_" + name + "\n";
        if (harmonics) out += "element sh " + std::to_string(count) + "\n";
        for (int k = 0; k < harmonics; ++k) out += "property uchar f_rest_" + std::to_string(k) + "\n";
        return out + "end_header\n" + body();
    }

    std::string body() const {
        Bytes bytes;
        for (int chunk = 0; chunk < chunks; ++chunk) {
            bytes.add_all<float>({-1, -2, -3, 1, 2, float(3 + chunk)});
            bytes.add_all<float>({-5, -6, -7, 0, 0, 0});
            if (chunk_colors) bytes.add_all<float>({-0.5f, 0, 0, 1.5f, 1, 2});
        }
        for (int i = 0; i < count; ++i)
            // Position and scale 11-10-11, w the largest of the rotation, colour and opacity.
            bytes.add_all<uint32_t>({2047u << 21 | 0u << 11 | uint32_t(i),
                                     0u << 30 | 1023u << 20 | 0u << 10 | 600u, 0u << 21 | 1023u << 11 | 1024u,
                                     0xff804020u});
        for (int i = 0; i < count * harmonics; ++i) bytes.add(uint8_t(i % 256));
        return bytes.str();
    }
};

MeshData read_ply(const std::string& text) {
    MeshData mesh = io::read_ply(io::Source(std::string_view(text), "test.ply"));
    validate(mesh);
    return mesh;
}

TEST(PackedSplats, PlyOfSuperSplat) {
    const MeshData mesh = read_ply(PackedPly().text());
    ASSERT_EQ(mesh.V.rows(), 300);
    ASSERT_EQ(mesh.splats.degree(), 1);
    EXPECT_EQ(mesh.up, Vec3d(0, -1, 0));
    // The 257th splat is of the second chunk, which reaches to z = 4.
    for (const int i : {0, 255, 256, 299}) {
        EXPECT_NEAR(mesh.V(i, 0), 1, 1e-6);
        EXPECT_NEAR(mesh.V(i, 1), -2, 1e-6);
        EXPECT_NEAR(mesh.V(i, 2), -3 + (i < 256 ? 6 : 7) * i / 2047.0, 1e-6);
        EXPECT_NEAR(mesh.splats.scales(i, 0), std::exp(-5.0), 1e-6);
        EXPECT_NEAR(mesh.splats.scales(i, 1), 1, 1e-6);
        EXPECT_NEAR(mesh.splats.scales(i, 2), std::exp(-7 * (1 - 1024 / 2047.0)), 1e-6);
        const double s = std::sqrt(2.0), x = 0.5 * s, y = -0.5 * s, z = (600 / 1023.0 - 0.5) * s;
        EXPECT_NEAR(mesh.splats.rotations(i, 1), x, 1e-6);
        EXPECT_NEAR(mesh.splats.rotations(i, 2), y, 1e-6);
        EXPECT_NEAR(mesh.splats.rotations(i, 3), z, 1e-6);
        EXPECT_NEAR(mesh.splats.rotations(i, 0), std::sqrt(std::max(0.0, 1 - x * x - y * y - z * z)), 1e-3);
        EXPECT_NEAR(0.5 + constant * double(mesh.splats.sh(i, 0)), 1.5, 1e-5);
        EXPECT_NEAR(0.5 + constant * double(mesh.splats.sh(i, 1)), 128 / 255.0, 1e-5);
        EXPECT_NEAR(0.5 + constant * double(mesh.splats.sh(i, 2)), 2 * 64 / 255.0, 1e-5);
        EXPECT_NEAR(mesh.splats.opacities(i), 32 / 255.0, 1e-6);
        // Channel by channel in the file: the second of green is the fifth.
        EXPECT_NEAR(mesh.splats.sh(i, 7), (i * 9 + 4) % 256 * 8 / 255.0 - 4, 1e-5);
    }
}

TEST(PackedSplats, PlyWithoutColorsOfChunksHasThemFrom0To1) {
    PackedPly ply;
    ply.chunk_colors = false;
    ply.harmonics = 0;
    const MeshData mesh = read_ply(ply.text());
    EXPECT_EQ(mesh.splats.degree(), 0);
    EXPECT_NEAR(0.5 + constant * double(mesh.splats.sh(0, 2)), 64 / 255.0, 1e-5);
}

TEST(PackedSplats, DamagedPlySaysWhy) {
    const auto said = [](const PackedPly& ply, size_t cut = 0) {
        const std::string text = ply.text();
        return refusal<Error>([&] { read_ply(text.substr(0, text.size() - cut)); });
    };
    EXPECT_EQ(said({}), "taken");
    EXPECT_TRUE(has(said({}, 1), "truncated"));
    EXPECT_TRUE(has(said({.chunks = 1, .drop = {}}), "2 chunks"));
    EXPECT_TRUE(has(said({.drop = "packed_scale"}), "'packed_scale'"));
    EXPECT_TRUE(has(said({.drop = "max_y"}), "'max_y'"));
    EXPECT_TRUE(has(said({.harmonics = 8, .drop = {}}), "found 8"));
    std::string text = PackedPly().text();
    const float nan = std::nanf("");
    std::memcpy(text.data() + text.find("end_header\n") + 11, &nan, sizeof nan);
    EXPECT_TRUE(has(refusal<Error>([&] { read_ply(text); }), "splat 0 of 300"));
    text = PackedPly().text();
    text.replace(text.find("little"), 6, "big");
    EXPECT_TRUE(has(refusal<Error>([&] { read_ply(text); }), "little-endian"));
}

}  // namespace
}  // namespace easypbr::packed_splats_test
