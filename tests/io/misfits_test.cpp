// Labels that are no integers of 32 bits: every reader makes them -1 and counts them.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/npy_builder.h"
#include "io/ply_builder.h"

namespace easypbr::misfits_test {

namespace {

using Labels = std::vector<int32_t>;

struct Read {
    Labels labels;
    std::string warnings;
};

Read read(MeshData (*reader)(const io::Source&), const std::string& bytes) {
    Read result;
    set_log_sink([&](LogLevel, std::string_view message) { result.warnings += std::string(message) + "\n"; });
    const MeshData mesh = reader(io::Source(std::string_view(bytes), "a.file"));
    set_log_sink({});
    result.labels.assign(mesh.L.data(), mesh.L.data() + mesh.L.size());
    return result;
}

std::string warning(int count, const std::string& name = "label") {
    return fmt::format("a.file: {} values of '{}' are no integers of 32 bits and become -1\n", count, name);
}

/// A structured array of points with labels of a type.
template <class T>
std::string points_npy(const char* type, const std::vector<T>& labels) {
    Bytes bytes;
    for (const T label : labels) bytes.add_all({0.0f, 0.0f, float(bytes.size())}).add(label);
    const std::string fields =
        fmt::format("[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('label', '{}')]", type);
    return npy(fields, fmt::format("({},)", labels.size()), bytes.str());
}

template <class T>
Read read_npy(const char* type, const std::vector<T>& labels) {
    return read(io::read_npy, points_npy(type, labels));
}

constexpr int32_t most = INT32_MAX, least = INT32_MIN;

std::string pcd_header(const std::string& data) {
    return "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\n"
           "POINTS 3\nDATA " +
           data + "\n";
}

}  // namespace

TEST(Misfits, OfEveryTypeBecomeMinusOne) {
    Read found = read_npy<uint32_t>("<u4", {7, 2147483647u, 2147483648u, 4294967295u});
    EXPECT_EQ(found.labels, (Labels{7, most, -1, -1}));
    EXPECT_EQ(found.warnings, warning(2));
    found = read_npy<int64_t>("<i8", {least, most, int64_t(most) + 1, int64_t(least) - 1, INT64_MAX});
    EXPECT_EQ(found.labels, (Labels{least, most, -1, -1, -1}));
    EXPECT_EQ(found.warnings, warning(3));
    found = read_npy<uint64_t>("<u8", {1, uint64_t(1) << 32, UINT64_MAX});
    EXPECT_EQ(found.labels, (Labels{1, -1, -1}));
    EXPECT_EQ(found.warnings, warning(2));
    // The float below 2^31 is 2^31 - 128.
    found = read_npy<float>("<f4", {-3, 1.5f, NAN, INFINITY, 2147483648.0f, 2147483520.0f, -2147483648.0f});
    EXPECT_EQ(found.labels, (Labels{-3, -1, -1, -1, -1, 2147483520, least}));
    EXPECT_EQ(found.warnings, warning(4));
    found = read_npy<double>("<f8", {2147483647.0, 2147483647.5, -0.5, NAN});
    EXPECT_EQ(found.labels, (Labels{most, -1, -1, -1}));
    EXPECT_EQ(found.warnings, warning(3));
    // 1.5, 2 and NaN in half precision.
    found = read_npy<uint16_t>("<f2", {0x3e00, 0x4000, 0x7e00});
    EXPECT_EQ(found.labels, (Labels{-1, 2, -1}));
    EXPECT_EQ(found.warnings, warning(2));
    found = read_npy<uint16_t>("<u2", {0, 65535});
    EXPECT_EQ(found.labels, (Labels{0, 65535}));
    EXPECT_EQ(found.warnings, "");
    found = read_npy<int32_t>("<i4", {least, -1, most});
    EXPECT_EQ(found.labels, (Labels{least, -1, most}));
    EXPECT_EQ(found.warnings, "");
}

TEST(Misfits, AreTheSameInEveryFormOfPly) {
    for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (const bool varied : {false, true}) {
            // Faces of different lengths are read row by row, after a try as if all were alike.
            PlyBuilder ply(format);
            ply.header("element vertex 4\nproperty float x\nproperty float y\nproperty float z");
            ply.header("element face 3\nproperty list uchar int vertex_indices\nproperty double label");
            ply.end_header();
            for (int i = 0; i < 4; ++i) ply.values("float", {double(i & 1), double(i >> 1), 0}).end_row();
            for (const double label : {1.5, 4294967295.0, 9.0}) {
                const bool is_quad = varied && label == 9;
                ply.value("uchar", is_quad ? 4 : 3).values("int", {0, 1, 3});
                if (is_quad) ply.value("int", 2);
                ply.value("double", label).end_row();
            }
            const Read found = read(io::read_ply, ply.text());
            EXPECT_EQ(found.labels, varied ? (Labels{-1, -1, 9, 9}) : (Labels{-1, -1, 9})) << format;
            EXPECT_EQ(found.warnings, warning(2)) << format << (varied ? ", varied" : "");
        }
}

TEST(Misfits, OfManyPointsAreCountedOnce) {
    // More than one thread's piece of 32768 rows.
    constexpr int count = 100'000;
    PlyBuilder ply("binary_little_endian");
    ply.header("element vertex 100000\nproperty float x\nproperty float y\nproperty float z");
    ply.header("property uint label").end_header();
    for (int i = 0; i < count; ++i)
        ply.values("float", {double(i), 0, 1}).value("uint", i % 10 == 0 ? 3e9 : i);
    const Read found = read(io::read_ply, ply.text());
    EXPECT_EQ(std::ranges::count(found.labels, -1), count / 10);
    EXPECT_EQ(found.warnings, warning(count / 10));
}

TEST(Misfits, AreTheSameInEveryFormOfPcd) {
    const std::string text = "0 0 0 7\n0 0 1 2147483648\n0 0 2 4294967295\n";
    Bytes by_point;
    for (const uint32_t label : {7u, 2147483648u, 4294967295u})
        by_point.add_all({0.0f, 0.0f, float(by_point.size())}).add(label);
    Bytes by_field;
    by_field.add_all({0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 2.0f});
    by_field.add_all({7u, 2147483648u, 4294967295u});
    // LZF of literals, 32 bytes and the rest, each behind its length less one.
    const std::string& data = by_field.str();
    const std::string literals = char(31) + data.substr(0, 32) + char(15) + data.substr(32);
    const std::string compressed =
        Bytes().add(uint32_t(literals.size())).add(uint32_t(data.size())).text(literals).str();
    for (const std::string& file : {pcd_header("ascii") + text, pcd_header("binary") + by_point.str(),
                                    pcd_header("binary_compressed") + compressed}) {
        const Read found = read(io::read_pcd, file);
        EXPECT_EQ(found.labels, (Labels{7, -1, -1}));
        EXPECT_EQ(found.warnings, warning(2));
    }
}

TEST(Misfits, AreCountedInArchives) {
    const std::string points =
        npy("'<f4'", "(4, 3)", Bytes().add_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}).str());
    const std::string faces = npy("'<i4'", "(3, 3)", Bytes().add_all({0, 1, 2, 1, 3, 2, 0, 1, 3}).str());
    const std::string of_points = npy("'<f8'", "(4,)", Bytes().add_all({1.0, 1.5, -2.0, double(NAN)}).str());
    Read found = read(io::read_npz, npz({{"V.npy", points}, {"L.npy", of_points}}));
    EXPECT_EQ(found.labels, (Labels{1, -1, -2, -1}));
    EXPECT_EQ(found.warnings, warning(2));
    const std::string of_faces = npy("'<u4'", "(3,)", Bytes().add_all({5u, 3000000000u, 6u}).str());
    found = read(io::read_npz, npz({{"V.npy", points}, {"F.npy", faces}, {"labels.npy", of_faces}}));
    EXPECT_EQ(found.labels, (Labels{5, -1, 6}));
    EXPECT_EQ(found.warnings, warning(1, "labels"));
}

}  // namespace easypbr::misfits_test
