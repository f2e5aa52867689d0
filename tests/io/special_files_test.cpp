// What stands where a file is expected and is none, and files that change while they are read: an error each
// time, never a wait and never a signal.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <functional>
#include <thread>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/log.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/io/settings/label_map_io.h"
#include "easypbr/io/settings/settings_io.h"
#include "io/gltf_builder.h"
#include "io/temporary_folder.h"

namespace easypbr::special_files_test {

namespace {

/// What the places of files that must not be read are called.
const std::vector<std::pair<std::string, std::string>> kinds{
    {"pipe", "it is a pipe"}, {"folder", "it is a folder"}, {"device", "it is a device"}};

/// A pipe that nobody writes into, a folder, or a link to a device.
void make(const std::string& kind, const fs::path& path) {
    fs::remove(path);
    if (kind == "pipe") ::mkfifo(path.c_str(), 0600);
    if (kind == "folder") fs::create_directory(path);
    if (kind == "device") fs::create_symlink("/dev/zero", path);
}

template <class Exception>
std::string message_of(const std::function<void()>& read) {
    try {
        read();
    } catch (const Exception& error) {
        return error.what();
    }
    return "no error";
}

/// The warnings that reading gives.
std::string warnings_of(const std::function<void()>& read) {
    std::string warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings += std::string(message) + "\n"; });
    read();
    set_log_sink({});
    return warnings;
}

TEST(SpecialFiles, AreRefusedByEveryReader) {
    const TemporaryFolder folder;
    const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> readers{
        {"png", [](const fs::path& path) { io::load_image(path); }},
        {"hdr", [](const fs::path& path) { io::load_image(path); }},
        {"json", [](const fs::path& path) { io::load_settings(path); }},
        {"json", [](const fs::path& path) { io::load_camera_path(path); }},
        {"yaml", [](const fs::path& path) { io::load_label_map(path); }},
        {"any", [](const fs::path& path) { io::hash_file(path); }}};
    for (const auto& [kind, message] : kinds) {
        for (const std::string& extension : io::readable_extensions()) {
            const fs::path path = folder / (kind + "." + extension);
            make(kind, path);
            EXPECT_NE(message_of<FileError>([&] { io::load_scene(path); }).find(message), std::string::npos)
                << extension;
        }
        for (const auto& [extension, read] : readers) {
            const fs::path path = folder / (kind + "." + extension);
            make(kind, path);
            EXPECT_NE(message_of<FileError>([&] { read(path); }).find(message), std::string::npos)
                << extension;
        }
    }
}

TEST(SpecialFiles, AreRefusedWhereAMeshNamesThem) {
    const TemporaryFolder folder;
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    write_file(folder / "a.obj", "mtllib special\n" + square);
    write_file(folder / "b.obj", "mtllib b.mtl\n" + square);
    write_file(folder / "b.mtl", std::string_view("newmtl a\nmap_Kd special\n"));
    GltfBuilder builder;
    builder.triangle();
    builder.json["buffers"] = {{{"uri", "special"}, {"byteLength", 36}}};
    write_file(folder / "a.gltf", builder.json.dump());
    for (const auto& [kind, message] : kinds) {
        make(kind, folder / "special");
        for (const char* name : {"a.obj", "b.obj"})
            EXPECT_NE(warnings_of([&] { io::load_mesh(folder / name); }).find(message), std::string::npos)
                << name << " " << kind;
        EXPECT_NE(message_of<FileError>([&] { io::load_mesh(folder / "a.gltf"); }).find(message),
                  std::string::npos)
            << kind;
    }
}

/// Rows of lists with three vertices, the last one with four. The rows before it are read, and their memory
/// given back, before it turns out that not all have three.
TEST(Ply, ReadsRowsAgainWhenTheLastOneIsLonger) {
    constexpr int32_t faces = 5'000'000;
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty uchar x\n"
        "property uchar y\nproperty uchar z\nelement face 5000000\n"
        "property list uchar uchar vertex_indices\nend_header\n";
    for (char i = 0; i < 5; ++i) text += {i, char(i * i), 1};
    for (int32_t i = 0; i + 1 < faces; ++i) text += {3, char(i % 3), char(i % 3 + 1), char(i % 3 + 2)};
    text += {4, 0, 1, 2, 3};
    const TemporaryFolder folder;
    write_file(folder / "a.ply", text);
    const Mesh mesh = io::load_mesh(folder / "a.ply");
    const MeshData& data = *mesh.snapshot();
    ASSERT_EQ(data.F.rows(), faces + 1);
    for (int32_t i = 0; i + 1 < faces; i += 1001)
        ASSERT_EQ(data.F.row(i), Eigen::RowVector3i(i % 3, i % 3 + 1, i % 3 + 2)) << i;
}

// Another process shortens files while they are read: a plain map would end the process by SIGBUS.
TEST(ChangingFile, IsReadOrRefused) {
    const TemporaryFolder folder;
    const std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n" + std::string(20'000'000, '\n');
    const fs::path path = folder / "a.obj";
    write_file(path, text);
    std::atomic<bool> stop{false};
    std::thread other([&] {
        for (; !stop; std::this_thread::yield()) {
            fs::resize_file(path, 100);
            fs::resize_file(path, text.size());
        }
    });
    int read = 0, refused = 0;
    for (int i = 0; i < 100; ++i) try {
            io::load_mesh(path);
            ++read;
        } catch (const Error&) {
            ++refused;
        }
    stop = true;
    other.join();
    EXPECT_EQ(read + refused, 100);
}

}  // namespace

}  // namespace easypbr::special_files_test
