// Files that settings name are read when they are new or have changed, and not again else.
#include "easypbr/app/settings_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/settings.h"

namespace easypbr::app::settings_files_test {
namespace {

class EnvironmentFile : public testing::Test {
  protected:
    EnvironmentFile() {
        fs::create_directories(folder_);
        settings_.environment.file = path_.string();
        write(1);
    }
    ~EnvironmentFile() override { fs::remove_all(folder_); }

    /// Each time a second later, whatever the clock of the file system tells apart.
    void write(float value) {
        Image image(4, 2, 3, PixelType::f32);
        std::ranges::fill(image.pixels<float>(), value);
        io::save_image(image, path_);
        fs::last_write_time(path_, time_ += std::chrono::seconds(1));
    }
    /// The pixels that are loaded: others, where the file was read again, though it may have the same.
    const Image* load() {
        files_.load(settings_);
        return &files_.environment().image();
    }
    float value() const { return files_.environment().image().pixels<float>()[0]; }

    fs::path folder_ = fs::temp_directory_path() / ("easypbr-settings-files-" + std::to_string(::getpid()));
    fs::path path_ = folder_ / "e.exr";
    fs::file_time_type time_ = fs::file_time_type::clock::now();
    Settings settings_;
    SettingsFiles files_;
};

TEST_F(EnvironmentFile, IsReadWhenItHasChanged) {
    const Image* const first = load();
    EXPECT_EQ(value(), 1);
    EXPECT_EQ(load(), first) << "nothing has changed";
    write(2);
    load();
    EXPECT_EQ(value(), 2);
    settings_.environment.file.clear();
    files_.load(settings_);
    EXPECT_TRUE(files_.environment().empty());
}

TEST_F(EnvironmentFile, StaysWhileItIsMissing) {
    const Image* const first = load();
    fs::remove(path_);
    EXPECT_EQ(load(), first);
    write(3);
    load();
    EXPECT_EQ(value(), 3);
    settings_.environment.file = (folder_ / "none.exr").string();
    EXPECT_THROW(load(), FileError);
}

// What cannot be read is an error until it can be.
TEST_F(EnvironmentFile, IsReadWhenItIsWhole) {
    load();
    write_file(path_, "half");
    fs::last_write_time(path_, time_ += std::chrono::seconds(1));
    EXPECT_THROW(load(), FormatError);
    EXPECT_THROW(load(), FormatError);
    write(4);
    load();
    EXPECT_EQ(value(), 4);
}

TEST_F(EnvironmentFile, IsNotReadTwiceWhenItWasLoadedAtOnce) {
    files_.load_environment(path_);
    const Image* const first = &files_.environment().image();
    EXPECT_EQ(load(), first);
    files_.load_environment(path_);
    EXPECT_NE(&files_.environment().image(), first);
}

}  // namespace
}  // namespace easypbr::app::settings_files_test
