// Files that are shown again when they, or what they are made of, change.
#include "easypbr/app/scene_files.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <fstream>

#include "easypbr/app/clock.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/scene/mesh_data.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::scene_files_test {
namespace {

namespace fs = std::filesystem;

class WatchedFiles : public testing::Test {
  protected:
    WatchedFiles() { fs::create_directories(folder_); }
    ~WatchedFiles() override { fs::remove_all(folder_); }

    /// Each time a second later, whatever the clock of the file system tells apart.
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        time_ += std::chrono::seconds(1);
        fs::last_write_time(folder_ / name, time_);
    }
    /// As the command line shows and watches a file.
    void show_and_watch(const std::string& name, const std::string& format = {}) {
        const io::LoadedScene loaded = io::load_scene(folder_ / name, {.format = format});
        files_.watch(folder_ / name, files_.add(loaded, folder_ / name), loaded, format);
    }
    Vec3 color() const { return session_.scene().get("a").snapshot()->materials.at(0).base_color; }
    bool reloads() {
        const size_t before = notifications_.list().size();
        files_.advance(1);
        return notifications_.list().size() > before;
    }

    fs::path folder_ = fs::temp_directory_path() / ("easypbr-scene-files-" + std::to_string(::getpid()));
    fs::file_time_type time_ = fs::file_time_type::clock::now();
    Session session_;
    Clock clock_;
    AnimationPlayer player_{clock_};
    Notifications notifications_;
    Edits edits_{session_};
    SceneFiles files_{session_, player_, notifications_, edits_};
};

/// A triangle and a point light, as glTF; `intensity` in candela.
std::string lit_triangle(int intensity) {
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","name":"lamp","intensity":)" +
           std::to_string(intensity) + R"(}]}},
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"nodes":[{"mesh":0},{"name":"lamp","extensions":{"KHR_lights_punctual":{"light":0}}}],
"scenes":[{"nodes":[0,1]}],"scene":0})";
}

TEST_F(WatchedFiles, MaterialsAndTexturesAreReadAgain) {
    const std::string red = "newmtl m\nKd 1 0 0\n", blue = "newmtl m\nKd 0 0 1\nmap_Kd t.png\n";
    write("m.mtl", red);
    write("other.mtl", red);
    write("a.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    show_and_watch("a.obj");
    ASSERT_EQ(color(), Vec3(1, 0, 0));
    EXPECT_FALSE(reloads());
    write("other.mtl", blue);
    EXPECT_FALSE(reloads()) << "the file does not name it";
    io::save_image(Image(1, 1, 3, PixelType::u8), folder_ / "t.png");
    write("m.mtl", blue);
    EXPECT_TRUE(reloads());
    EXPECT_EQ(color(), Vec3(0, 0, 1));
    EXPECT_FALSE(reloads());
    // The image came with the materials.
    io::save_image(Image(3, 2, 3, PixelType::u8), folder_ / "t.png");
    time_ += std::chrono::seconds(1);
    fs::last_write_time(folder_ / "t.png", time_);
    EXPECT_TRUE(reloads());
    EXPECT_EQ(session_.scene().get("a").snapshot()->materials.at(0).base_color_texture.image->width(), 3);
}

// The name of a part says nothing of where it lies and what its name ends in; an image may be made later.
TEST_F(WatchedFiles, PartsAreReadAgainWhateverTheirNames) {
    fs::create_directories(folder_ / "parts");
    write("parts/m.mtl", "newmtl m\nKd 1 0 0\nmap_Kd later.png\n");
    write("a.obj", "mtllib parts/m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    show_and_watch("a.obj");
    EXPECT_FALSE(reloads());
    write("parts/m.mtl", "newmtl m\nKd 0 1 0\nmap_Kd later.png\n");
    EXPECT_TRUE(reloads());
    EXPECT_EQ(color(), Vec3(0, 1, 0));
    EXPECT_FALSE(reloads());
    io::save_image(Image(3, 2, 3, PixelType::u8), folder_ / "later.png");
    EXPECT_TRUE(reloads());
    EXPECT_TRUE(session_.scene().get("a").snapshot()->materials.at(0).base_color_texture);
    EXPECT_FALSE(reloads());
}

// The extension tells nothing.
TEST_F(WatchedFiles, FilesAreReadAgainInTheirFormat) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write("a.dat", triangle);
    show_and_watch("a.dat", "obj");
    write("a.dat", triangle + "f 3 2 1\n");
    EXPECT_TRUE(reloads());
    EXPECT_EQ(notifications_.list().back().text, "Reloaded a");
    EXPECT_EQ(session_.scene().get("a").F().rows(), 2);
}

// What a person has done by hand stays, and undo goes back to what the file holds now.
TEST_F(WatchedFiles, PosesAndLightsOfAPersonAreKept) {
    write("a.gltf", lit_triangle(5));
    show_and_watch("a.gltf");
    ASSERT_EQ(session_.scene().light_names().size(), 1u);
    const std::string lamp = session_.scene().light_names()[0];
    const auto place = [&] { return session_.scene().get("a").T_parent_mesh().translation().eval(); };
    ASSERT_EQ(session_.scene().light(lamp).intensity, 5);
    write("a.gltf", lit_triangle(6));
    ASSERT_TRUE(reloads());
    ASSERT_EQ(session_.scene().light(lamp).intensity, 6);
    edits_.note();
    edits_.will_move("a");
    session_.scene().get("a").translate(Vec3d(1, 0, 0));
    edits_.will_change_light(lamp);
    session_.scene().remove_light(lamp);
    edits_.note();
    write("a.gltf", lit_triangle(7));
    ASSERT_TRUE(reloads());
    EXPECT_EQ(place(), Vec3d(1, 0, 0));
    EXPECT_TRUE(session_.scene().light_names().empty());
    edits_.undo();
    EXPECT_EQ(place(), Vec3d(0, 0, 0));
    ASSERT_EQ(session_.scene().light_names(), std::vector<std::string>{lamp});
    EXPECT_EQ(session_.scene().light(lamp).intensity, 7);
    edits_.redo();
    EXPECT_EQ(place(), Vec3d(1, 0, 0));
    EXPECT_TRUE(session_.scene().light_names().empty());
}

TEST_F(WatchedFiles, WhatWasRemovedIsNotShownAgain) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write("a.obj", triangle);
    show_and_watch("a.obj");
    session_.scene().remove("a");
    write("a.obj", triangle + "f 3 2 1\n");
    EXPECT_FALSE(reloads());
    EXPECT_FALSE(session_.scene().contains("a"));
    // The program shows it again: it is followed again.
    session_.scene().show(io::load_scene(folder_ / "a.obj").mesh, "a");
    write("a.obj", triangle);
    EXPECT_TRUE(reloads());
    EXPECT_EQ(session_.scene().get("a").F().rows(), 1);
}

