#include "easypbr/core/folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <set>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"

namespace easypbr::folder_test {
namespace {

/// A folder "in" with a file and a folder, a file outside, and links of all kinds.
class FolderTest : public testing::Test {
  protected:
    FolderTest() {
        std::string name = (fs::temp_directory_path() / "easypbr_folder_XXXXXX").string();
        all_ = mkdtemp(name.data());
        in_ = all_ / "in";
        fs::create_directories(in_ / "deep");
        write_file(all_ / "secret", "outside");
        write_file(in_ / "a", "first");
        write_file(in_ / "deep/b", "second");
        fs::create_symlink("deep/b", in_ / "link");
        fs::create_symlink("../secret", in_ / "out");
        fs::create_symlink(all_ / "secret", in_ / "absolute");
        fs::create_symlink("..", in_ / "up");
        fs::create_symlink("nowhere", in_ / "broken");
        write_file(in_ / ".hidden", "");
        write_file(in_ / "\xff", "");
    }
    ~FolderTest() override { fs::remove_all(all_); }

    fs::path all_, in_;
};

const std::set<fs::path> outside = {"out",       "absolute",          "up/secret",
                                    "../secret", "deep/../../secret", "/etc/hostname"};

TEST_F(FolderTest, OpensWhatLiesBeneath) {
    const Folder folder(in_);
    for (const char* name : {"a", "deep/b", "link", "./a", "deep/../a"})
        EXPECT_GE(folder.open(name, O_RDONLY).get(), 0) << name;
    EXPECT_LT(folder.open("none", O_RDONLY).get(), 0);
    EXPECT_EQ(errno, ENOENT);
    for (const fs::path& name : outside) {
        EXPECT_LT(folder.open(name, O_RDONLY).get(), 0) << name;
        EXPECT_EQ(errno, EXDEV) << name;
    }
}

TEST_F(FolderTest, NothingOutsideIsThere) {
    EXPECT_TRUE(exists_in_scope(all_ / "secret"));
    EXPECT_FALSE(exists_in_scope(in_ / "none"));
    const Folder folder(in_);
    const FolderScope scope(&folder);
    for (const char* name : {"a", "deep/b", "deep"}) EXPECT_TRUE(exists_in_scope(in_ / name)) << name;
    EXPECT_FALSE(exists_in_scope(in_ / "none"));
    for (const fs::path& name : outside) EXPECT_FALSE(exists_in_scope(in_ / name)) << name;
}

// No link is followed, be it one that stays beneath.
TEST_F(FolderTest, OpensInStepsWithoutFollowingLinks) {
    const Folder folder(in_);
    for (const char* name : {"a", "deep/b", "./a"})
        EXPECT_GE(folder.open_in_steps(name, O_RDONLY).get(), 0) << name;
    EXPECT_GE(folder.open_in_steps("", O_RDONLY | O_DIRECTORY).get(), 0);
    for (const fs::path& name : outside) EXPECT_LT(folder.open_in_steps(name, O_RDONLY).get(), 0) << name;
    EXPECT_LT(folder.open_in_steps("link", O_RDONLY).get(), 0);
    EXPECT_LT(folder.open_in_steps("deep/../a", O_RDONLY).get(), 0);
}

TEST_F(FolderTest, ListsFoldersThenFilesWithoutWhatLeadsOut) {
    const Folder folder(in_);
    const std::vector<FolderEntry> expected = {{"deep", true, 0}, {"a", false, 5}, {"link", false, 6}};
    EXPECT_EQ(folder.list(""), expected);
    EXPECT_EQ(folder.list("deep"), (std::vector<FolderEntry>{{"b", false, 6}}));
    EXPECT_THROW(folder.list("up"), FileError);
    EXPECT_THROW(folder.list("a"), FileError);
}

TEST_F(FolderTest, IsMissing) {
    EXPECT_THROW(Folder(in_ / "none"), FileError);
    EXPECT_THROW(Folder(in_ / "a"), FileError);
    EXPECT_THROW(Folder(""), FileError);
}

// Another folder in its place is not the one that was opened.
TEST_F(FolderTest, StaysTheSame) {
    const Folder folder(in_);
    fs::rename(in_, all_ / "moved");
    fs::create_directory(in_);
    write_file(in_ / "new", "");
    EXPECT_EQ(folder.list("deep").size(), 1u);
    EXPECT_LT(folder.open("new", O_RDONLY).get(), 0);
}

TEST_F(FolderTest, ScopeBindsWhatIsRead) {
    const Folder folder(in_);
    const std::string secret = (all_ / "secret").string();
    {
        const FolderScope scope(&folder);
        EXPECT_EQ(FileBytes(in_ / "a").text(), "first");
        EXPECT_EQ(FileBytes(in_ / "link").text(), "second");
        EXPECT_EQ(FileBytes(in_ / "deep/../../in/a").text(), "first");
        for (const fs::path& name : outside) EXPECT_THROW(FileBytes(in_ / name), FileError) << name;
        try {
            FileBytes{fs::path(secret)};
            FAIL();
        } catch (const FileError& error) {
            EXPECT_EQ(error.what(),
                      "cannot read " + secret + ": it lies outside of the folder " + in_.string());
        }
        const FolderScope anywhere(nullptr);
        EXPECT_EQ(FileBytes(fs::path(secret)).text(), "outside");
    }
    EXPECT_EQ(FileBytes(fs::path(secret)).text(), "outside");
}

// Readers decode textures in loops over all cores.
TEST_F(FolderTest, ScopeBindsLoopsOnAllCores) {
    const Folder folder(in_);
    const fs::path secret = all_ / "secret";
    const FolderScope scope(&folder);
    std::vector<int> refused(64);
    parallel_for(refused.size(), 1, [&](size_t i) {
        try {
            FileBytes{secret};
        } catch (const FileError&) {
            refused[i] = 1;
        }
    });
    EXPECT_EQ(std::count(refused.begin(), refused.end(), 1), 64);
}

}  // namespace
}  // namespace easypbr::folder_test
