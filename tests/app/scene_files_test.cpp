// Files that are shown again when they, or what they are made of, change.
#include "easypbr/app/scene_files.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <fstream>

#include "easypbr/app/clock.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/mesh/mesh_io.h"
#include "easypbr/scene/mesh_data.h"

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
    SceneFiles files_{session_, player_, notifications_};
};

TEST_F(WatchedFiles, MaterialsAndTexturesAreReadAgain) {
    const std::string red = "newmtl m\nKd 1 0 0\n", blue = "newmtl m\nKd 0 0 1\nmap_Kd t.png\n";
    write("m.mtl", red);
    write("other.mtl", red);
    write("a.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    session_.scene().show(io::load_scene(folder_ / "a.obj").mesh, "a");
    ASSERT_EQ(color(), Vec3(1, 0, 0));
    files_.watch(folder_ / "a.obj", "a");
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

}  // namespace
}  // namespace easypbr::app::scene_files_test
