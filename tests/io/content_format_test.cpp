// Meshes that come without a file's name.
#include "easypbr/io/mesh/content_format.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <span>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/mesh/file_scene.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/gltf_builder.h"
#include "io/las_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::content_format_test {

namespace {

MeshData triangle() {
    MeshData data;
    data.V = Array3f::Dense{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.F = Array3i::Dense{{0, 1, 2}};
    return data;
}

std::string binary_stl(uint32_t facets, size_t size) {
    std::string text(size, '\0');
    text.replace(80, 4, reinterpret_cast<const char*>(&facets), 4);
    return text;
}

/// What comes out of a pipe that the bytes are written into.
FileBytes through_a_pipe(const std::string& text) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    const Descriptor reading(ends[0]);
    std::thread writer([&, writing = Descriptor(ends[1])] {
        for (size_t at = 0; at < text.size();)
            at += size_t(::write(writing.get(), text.data() + at, text.size() - at));
    });
    FileBytes bytes(reading.get(), "pipe");
    writer.join();
    return bytes;
}

std::string message_of(const std::string& text, const io::LoadOptions& options = {}) {
    try {
        io::load_scene(through_a_pipe(text), "pipe", options);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "read";
}

TEST(ContentFormat, IsTold) {
    GltfBuilder gltf;
    gltf.triangle();
    const std::vector<std::pair<std::string, std::string>> table{
        {"ply\nformat ascii 1.0\n", "ply"},
        {"ply\r\nformat ascii 1.0\r\n", "ply"},
        {gltf.glb(), "glb"},
        {"\n  { \"asset\": {} }", "gltf"},
        {"\xef\xbb\xbf{\"asset\": {}}", "gltf"},
        {LasBuilder().text(), "las"},
        {"# .PCD v0.7 - Point Cloud Data file format\n", "pcd"},
        {"# saved by something\nVERSION 0.7\n", "pcd"},
        {"OFF\n3 1 0\n", "off"},
        {"# a comment\n\nSTCNOFF 3 1 0\n", "off"},
        {"solid thing\nfacet normal 0 0 1\n", "stl"},
        {binary_stl(2, 184), "stl"},
        {"# made by hand\n\nmtllib a.mtl\nv 0 0 0\n", "obj"},
        {"v 0 0 0\nv 1 0 0\n", "obj"},
        {"o thing\n", "obj"},
        {"1 2 3\n4 5 6\n", "xyz"},
        {"1.5,2,3e4,255\n", "xyz"},
        {"//X;Y;Z\n1;2;3\n", "xyz"},
        {"x,y,z,label\n1,2,3,4\n", "xyz"},
        {"2\n1 2 3 4\n5 6 7 8\n", "pts"},
        {"", ""},
        {"hello\n", ""},
        {"1 2\n3 4\n", ""},
        {"<?xml version=\"1.0\"?>\n<COLLADA>", ""},
        {"v 0 0 0\n" + std::string(1, '\0'), ""},
        {binary_stl(2, 185), ""},
        {std::string(32, '\0'), ""},
    };
    for (const auto& [content, format] : table)
        EXPECT_EQ(io::format_of_content(content), format) << content.substr(0, 40);
}

TEST(ContentFormat, OfWhatIsWrittenIsTold) {
    const TemporaryFolder folder;
    for (const std::string extension : {"ply", "obj", "glb", "pcd", "xyz", "csv", "npy", "npz"}) {
        const fs::path path = folder / ("a." + extension);
        io::save_mesh(Mesh(triangle()), path);
        const std::string text(FileBytes(path).text());
        EXPECT_EQ(io::format_of_content(text), extension == "csv" ? "xyz" : extension);
        const Mesh mesh = io::load_scene(through_a_pipe(text), "pipe", {}).mesh;
        Eigen::Index vertices = 0;
        for_each_node(mesh, [&](const auto& data, const auto&) { vertices += data->V.rows(); });
        EXPECT_EQ(vertices, 3) << extension;
    }
}

TEST(ContentFormat, OfBytesInMemoryIsToldToo) {
    const TemporaryFolder folder;
    for (const std::string extension : {"ply", "obj", "glb", "npy", "npz"}) {
        io::save_mesh(Mesh(triangle()), folder / ("a." + extension));
        // One byte off, so that no reader may take the beginning for aligned.
        const std::string text = " " + std::string(FileBytes(folder / ("a." + extension)).text());
        const auto bytes = std::as_bytes(std::span(text)).subspan(1);
        const Mesh mesh = io::load_scene(bytes, "memory").mesh;
        Eigen::Index vertices = 0;
        for_each_node(mesh, [&](const auto& data, const auto&) { vertices += data->V.rows(); });
        EXPECT_EQ(vertices, 3) << extension;
        EXPECT_EQ(io::load_scene(bytes, "memory", {.format = extension}).mesh.name(), mesh.name());
    }
    EXPECT_THROW(io::load_scene(std::span<const std::byte>(), "memory"), FormatError);
}

TEST(ContentFormat, MayBeGiven) {
    const std::string points = "2\n1 2 3 7 255 128 0\n1 2 3 8 4 5 6\n";
    EXPECT_EQ(io::load_scene(through_a_pipe(points), "pipe", {.format = "pts"}).mesh.I()[1], 8);
    EXPECT_EQ(io::load_scene(through_a_pipe(points), "pipe", {.format = "PTS"}).mesh.I()[1], 8);
    const std::string scan(32, '\0');
    EXPECT_EQ(message_of(scan),
              "pipe: its format cannot be told from its content; name it, one of gltf, glb, "
              "asc, bin, csv, las, laz, npy, npz, obj, off, pcd, ply, pts, splat, spz, stl, txt, xyz");
    EXPECT_EQ(io::load_scene(through_a_pipe(scan), "pipe", {.format = "bin"}).mesh.V().rows(), 2);
    EXPECT_NE(message_of(points, {.format = "plyy"}).find("did you mean 'ply'"), std::string::npos);
    EXPECT_NE(message_of(points, {.format = "dae"}).find("'dae' cannot be read without a file"),
              std::string::npos);
    EXPECT_EQ(message_of(""), "pipe: there is nothing to read");
    // A file's extension may be wrong.
    const TemporaryFolder folder;
    write_file(folder / "a.dat", points);
    EXPECT_EQ(io::load_mesh(folder / "a.dat", {.format = "xyz"}).V().rows(), 2);
}

// There is no other file to find among a folder's.
TEST(ContentFormat, OfAPipeHasErrorsWithItsName) {
    EXPECT_EQ(message_of("v 1 2 3\nv 1 2\n"), "pipe:2: 'v' has 2 numbers, expected at least 3");
}

}  // namespace

}  // namespace easypbr::content_format_test
