#include <cmath>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/io/archive/lzf.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "io/bytes.h"
#include "test_data.h"

namespace easypbr::pcd_test {

namespace {

MeshData read(const std::string& text) {
    MeshData mesh = io::read_pcd(io::Source(std::string_view(text), "test.pcd"));
    validate(mesh);
    return mesh;
}

std::string header(const std::string& fields, const std::string& size, const std::string& type,
                   const std::string& count, int points, const std::string& data) {
    return fmt::format(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n"
        "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA {}\n",
        fields, size, type, count, points, points, data);
}

/// Every kind of content: padding, normals, packed colour, intensity, label, other fields, one of them of
/// two values.
constexpr const char* fields = "x y z _ normal_x normal_y normal_z rgb intensity label curvature ring pair";
constexpr const char* sizes = "4 4 4 1 4 4 4 4 4 4 8 2 4";
constexpr const char* types = "F F F U F F F F F U F U F";
constexpr const char* counts = "1 1 1 4 1 1 1 1 1 1 1 1 2";

struct Point {
    float x, y, z;
    uint32_t rgb;
    float intensity;
    uint32_t label;
    double curvature;
    uint16_t ring;
};
const std::vector<Point> points{{1, 2, 3, 0x00ff8040, 0.5f, 7, 0.25, 63},
                                {4, 5, 6, 0x00010203, 1.5f, 8, -0.75, 64},
                                {7, 8, 9, 0x00ffffff, 2.5f, 9, 1e-3, 65535}};

std::string by_point() {
    Bytes bytes;
    for (const Point& p : points) {
        bytes.add_all({p.x, p.y, p.z}).add(0xdeadbeefu).add_all({0.0f, 0.0f, 2.0f}).add(p.rgb);
        bytes.add(p.intensity).add(p.label).add(p.curvature).add(p.ring).add_all({p.x, -p.x});
    }
    return bytes.str();
}

std::string by_field() {
    Bytes bytes;
    for (const Point& p : points) bytes.add(p.x);
    for (const Point& p : points) bytes.add(p.y);
    for (const Point& p : points) bytes.add(p.z);
    for (size_t i = 0; i < points.size(); ++i) bytes.add(0xdeadbeefu);
    for (const float n : {0.0f, 0.0f, 2.0f})
        for (size_t i = 0; i < points.size(); ++i) bytes.add(n);
    for (const Point& p : points) bytes.add(p.rgb);
    for (const Point& p : points) bytes.add(p.intensity);
    for (const Point& p : points) bytes.add(p.label);
    for (const Point& p : points) bytes.add(p.curvature);
    for (const Point& p : points) bytes.add(p.ring);
    for (const Point& p : points) bytes.add_all({p.x, -p.x});
    return bytes.str();
}

/// LZF of literals only, which any data can be written as.
std::string as_literals(const std::string& data) {
    std::string out;
    for (size_t i = 0; i < data.size(); i += 32) {
        const size_t length = std::min<size_t>(32, data.size() - i);
        out += char(length - 1) + data.substr(i, length);
    }
    return out;
}

/// LZF as others write it: repetitions of up to 264 bytes up to 8 KB back, found by a table of what was last
/// seen.
std::string as_matches(const std::string& data) {
    std::string out, literals;
    std::vector<size_t> seen(1 << 14, data.size());
    const auto flush = [&] {
        out += as_literals(literals);
        literals.clear();
    };
    for (size_t i = 0; i < data.size();) {
        size_t length = 0, distance = 0;
        if (i + 3 < data.size()) {
            const size_t slot =
                (uint8_t(data[i]) * 7919u + uint8_t(data[i + 1]) * 257u + uint8_t(data[i + 2])) % seen.size();
            const size_t before = std::exchange(seen[slot], i);
            distance = i - before;
            if (before < i && distance <= 8192)
                while (length < 264 && i + length < data.size() && data[before + length] == data[i + length])
                    ++length;
        }
        if (length < 3) {
            literals += data[i++];
            continue;
        }
        flush();
        const size_t code = std::min<size_t>(length - 2, 7);
        out += char(code << 5 | (distance - 1) >> 8);
        if (code == 7) out += char(length - 9);
        out += char((distance - 1) & 255);
        i += length;
    }
    flush();
    return out;
}

std::string compressed(const std::string& data, const std::string& lzf) {
    return Bytes().add(uint32_t(lzf.size())).add(uint32_t(data.size())).text(lzf).str();
}

std::string ascii() {
    std::string text;
    for (const Point& p : points)
        text += fmt::format("{} {} {} 1 2 3 4 0 0 2 {} {} {} {} {} {} {}\n", p.x, p.y, p.z, p.rgb,
                            p.intensity, p.label, p.curvature, p.ring, p.x, -p.x);
    return text;
}

void expect_points(const MeshData& mesh, const std::string& what) {
    ASSERT_EQ(mesh.V.rows(), 3) << what;
    ASSERT_EQ(mesh.C.cols(), 3) << what;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const Point& p = points[size_t(i)];
        EXPECT_EQ(Vec3(mesh.V.row(i)), Vec3(p.x, p.y, p.z)) << what;
        EXPECT_EQ(Vec3(mesh.N.row(i)), Vec3(0, 0, 1)) << what << ": normals are made unit";
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(std::lround(mesh.C(i, k) * 255), long(p.rgb >> (16 - 8 * k) & 255)) << what;
        EXPECT_EQ(mesh.I[i], p.intensity) << what;
        EXPECT_EQ(mesh.L[i], int32_t(p.label)) << what;
        EXPECT_EQ(scalar_named(mesh, "curvature").values[i], float(p.curvature)) << what;
        EXPECT_EQ(scalar_named(mesh, "ring").values[i], p.ring) << what;
        EXPECT_EQ(scalar_named(mesh, "pair_1").values[i], -p.x) << what;
    }
    EXPECT_EQ(mesh.scalars.size(), 4u) << what << ": padding is no content";
}

std::string simple(const std::string& size, const std::string& type, int count, const std::string& body) {
    return header("x y z", fmt::format("{0} {0} {0}", size), fmt::format("{0} {0} {0}", type), "1 1 1", count,
                  "binary") +
           body;
}

}  // namespace

