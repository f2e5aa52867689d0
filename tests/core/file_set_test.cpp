#include "easypbr/core/file_set.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
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

mode_t mode_of(const fs::path& path) {
    struct stat info {};
    EXPECT_EQ(::stat(path.c_str(), &info), 0);
    return info.st_mode & 07777;
}

TEST_F(FileSets, KeepThePermissionsOfWhatTheyReplace) {
    const mode_t mask = ::umask(022);
    for (const mode_t mode : {0600, 0640, 0666}) {
        ASSERT_EQ(::chmod((folder_ / "old").c_str(), mode), 0);
        FileSet set;
        set.add(folder_ / "old", std::string_view("secret"));
        // What is written beside it is as private already.
        for (const auto& entry : fs::directory_iterator(folder_.path())) {
            if (FileBytes(entry.path()).text() != "secret") continue;
            EXPECT_EQ(mode_of(entry.path()), mode);
        }
        set.commit();
        EXPECT_EQ(mode_of(folder_ / "old"), mode);
    }
    // A new file has those that the user wants new files to have.
    write_file(folder_ / "new", std::string_view("text"));
    EXPECT_EQ(mode_of(folder_ / "new"), 0644u);
    ::umask(mask);
}

TEST_F(FileSets, KeepTheOwnerOfWhatTheyReplace) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
    constexpr uid_t user = 65534, group = 65533;
    ASSERT_EQ(::chown((folder_ / "old").c_str(), user, group), 0);
    write_file(folder_ / "old", std::string_view("after"));
    struct stat info {};
    ASSERT_EQ(::stat((folder_ / "old").c_str(), &info), 0);
    EXPECT_EQ(info.st_uid, user);
    EXPECT_EQ(info.st_gid, group);
}

// A user that may not give it the group: whoever shares the user's own group gets what everybody gets.
TEST_F(FileSets, GiveAnotherGroupNoMoreThanEverybody) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
    constexpr gid_t none_of_the_users = 65533;
    ASSERT_EQ(::chown((folder_ / "old").c_str(), uid_t(-1), none_of_the_users), 0);
    ASSERT_EQ(::chmod((folder_ / "old").c_str(), 0664), 0);
    const WithoutRoot user({folder_.path(), folder_ / "old"});
    write_file(folder_ / "old", std::string_view("after"));
    EXPECT_EQ(mode_of(folder_ / "old"), 0644u);
}

TEST_F(FileSets, WriteIntoAFileWhoseFolderTakesNoOther) {
    const fs::path old = folder_ / "old";
    ASSERT_EQ(::chmod(old.c_str(), 0666), 0);
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0555), 0);
    {
        const WithoutRoot user({old});
        EXPECT_NO_THROW(check_writable(old));
        EXPECT_THROW(check_writable(folder_ / "new"), FileError);
        FileSet set;
        set.add(old, std::string_view("new"));
        EXPECT_EQ(text_of("old"), "before");
        set.commit();
        EXPECT_EQ(text_of("old"), "new");
    }
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
}

// As in /tmp: there is room for other files, but this one is not to be removed.
TEST_F(FileSets, WriteIntoAnotherUsersFileInAStickyFolder) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
    const fs::path old = folder_ / "old";
    ASSERT_EQ(::chmod(old.c_str(), 0666), 0);
    ASSERT_EQ(::chmod(folder_.path().c_str(), 01777), 0);
    const size_t files = size_t(std::distance(fs::directory_iterator(folder_.path()), {}));
    const WithoutRoot user(std::vector<fs::path>{});
    EXPECT_NO_THROW(check_writable(old));
    write_file(old, std::string_view("new"));
    EXPECT_EQ(text_of("old"), "new");
    EXPECT_EQ(size_t(std::distance(fs::directory_iterator(folder_.path()), {})), files);
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

/// Of the FileError that both ways to look at a target throw; empty where one throws none, or another one.
std::string why_not(const fs::path& target) {
    std::string why;
    const std::function<void()> ways[] = {[&] { check_writable(target); },
                                          [&] { write_file(target, std::string_view("text")); }};
    for (const auto& way : ways) {
        try {
            way();
            return {};
        } catch (const FileError& error) {
            if (!why.empty() && why != error.what()) return {};
            why = error.what();
        }
    }
    return why;
}

TEST_F(FileSets, TakeNamesOfAnyLengthThatTheSystemTakes) {
    const std::string longest(NAME_MAX, 'a');
    EXPECT_NO_THROW(check_writable(folder_ / longest));
    write_file(folder_ / longest, std::string_view("text"));
    EXPECT_EQ(text_of(longest.c_str()), "text");
    const fs::path longer = folder_ / (longest + 'a');
    EXPECT_EQ(why_not(longer), "cannot write " + longer.string() + ": " + std::strerror(ENAMETOOLONG));
}

TEST_F(FileSets, NameLinksThatLeadInALoop) {
    fs::create_symlink("b", folder_ / "a");
    fs::create_symlink("a", folder_ / "b");
    EXPECT_NE(why_not(folder_ / "a").find(std::strerror(ELOOP)), std::string::npos);
}

// A killed process leaves one, and another with its number comes, as in containers.
TEST_F(FileSets, PassOverNamesThatAreTaken) {
    const std::string begin = ".easypbr." + std::to_string(::getpid()) + ".", last = temporary_name();
    ASSERT_TRUE(last.starts_with(begin) && is_temporary_name(last));
    const fs::path next =
        folder_ / (begin + std::to_string(std::stoul(last.substr(begin.size())) + 1) + ".tmp");
    std::ofstream(next) << "left";
    write_file(folder_ / "new", std::string_view("text"));
    EXPECT_EQ(text_of("new"), "text");
    EXPECT_EQ(text_of(next.filename().c_str()), "left");
}

}  // namespace
}  // namespace easypbr::file_set_test
