// What files ask for is refused beyond a limit, before it is allocated; equal meshes are read once.
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/file_scene.h"
#include "easypbr/io/mesh/mesh_io.h"

namespace easypbr::io::memory_limit_test {
namespace {

std::string message_of(const auto& job) {
    try {
        job();
        return "";
    } catch (const FormatError& error) {
        return error.what();
    }
}

FileBytes bytes_of(const std::string& text) {
    const fs::path path = fs::temp_directory_path() / fmt::format("easypbr_memory_{}", getpid());
    std::ofstream(path, std::ios::binary) << text;
    FileBytes bytes(path);
    fs::remove(path);  // what is open stays readable
    return bytes;
}

TEST(MemoryScope, CountsWhatIsReadTogether) {
    const MemoryScope scope("a.glb", 100);
    charge_memory(60, "one");
    charge_memory(40, "another");
    EXPECT_EQ(message_of([] { charge_memory(2'000'000, "a third"); }),
              "a.glb: a third would take 2 MB, and of the 100 bytes that reading may take 0 bytes are left "
              "(limits.memory)");
    const MemoryScope small("a.obj", 400'000);
    EXPECT_EQ(message_of([] { charge_memory(479'600, "a fourth"); }),
              "a.obj: a fourth would take 480 kB, and of the 400 kB that reading may take 400 kB are left "
              "(limits.memory)");
}

TEST(MemoryScope, InnerOnesCountInTheOuter) {
    const MemoryScope scope("a.gltf", 100);
    {
        const MemoryScope image("b.png");
        charge_memory(80, "the pixels");
    }
    EXPECT_NE(message_of([] { charge_memory(30, "more"); }), "");
    const MemoryScope own("c.png", 1000);
    EXPECT_EQ(message_of([] { charge_memory(900, "the pixels"); }), "");
}

TEST(MemoryScope, IsOfItsThread) {
    const MemoryScope scope("a.glb", 10);
    std::string message = "not run";
    std::thread([&] { message = message_of([] { charge_memory(100, "other"); }); }).join();
    EXPECT_EQ(message, "");
}

TEST(MemoryScope, TheAutomaticLimitIsOfThisMachine) {
    EXPECT_GT(automatic_memory_limit(), uint64_t(1) << 20);
    EXPECT_LT(automatic_memory_limit(), uint64_t(1) << 50);
    EXPECT_NE(message_of([] { charge_memory(uint64_t(1) << 50, "a petabyte"); }), "");
}

/// Meshes on an accessor without data, 12 bytes a row: nothing in the file bears their size out.
std::string gltf_of_zeros(int meshes, int rows, bool equal) {
    std::string nodes, list, list_of_nodes;
    for (int i = 0; i < meshes; ++i) {
        const std::string comma = i ? "," : "";
        nodes += fmt::format("{}{{\"mesh\":{}}}", comma, i);
        list += fmt::format(
            "{}{{\"name\":\"m{}\",\"extras\":{},\"primitives\":[{{\"mode\":0,\"attributes\":"
            "{{\"POSITION\":0}}}}]}}",
            comma, i, equal ? 0 : i);
        list_of_nodes += comma + std::to_string(i);
    }
    return fmt::format(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scenes\":[{{\"nodes\":[{}]}}],\"nodes\":[{}],\"meshes\":[{}],"
        "\"accessors\":[{{\"count\":{},\"componentType\":5126,\"type\":\"VEC3\"}}]}}",
        list_of_nodes, nodes, list, rows);
}

Mesh read_gltf(const std::string& text, double memory_gb) {
    return load_scene(bytes_of(text), "zeros.gltf", {.memory_gb = memory_gb, .format = "gltf"}).mesh;
}

TEST(MemoryLimit, MeshesOnAnAccessorWithoutData) {
    // 20 times 12 MB, of which 100 MB are allowed.
    const std::string text = gltf_of_zeros(20, 1'000'000, false);
    EXPECT_LT(text.size(), 4000u);
    EXPECT_EQ(
        message_of([&] { read_gltf(text, 0.1); }),
        "zeros.gltf: accessors[0] would take 12 MB, and of the 100 MB that reading may take 4 MB are left "
        "(limits.memory)");
    EXPECT_EQ(message_of([&] { read_gltf(text, 0.25); }), "");
}

TEST(MemoryLimit, EqualMeshesShareTheirArrays) {
    const Mesh mesh = read_gltf(gltf_of_zeros(20, 1'000'000, true), 0.013);
    const std::vector<Mesh> children = mesh.children();
    ASSERT_EQ(children.size(), 20u);
    EXPECT_EQ(children[0].V().data(), children[19].V().data());
    EXPECT_EQ(children[0].name(), "m0");
    EXPECT_EQ(children[19].name(), "m19");
}

std::string repeated(const std::string& line, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += line;
    return text;
}

/// The message of the first charge that 2 MB are too little for; and none where `enough_mb` are allowed.
void expect_charge(const std::string& format, const std::string& file, const std::string& charge,
                   double enough_mb) {
    SCOPED_TRACE(format);
    const std::string name = "a." + format;
    const auto read = [&](double mb) {
        return message_of(
            [&] { load_scene(bytes_of(file), name, {.memory_gb = mb / 1000, .format = format}); });
    };
    EXPECT_EQ(read(2),
              name + ": " + charge + ", and of the 2 MB that reading may take 2 MB are left (limits.memory)");
    EXPECT_EQ(read(enough_mb), "");
}

/// In float32 a position takes 12 bytes, in int32 a triangle as many.
TEST(MemoryLimit, LinesOfText) {
    const std::string points = repeated("1 2 3\n", 250'000);
    expect_charge("xyz", points, "its points would take 3 MB", 3.01);
    expect_charge("off", "OFF\n250000 1 0\n" + points + "3 0 1 2\n", "its vertices would take 3 MB", 3.01);
    // A face says its number of corners too.
    expect_charge("obj", repeated("v 1 2 3\n", 150'000) + repeated("f 1 2 3\n", 75'000),
                  "its vertices and faces would take 3 MB", 3.01);
    // Three indices and an end for each of 200000 faces: 3.2 MB.
    expect_charge(
        "ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 200000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
            repeated("3 0 1 2\n", 200'000),
        "its lists would take 3 MB", 3.3);
}

/// A facet has nine numbers and becomes three indices: 48 bytes. Its corners are vertices of 12 bytes each.
TEST(MemoryLimit, FacetsOfStl) {
    constexpr uint32_t count = 50'000;
    std::string binary(80, ' '), text = "solid a\n";
    binary.append(reinterpret_cast<const char*>(&count), sizeof count);
    for (uint32_t i = 0; i < count; ++i) {
        const float x = float(i), facet[12] = {0, 0, 1, x, 0, 0, x, 1, 0, x, 0, 1};
        binary.append(reinterpret_cast<const char*>(facet), sizeof facet).append(2, '\0');
        text += fmt::format(
            "facet normal 0 0 1\nouter loop\nvertex {0} 0 0\nvertex {0} 1 0\nvertex {0} 0 1\n"
            "endloop\nendfacet\n",
            i);
    }
    // With 1.8 MB of vertices that no two facets share: 4.2 MB.
    for (const std::string& file : {binary, text + "endsolid a\n"})
        expect_charge("stl", file, "its facets would take 2 MB", 4.21);
}

/// A ZIP archive of deflated entries of zeros.
std::string zip_of_zeros(const std::vector<std::pair<std::string, size_t>>& entries) {
    std::string archive, directory;
    const auto put = [](std::string& to, auto value) {
        to.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (const auto& [name, size] : entries) {
        const std::string zeros(size, '\0');
        std::string packed(compressBound(size), '\0');
        z_stream stream{};
        deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zeros.data()));
        stream.avail_in = uInt(size);
        stream.next_out = reinterpret_cast<Bytef*>(packed.data());
        stream.avail_out = uInt(packed.size());
        deflate(&stream, Z_FINISH);
        packed.resize(stream.total_out);
        deflateEnd(&stream);
        const auto crc = uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(zeros.data()), size));
        const auto fields = [&](std::string& to) {
            put(to, uint16_t(20));
            put(to, uint16_t(0));
            put(to, uint16_t(8));
            put(to, uint32_t(0));
            put(to, crc);
            put(to, uint32_t(packed.size()));
            put(to, uint32_t(size));
            put(to, uint16_t(name.size()));
            put(to, uint16_t(0));
        };
        directory += std::string("PK\x01\x02", 4) + std::string(2, '\0');
        fields(directory);
        directory.append(10, '\0');
        put(directory, uint32_t(archive.size()));
        directory += name;
        archive += std::string("PK\x03\x04", 4);
        fields(archive);
        archive += name + packed;
    }
    const auto start = uint32_t(archive.size());
    archive += directory + std::string("PK\x05\x06", 4) + std::string(4, '\0');
    put(archive, uint16_t(entries.size()));
    put(archive, uint16_t(entries.size()));
    put(archive, uint32_t(directory.size()));
    put(archive, start);
    put(archive, uint16_t(0));
    return archive;
}

TEST(MemoryLimit, EntriesOfAnArchive) {
    const auto read = [](const std::string& archive) {
        load_scene(bytes_of(archive), "a.npz", {.memory_gb = 0.02, .format = "npz"});
    };
    const std::string used = zip_of_zeros({{"V.npy", 30'000'000}});
    EXPECT_EQ(message_of([&] { read(used); }),
              "a.npz: 'V.npy' would take 30 MB, and of the 20 MB that reading may take 20 MB are left "
              "(limits.memory)");
    // What is not read is not unpacked.
    const std::string unused = zip_of_zeros({{"V.npy", 1000}, {"readme.txt", 30'000'000}});
    EXPECT_EQ(message_of([&] { read(unused); }).find("readme"), std::string::npos);
    EXPECT_EQ(message_of([&] { read(unused); }).find("limits.memory"), std::string::npos);
}

TEST(MemoryLimit, PixelsOfAnImage) {
    const MemoryScope scope("scene.glb", 1'000'000);
    const std::vector<std::byte> png = encode_png(Image(1000, 500, 4, PixelType::u8));
    EXPECT_LT(png.size(), 100'000u);
    EXPECT_EQ(
        message_of([&] { decode_image(png, "a.png"); }),
        "scene.glb: the pixels of a.png would take 2 MB, and of the 1 MB that reading may take 1 MB are left "
        "(limits.memory)");
}

TEST(MemoryLimit, RefusesWhatIsNone) {
    EXPECT_THROW(load_scene("a.ply", {.memory_gb = -1}), ArgumentError);
    EXPECT_THROW(load_scene("a.ply", {.memory_gb = std::nan("")}), ArgumentError);
}

}  // namespace
}  // namespace easypbr::io::memory_limit_test