TEST(Pcd, ReadsTheSameFromAllThreeForms) {
    expect_points(read(header(fields, sizes, types, counts, 3, "ascii") + ascii()), "ascii");
    expect_points(read(header(fields, sizes, types, counts, 3, "binary") + by_point()), "binary");
    const std::string columns = by_field();
    expect_points(read(header(fields, sizes, types, counts, 3, "binary_compressed") +
                       compressed(columns, as_literals(columns))),
                  "binary_compressed");
}

TEST(Pcd, ReadsCompressedDataInPieces) {
    // 11 MB, decompressed 2 MB at a time: rows of 3 bytes and of 12 do not end where the pieces do.
    const int count = 400'000;
    Bytes x, y, z, tag, pair;
    for (int i = 0; i < count; ++i) {
        x.add(float(i % 977));
        y.add(float(i) * 0.25f);
        z.add(float((int64_t(i) * 7919) % 1000));
        tag.add(uint8_t(i)).add(uint8_t(i >> 8)).add(uint8_t(i % 10 == 0));
        pair.add(float(i)).add(float(-i)).add(float(i / 3));
    }
    const std::string head =
        header("x y z tag pair", "4 4 4 1 4", "F F F U F", "1 1 1 3 3", count, "binary_compressed");
    const std::string data = x.str() + y.str() + z.str() + tag.str() + pair.str(), packed = as_matches(data);
    ASSERT_LT(packed.size(), data.size() * 9 / 10) << "there are matches";
    const MeshData mesh = read(head + compressed(data, packed));
    ASSERT_EQ(mesh.V.rows(), count);
    const Array1f tag_1 = scalar_named(mesh, "tag_1").values, tag_2 = scalar_named(mesh, "tag_2").values;
    const Array1f pair_1 = scalar_named(mesh, "pair_1").values;
    for (int i = 0; i < count; ++i) {
        ASSERT_EQ(Vec3(mesh.V.row(i)),
                  Vec3(float(i % 977), float(i) * 0.25f, float((int64_t(i) * 7919) % 1000)));
        ASSERT_EQ(tag_1[i], i >> 8 & 255);
        ASSERT_EQ(tag_2[i], i % 10 == 0);
        ASSERT_EQ(pair_1[i], -i);
    }
}

