// LoadedScene::files: the file and those that are read with it, in the words of mesh_io.h.
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "io/bytes.h"
#include "io/gltf_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::opened_parts_test {
namespace {

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// What was read, relative to the folder.
std::set<std::string> read_files(const TemporaryFolder& folder, const std::string& name) {
    std::set<std::string> names;
    for (const auto& [path, time] : io::load_scene(folder / name).files)
        names.insert(path.lexically_relative(folder.path()).string());
    return names;
}

void save_pixel(const fs::path& path) {
    io::save_image(Image(1, 1, 3, PixelType::u8), path);
}

TEST(OpenedParts, OfAFileAloneAreItself) {
    const TemporaryFolder folder;
    write_file(folder / "a.obj", triangle);
    EXPECT_EQ(read_files(folder, "a.obj"), std::set<std::string>{"a.obj"});
}

// The 16 MiB before the name are blank: whatever is parsed counts. What is named and missing may come later.
TEST(OpenedParts, OfObjAreMaterialsAndImages) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "mats");
    save_pixel(folder / "red.png");
    write_file(folder / "mats/a.mtl", "newmtl a\nmap_Kd red.png\nmap_Ke none.png\n");
    const std::string blank(size_t(16) << 20, '\n');
    write_file(folder / "a.obj", "mtllib gone.mtl\n" + blank + "mtllib mats/a.mtl\nusemtl a\n" + triangle);
    EXPECT_EQ(read_files(folder, "a.obj"), (std::set<std::string>{"a.obj", "gone.mtl", "mats/a.mtl",
                                                                  "mats/none.png", "none.png", "red.png"}));
}

// "./m.mtl" is "m.mtl", whose folder is that of the OBJ; each of several libraries may come later.
TEST(OpenedParts, OfObjAreAllLibrariesOfALine) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", "newmtl m\nmap_Kd none.png\n");
    write_file(folder / "a.obj", std::string("mtllib ./m.mtl n.mtl\nmtllib g.mtl h.mtl\n") + triangle);
    EXPECT_EQ(read_files(folder, "a.obj"),
              (std::set<std::string>{"a.obj", "g.mtl", "h.mtl", "m.mtl", "n.mtl", "none.png"}));
}

// Images are decoded on all cores.
TEST(OpenedParts, OfGltfAreBuffersAndImages) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "data");
    const std::vector<std::string> uris{"data/g.bin", "my%20mesh.bin", "g.buf"};
    for (const std::string& uri : uris) {
        const std::string file = uri == uris[1] ? "my mesh.bin" : uri;
        GltfBuilder gltf;
        gltf.triangle()["material"] = 0;
        gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                   {"normalTexture", {{"index", 1}}}}};
        gltf.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
        gltf.json["images"] = {{{"uri", "c.png"}}, {{"uri", "data/n.png"}}};
        gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", uri}}};
        save_pixel(folder / "c.png");
        save_pixel(folder / "data/n.png");
        write_file(folder / file, gltf.binary);
        write_file(folder / "a.gltf", gltf.json.dump());
        EXPECT_EQ(read_files(folder, "a.gltf"),
                  (std::set<std::string>{"a.gltf", "c.png", "data/n.png", file}));
    }
}

TEST(OpenedParts, OfOtherFormatsAreFoundToo) {
    const TemporaryFolder folder;
    write_file(folder / "a.bin", Bytes().add_all({1.0f, 2.0f, 3.0f, 0.5f}).str());
    write_file(folder / "a.label", Bytes().add_all({uint32_t(40)}).str());
    EXPECT_EQ(read_files(folder, "a.bin"), (std::set<std::string>{"a.bin", "a.label"}));
    save_pixel(folder / "t.png");
    write_file(folder / "a.ply",
               "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 3\nproperty float x\n"
               "property float y\nproperty float z\nproperty float s\nproperty float t\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n"
               "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(read_files(folder, "a.ply"), (std::set<std::string>{"a.ply", "t.png"}));
}

// The bytes came from elsewhere.
TEST(OpenedParts, OfMemoryAreWhatLiesBesideTheName) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", "newmtl m\n");
    const std::string text = std::string("mtllib m.mtl\n") + triangle;
    const io::LoadedScene loaded = io::load_scene(as_span(text), folder / "a.obj", {.format = "obj"});
    ASSERT_EQ(loaded.files.size(), 1u);
    EXPECT_EQ(loaded.files.begin()->first, folder / "m.mtl");
}

// The log is written while the materials are read, which is when they are replaced.
TEST(OpenedParts, HaveTheirTimesFromBeforeTheyWereRead) {
    const TemporaryFolder folder;
    write_file(folder / "m.mtl", "newmtl m\nmap_Kd none.png\nunknown\nrefl x\n");
    write_file(folder / "a.obj", std::string("mtllib m.mtl\n") + triangle);
    const auto before = fs::last_write_time(folder / "m.mtl");
    set_log_sink([&](LogLevel, std::string_view) {
        fs::last_write_time(folder / "m.mtl", before + std::chrono::seconds(5));
    });
    const io::LoadedScene loaded = io::load_scene(folder / "a.obj");
    set_log_sink({});
    ASSERT_NE(fs::last_write_time(folder / "m.mtl"), before);
    EXPECT_EQ(loaded.files.at(folder / "m.mtl"), before);
    EXPECT_EQ(loaded.files.at(folder / "a.obj"), fs::last_write_time(folder / "a.obj"));
    EXPECT_EQ(loaded.files.at(folder / "none.png"), fs::file_time_type::min());
}

}  // namespace
}  // namespace easypbr::opened_parts_test
