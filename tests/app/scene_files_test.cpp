// Files that are shown again when they, or what they are made of, change.
#include "easypbr/app/scene_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "easypbr/app/clock.h"
#include "easypbr/core/log.h"
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

using Lights = std::vector<std::pair<std::string, int>>;

/// A triangle as glTF, with point lights by their names, of intensities in candela. An animation moves the
/// first one from x = 0 to 1 in a second.
std::string lit_triangle(const Lights& lights, bool is_animated = false) {
    std::string all, nodes, roots = "0";
    for (size_t i = 0; i < lights.size(); ++i) {
        const auto& [name, intensity] = lights[i];
        all +=
            fmt::format(R"({}{{"type":"point","name":"{}","intensity":{}}})", i ? "," : "", name, intensity);
        nodes +=
            fmt::format(R"(,{{"name":"{}","extensions":{{"KHR_lights_punctual":{{"light":{}}}}}}})", name, i);
        roots += fmt::format(",{}", i + 1);
    }
    // The numbers 0, 1 are the times, and 0 0 0, 1 0 0 the places.
    const char* const animation = R"(,"animations":[{"name":"swing",
"samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}]}])";
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[)" +
           all + R"(]}},
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":8,"byteLength":8}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"nodes":[{"mesh":0})" +
           nodes + R"(],"scenes":[{"nodes":[)" + roots + R"(]}],"scene":0)" + (is_animated ? animation : "") +
           "}";
}

/// With one light, "lamp".
std::string lit_triangle(int intensity) {
    return lit_triangle({{"lamp", intensity}});
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

// Each file is replaced by another one after it was opened and before its reading ends: it is read once more,
// and no more than once. The log is written between.
TEST_F(WatchedFiles, FilesThatAreReplacedWhileTheyAreReadAreReadAgain) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\n";
    const auto material = [](const std::string& color) {
        return "newmtl m\nKd " + color + "\nrefl warning\n";
    };
    bool replaces = true;
    set_log_sink([&](LogLevel, std::string_view) {
        if (!std::exchange(replaces, false)) return;
        write("a.obj", "mtllib m.mtl\n" + vertices + "f 1 2 3\nf 3 2 1\n");
        write("m.mtl", material("0 1 0"));
    });
    write("m.mtl", material("1 0 0"));
    write("a.obj", "mtllib m.mtl\n" + vertices + "f 1 2 3\n");
    show_and_watch("a.obj");
    ASSERT_FALSE(replaces);
    ASSERT_EQ(session_.scene().get("a").F().rows(), 1);
    EXPECT_TRUE(reloads());
    EXPECT_EQ(session_.scene().get("a").F().rows(), 2);
    EXPECT_EQ(color(), Vec3(0, 1, 0));
    EXPECT_FALSE(reloads());
    // The same while a changed file and its new part are read again.
    write("n.mtl", material("0 0 1"));
    write("a.obj", "mtllib n.mtl\n" + vertices + "f 1 2 3\n");
    set_log_sink([&](LogLevel, std::string_view) {
        if (!std::exchange(replaces, true)) write("n.mtl", material("1 1 0"));
    });
    EXPECT_TRUE(reloads());
    EXPECT_EQ(color(), Vec3(0, 0, 1));
    EXPECT_TRUE(reloads());
    EXPECT_EQ(color(), Vec3(1, 1, 0));
    EXPECT_FALSE(reloads());
    set_log_sink({});
}

// A file may be written before what it names.
TEST_F(WatchedFiles, WhatAFileLacksMayBeWrittenLater) {
    const auto triangle = [](const std::string& buffer) {
        return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":")" + buffer +
               R"("}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})";
    };
    write("one.bin", std::string(36, '\0'));
    write("a.gltf", triangle("one.bin"));
    show_and_watch("a.gltf");
    write("a.gltf", triangle("two.bin"));
    EXPECT_TRUE(reloads());
    EXPECT_NE(notifications_.list().back().text, "Reloaded a");
    EXPECT_FALSE(reloads());
    write("two.bin", std::string(36, '\0'));
    EXPECT_TRUE(reloads());
    EXPECT_EQ(notifications_.list().back().text, "Reloaded a");
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

// Lights that the file no longer has go, but for one that a person has changed; undo leads to none.
TEST_F(WatchedFiles, LightsThatTheFileLostAreRemoved) {
    using Names = std::vector<std::string>;
    Scene& scene = session_.scene();
    write("a.gltf", lit_triangle({{"blue", 1}, {"green", 2}, {"red", 3}}));
    show_and_watch("a.gltf");
    scene.set_light("a/own", {});
    edits_.note();
    Light changed = scene.light("a/green");
    changed.intensity = 20;
    edits_.will_change_light("a/green");
    scene.set_light("a/green", changed);
    edits_.note();
    write("a.gltf", lit_triangle({{"red", 3}}));
    ASSERT_TRUE(reloads());
    EXPECT_EQ(scene.light_names(), (Names{"a/green", "a/own", "a/red"})) << "blue is gone";
    EXPECT_EQ(scene.light("a/green").intensity, 20);
    edits_.undo();
    EXPECT_EQ(scene.light_names(), (Names{"a/own", "a/red"}));
    edits_.redo();
    EXPECT_EQ(scene.light("a/green").intensity, 20);
    write("a.gltf", lit_triangle(Lights{}));
    ASSERT_TRUE(reloads());
    EXPECT_EQ(scene.light_names(), (Names{"a/green", "a/own"}));
}

// A light that is the same in the file stays as the program has it.
TEST_F(WatchedFiles, LightsOfTheProgramStayWhileTheFileHasTheSame) {
    Scene& scene = session_.scene();
    write("a.gltf", lit_triangle({{"blue", 1}, {"red", 3}}));
    show_and_watch("a.gltf");
    scene.remove_light("a/blue");
    Light dimmed = scene.light("a/red");
    dimmed.intensity = 0.5f;
    scene.set_light("a/red", dimmed);
    write("a.gltf", lit_triangle({{"blue", 1}, {"red", 3}}));
    ASSERT_TRUE(reloads());
    EXPECT_EQ(scene.light_names(), std::vector<std::string>{"a/red"});
    EXPECT_EQ(scene.light("a/red").intensity, 0.5f);
    write("a.gltf", lit_triangle({{"blue", 2}, {"red", 4}}));
    ASSERT_TRUE(reloads());
    ASSERT_EQ(scene.light_names(), (std::vector<std::string>{"a/blue", "a/red"}));
    EXPECT_EQ(scene.light("a/blue").intensity, 2);
    EXPECT_EQ(scene.light("a/red").intensity, 4);
}

TEST_F(WatchedFiles, AnimationsThatTheFileLostAreForgotten) {
    write("a.gltf", lit_triangle({{"lamp", 5}}, true));
    show_and_watch("a.gltf");
    player_.add("own", {});
    ASSERT_EQ(player_.names(), std::vector<std::string>{"a: swing"});
    const auto x = [&] { return session_.scene().light("a/lamp").position.x(); };
    player_.seek(0.5);
    ASSERT_EQ(x(), 0.5);
    write("a.gltf", lit_triangle(5));
    ASSERT_TRUE(reloads());
    EXPECT_TRUE(player_.empty());
    EXPECT_FALSE(player_.has("a"));
    EXPECT_TRUE(player_.has("own")) << "those of the program stay";
    EXPECT_EQ(x(), 0) << "where the file has it";
    write("a.gltf", lit_triangle({{"lamp", 5}}, true));
    ASSERT_TRUE(reloads());
    EXPECT_EQ(player_.names(), std::vector<std::string>{"a: swing"});
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