TEST(Pcd, RecentresCompressedFloats) {
    std::string data;
    for (const float first : {691'000.0f, 5'335'000.0f, 520.0f}) {
        Bytes column;
        for (int i = 0; i < 100; ++i) column.add(first + 0.5f * float(i));
        data += column.str();
    }
    const MeshData mesh = read(header("x y z", "4 4 4", "F F F", "1 1 1", 100, "binary_compressed") +
                               compressed(data, as_matches(data)));
    EXPECT_LT(mesh.V.cwiseAbs().maxCoeff(), 64);
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(mesh.offset + mesh.V.row(i).transpose().cast<double>(),
                  Vec3d(691'000 + 0.5 * i, 5'335'000 + 0.5 * i, 520 + 0.5 * i));
}

TEST(Pcd, ReadsPositionsOfEveryType) {
    const auto expect = [](const std::string& text, const std::string& what) {
        EXPECT_EQ(Vec3(read(text).V.row(0)), Vec3(1, 2, 3)) << what;
    };
    expect(simple("1", "I", 1, Bytes().add_all<int8_t>({1, 2, 3}).str()), "I1");
    expect(simple("2", "U", 1, Bytes().add_all<uint16_t>({1, 2, 3}).str()), "U2");
    expect(simple("4", "I", 1, Bytes().add_all<int32_t>({1, 2, 3}).str()), "I4");
    expect(simple("8", "I", 1, Bytes().add_all<int64_t>({1, 2, 3}).str()), "I8");
    expect(simple("8", "U", 1, Bytes().add_all<uint64_t>({1, 2, 3}).str()), "U8");
    expect(simple("2", "F", 1, Bytes().add_all<uint16_t>({0x3c00, 0x4000, 0x4200}).str()), "F2");
    expect(simple("8", "F", 1, Bytes().add_all<double>({1, 2, 3}).str()), "F8");
}

TEST(Pcd, ReadsHalfFloats) {
    // Subnormal, largest, negative zero: IEEE 754 binary16.
    const MeshData mesh =
        read(simple("2", "F", 1, Bytes().add_all<uint16_t>({0x0001, 0x7bff, 0x8000}).str()));
    EXPECT_EQ(mesh.V(0, 0), std::ldexp(1.0f, -24));
    EXPECT_EQ(mesh.offset.y() + mesh.V(0, 1), 65504);
    EXPECT_TRUE(std::signbit(mesh.V(0, 2)));
}

TEST(Pcd, KeepsMillimetresOfDoubles) {
    Bytes body;
    for (int i = 0; i < 100; ++i) body.add_all<double>({691'000.125 + i, 5'335'000.25 + 0.001 * i, 520.5});
    const std::string head = header("x y z", "8 8 8", "F F F", "1 1 1", 100, "binary");
    const MeshData mesh = read(head + body.str());
    for (int i = 0; i < 100; ++i) {
        const Vec3d p = mesh.offset + mesh.V.row(i).transpose().cast<double>();
        // Half the spacing of float32 numbers up to 128.
        EXPECT_LE((p - Vec3d(691'000.125 + i, 5'335'000.25 + 0.001 * i, 520.5)).cwiseAbs().maxCoeff(),
                  std::exp2(-18.0));
    }
}

TEST(Pcd, ReadsPackedColorsWrittenAsFloatsAndWithAlpha) {
    const float packed = std::bit_cast<float>(0x00ff8040u);
    const std::string head =
        "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n";
    const MeshData mesh = read(head + fmt::format("1 2 3 {}\n", packed));
    EXPECT_EQ(Vec3(mesh.C.row(0)), Vec3(1, float(128 / 255.0), float(64 / 255.0)));

    const MeshData rgba = read(header("rgba x y z", "4 4 4 4", "U F F F", "1 1 1 1", 1, "ascii") +
                               "2164195328 1 2 3\n");  // 0x80ff0000
    ASSERT_EQ(rgba.C.cols(), 4);
    EXPECT_EQ(Vec4(rgba.C.row(0)), Vec4(1, 0, 0, float(128 / 255.0)));
}

TEST(Pcd, LeavesOutPointsWithoutPositionAndCountsThem) {
    const float nan = NAN;
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const MeshData mesh = read(header("x y z label", "4 4 4 4", "F F F U", "1 1 1 1", 4, "binary") +
                               Bytes()
                                   .add_all({1.0f, 2.0f, 3.0f})
                                   .add(1u)
                                   .add_all({nan, nan, nan})
                                   .add(2u)
                                   .add_all({4.0f, INFINITY, 6.0f})
                                   .add(3u)
                                   .add_all({7.0f, 8.0f, 9.0f})
                                   .add(4u)
                                   .str());
    set_log_sink({});
    ASSERT_EQ(mesh.V.rows(), 2);
    EXPECT_EQ(mesh.L[1], 4);
    EXPECT_EQ(mesh.source_vertex[1], 3);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("test.pcd: 2 of 4 points"), std::string::npos) << warnings[0];
}

TEST(Pcd, HoldsForOnePointAndForEqualPoints) {
    EXPECT_EQ(read(simple("4", "F", 1, Bytes().add_all({1.0f, 2.0f, 3.0f}).str())).V.rows(), 1);
    Bytes same;
    for (int i = 0; i < 1000; ++i) same.add_all({1.0f, 2.0f, 3.0f});
    const MeshData mesh = read(simple("4", "F", 1000, same.str()));
    EXPECT_EQ(Vec3(mesh.V.colwise().maxCoeff()), Vec3(1, 2, 3));
    EXPECT_EQ(Vec3(mesh.V.colwise().minCoeff()), Vec3(1, 2, 3));
}

TEST(Lzf, RepeatsWhatStandsBefore) {
    const auto decompressed = [](const std::string& in, size_t size) {
        std::string out(size, '?');
        return io::lzf_decompress(in, {out.data(), out.size()}) ? out : std::string("damaged");
    };
    EXPECT_EQ(decompressed(std::string("\x02") + "abc", 3), "abc");
    // 3 literals, then 7 + 2 bytes from 3 before: a match that overlaps what it makes.
    EXPECT_EQ(decompressed(std::string("\x02") + "abc" + "\xe0" + std::string("\0\x02", 2), 12),
              "abcabcabcabc");
    // A long match, 1 before: 9 + 255 bytes.
    EXPECT_EQ(decompressed(std::string("\0a\xe0\xff\0", 5), 265), std::string(265, 'a'));
    // Long runs from far before, over the copies of fixed length.
    std::string in, out;
    for (int i = 0; i < 100; ++i) {
        std::string run(32, char('a' + i % 26));
        run.back() = char('A' + i % 26);
        in += '\x1f';
        in += run;
        out += run;
    }
    in += std::string("\xef", 1) + std::string("\x10", 1) +
          std::string("\x7f", 1);  // 25 bytes, 0xf7f + 1 before
    ASSERT_LT(out.size(), 0xf80u);
    EXPECT_EQ(decompressed(in, out.size() + 25), "damaged") << "before the first byte";
    in.replace(in.size() - 3, 3, std::string("\xe7\x10\x7f", 3));  // 0x780 before
    EXPECT_EQ(decompressed(in, out.size() + 25), out + out.substr(out.size() - 0x780, 25));
}

TEST(Lzf, RefusesDamagedData) {
    std::string out(8, '?');
    const std::span<char> room(out.data(), out.size());
    EXPECT_FALSE(
        io::lzf_decompress("\x09"
                           "abcdefghij",
                           room))
        << "more than there is room for";
    EXPECT_FALSE(
        io::lzf_decompress("\x07"
                           "abc",
                           room))
        << "ends within literals";
    EXPECT_FALSE(io::lzf_decompress(std::string("\0a\x20", 3), room)) << "ends within a match";
    EXPECT_FALSE(io::lzf_decompress(std::string("\0a\xe0", 3), room)) << "ends within a match's length";
    EXPECT_FALSE(io::lzf_decompress(std::string("\0a\x20\x01", 4), room)) << "before the first byte";
    EXPECT_FALSE(io::lzf_decompress(std::string("\0a\xe0\xff\0", 5), room)) << "a match beyond the room";
    EXPECT_FALSE(io::lzf_decompress(std::string("\0a", 2), room)) << "too little";
}

TEST(Pcd, ReadsRealFiles) {
    REQUIRE_TEST_DATA();
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    const auto room = Mesh(test_data("clouds/room_rgb.pcd")).snapshot();
    set_log_sink({});
    EXPECT_EQ(warnings.size(), 1u) << "it has points without position";
    EXPECT_LT(room->V.rows(), 307'200);
    EXPECT_GT(room->V.rows(), 200'000);
    EXPECT_EQ(room->source_vertex.rows(), room->V.rows());
    EXPECT_EQ(room->C.rows(), room->V.rows());
    // An office seen by a depth camera: everything within 10 m, and not grey.
    EXPECT_LT(room->V.cwiseAbs().maxCoeff(), 10);
    EXPECT_GT((room->C.col(0) - room->C.col(2)).cwiseAbs().mean(), 0.02f);

    const auto terrain = Mesh(test_data("clouds/terrain.pcd")).snapshot();
    EXPECT_EQ(terrain->V.rows(), 522'674);
    EXPECT_GT(terrain->offset.norm(), 1e5) << "it has UTM coordinates";
}

}  // namespace easypbr::pcd_test
