// The file that a setting names is that of the working folder where it was given.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"
#include "io/temporary_folder.h"

namespace easypbr::named_file_test {
namespace {

namespace fs = std::filesystem;

/// The working folder of the process while it lives.
class WorkingFolder {
  public:
    explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) { fs::current_path(folder); }
    ~WorkingFolder() { fs::current_path(before_); }
    WorkingFolder(const WorkingFolder&) = delete;

  private:
    fs::path before_;
};

}  // namespace

TEST(NamedFile, IsThatOfTheFolderItWasGivenIn) {
    const TemporaryFolder folder, other;
    NamedFile file, copy;
    {
        const WorkingFolder there(folder.path());
        file = "a.png";
        // The system's name of the folder may be another one than the test's, through links.
        EXPECT_EQ(file.path(), (fs::current_path() / "a.png").string());
        EXPECT_EQ(file.path_from_here(), "a.png");
    }
    copy = file;
    const WorkingFolder here(other.path());
    EXPECT_EQ(copy.name(), "a.png");
    EXPECT_EQ(copy.path_from_here(), file.path());
    EXPECT_EQ(copy, file);
    const NamedFile again = "a.png";
    EXPECT_EQ(again.path(), (fs::current_path() / "a.png").string());
    EXPECT_FALSE(again == file) << "the same name of another file";
}

TEST(NamedFile, IsUsedLikeAString) {
    NamedFile file;
    EXPECT_TRUE(file.empty());
    EXPECT_EQ(file.path(), "");
    EXPECT_EQ(file.path_from_here(), "");
    file = std::string("/a.png");
    const std::string text = file;
    EXPECT_EQ(text, "/a.png");
    EXPECT_EQ(file, "/a.png");
    EXPECT_EQ(file, text);
    EXPECT_EQ(file.path(), "/a.png");
    file.clear();
    EXPECT_EQ(file, NamedFile());
}

TEST(NamedFile, SettingsShowTheName) {
    const TemporaryFolder folder;
    Settings settings;
    {
        const WorkingFolder there(folder.path());
        set(settings, "background.image", {std::string("a.png")});
    }
    EXPECT_EQ(std::get<std::string>(get(settings, "background.image").data), "a.png");
    EXPECT_EQ(fs::path(settings.background.image.path()).filename(), "a.png");
    EXPECT_NE(settings.background.image.path_from_here(), "a.png");
}

}  // namespace easypbr::named_file_test