// The command that is told draws the picture again, for a POSIX shell; its parts come from the manual of sh.
TEST_F(WatchedFiles, SavedSettingsComeWithACommandAndWhatTheyDoNotHold) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write("b.obj", triangle);
    write("it's a.obj", triangle);
    const fs::path saved = folder_ / "look.json";
    files_.save_settings(saved, {123, 45});
    EXPECT_NE(notifications_.list().back().text.find("nothing that is shown was read from a file"),
              std::string::npos);
    files_.open(folder_ / "b.obj");
    files_.open(folder_ / "it's a.obj");
    session_.scene().show(session_.scene().get("b"), "twice");
    files_.save_settings(saved, {123, 45});
    EXPECT_EQ(io::load_settings(saved).settings.image.size, Vec2i(123, 45));
    EXPECT_NE(session_.settings().image.size, Vec2i(123, 45));
    const std::string folder = folder_.string(), quote = "'\\''";
    const std::string all = "Saved " + folder + "/look.json: easypbr render " + folder + "/b.obj '" + folder +
                            "/it" + quote + "s a.obj' --settings " + folder + "/look.json -o " + folder +
                            "/look.png makes this picture";
    EXPECT_EQ(notifications_.list().back().text, all);
    session_.scene().remove("twice");
    edits_.change_look("b", "style.visible", {false});
    edits_.change_look("b", "material.roughness", {0.25});
    edits_.will_move("it's a");
    session_.scene().get("it's a").translate(Vec3d(1, 0, 0));
    session_.scene().show(Mesh(), "own");
    files_.save_settings(saved, {123, 45});
    EXPECT_EQ(notifications_.list().back().text,
              all +
                  ", but for materials and styles changed (b), objects hidden (b), "
                  "objects without a file (own), poses changed (it's a)");
    edits_.note();
    edits_.change_look("b", "style.visible", {true});
    session_.scene().remove("own");
    files_.save_settings(saved, {123, 45});
    EXPECT_EQ(notifications_.list().back().text,
              all + ", but for materials and styles changed (b), poses changed (it's a)");
}

// It comes back when the file is read.
TEST_F(WatchedFiles, SavedSettingsDoNotHoldThatALightWasRemoved) {
    write("a.gltf", lit_triangle(5));
    files_.open(folder_ / "a.gltf");
    const std::string lamp = session_.scene().light_names().at(0);
    edits_.will_change_light(lamp);
    session_.scene().remove_light(lamp);
    files_.save_settings(folder_ / "look.json", {12, 8});
    EXPECT_TRUE(notifications_.list().back().text.ends_with("makes this picture, but for lights removed (" +
                                                            lamp + ")"));
}

}  // namespace
}  // namespace easypbr::app::scene_files_test
