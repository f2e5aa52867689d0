#include "easypbr/core/file_set.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "file_limit.h"
#include "io/temporary_folder.h"

namespace easypbr::file_set_test {
namespace {

class FileSets : public testing::Test {
  protected:
    FileSets() {
        write_file(folder_ / "old", std::string_view("before"));
        first_.add(folder_ / "old", std::string_view("after"));
    }

    std::string text_of(const char* name) const { return std::string(FileBytes(folder_ / name).text()); }
    /// A failure leaves what was there, and nothing else.
    void expect_untouched(size_t files) const {
        EXPECT_EQ(text_of("old"), "before");
        EXPECT_EQ(size_t(std::distance(fs::directory_iterator(folder_.path()), {})), files);
    }

    TemporaryFolder folder_;
    FileSet first_;
};

TEST_F(FileSets, AppearTogether) {
    first_.add(folder_ / "new", std::string_view("new"));
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    EXPECT_EQ(text_of("old"), "before");
    first_.commit();
    EXPECT_EQ(text_of("old"), "after");
    EXPECT_EQ(text_of("new"), "new");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(FileSets, AreGoneWithoutCommit) {
    { const FileSet dropped = std::move(first_); }
    expect_untouched(1);
}

TEST_F(FileSets, LeaveNothingOnAFullDisk) {
    {
        const FileSet set = std::move(first_);
        FileSet full = {};
        const FileLimit limit(1000);
        EXPECT_NO_THROW(full.add(folder_ / "small", std::string(1000, 'x')));
        try {
            full.add(folder_ / "large", std::string(1001, 'x'));
            FAIL() << "there is no room for it";
        } catch (const FileError& error) {
            EXPECT_NE(std::string(error.what()).find((folder_ / "large").string()), std::string::npos);
        }
    }
    expect_untouched(1);
}

TEST_F(FileSets, ChangeNothingWhereOneTargetIsAFolder) {
    fs::create_directory(folder_ / "folder");
    {
        FileSet set = std::move(first_);
        set.add(folder_ / "folder", std::string_view("x"));
        EXPECT_THROW(set.commit(), FileError);
    }
    expect_untouched(2);
}

/// Root may write everywhere: it is another user as long as this lives, whose the paths become.
class WithoutRoot {
  public:
    explicit WithoutRoot(const std::vector<fs::path>& paths) : was_root_(::geteuid() == 0) {
        constexpr uid_t nobody = 65534;
        if (!was_root_) return;
        for (const fs::path& path : paths)
            EXPECT_EQ(::chown(path.c_str(), nobody, gid_t(-1)), 0) << std::strerror(errno);
        EXPECT_EQ(::setresuid(nobody, nobody, 0), 0) << std::strerror(errno);
    }
    ~WithoutRoot() {
        if (!was_root_) return;
        EXPECT_EQ(::setresuid(0, 0, 0), 0) << std::strerror(errno);
    }
    WithoutRoot(const WithoutRoot&) = delete;
    WithoutRoot& operator=(const WithoutRoot&) = delete;

  private:
    bool was_root_;
};

TEST_F(FileSets, LeaveWhatIsWriteProtected) {
    fs::permissions(folder_ / "old", fs::perms::owner_read);
    const WithoutRoot user({folder_.path(), folder_ / "old"});
    EXPECT_THROW(first_.commit(), FileError);
    EXPECT_THROW(write_file(folder_ / "old", std::string_view("after")), FileError);
    EXPECT_EQ(text_of("old"), "before");
}

TEST_F(FileSets, FollowLinksThatLeadToNoFileYet) {
    fs::create_directory(folder_ / "folder");
    fs::create_symlink("folder/new", folder_ / "inner");
    fs::create_symlink(folder_ / "inner", folder_ / "link");
    write_file(folder_ / "link", std::string_view("text"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "inner"));
    EXPECT_EQ(text_of("folder/new"), "text");
    // What is written beside the target is none of the folder's own.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "folder"), {}), 1);
}

}  // namespace
}  // namespace easypbr::file_set_test
