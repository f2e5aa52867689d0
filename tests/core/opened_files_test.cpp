#include "easypbr/core/opened_files.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/folder.h"
#include "easypbr/core/parallel.h"

namespace easypbr::opened_files_test {
namespace {

std::set<fs::path> paths_of(const OpenedFiles& files) {
    std::set<fs::path> paths;
    for (const auto& [path, time] : files.times()) paths.insert(path);
    return paths;
}

class OpenedFilesTest : public testing::Test {
  protected:
    ~OpenedFilesTest() override { fs::remove_all(folder_); }
    fs::path made(const std::string& name) const {
        fs::create_directories(folder_);
        write_file(folder_ / name, name);
        return folder_ / name;
    }

    fs::path folder_ = fs::temp_directory_path() / ("easypbr-opened-" + std::to_string(::getpid()));
};

TEST_F(OpenedFilesTest, AreThoseOfTheScopes) {
    const fs::path before = made("before"), outer = made("outer"), inner = made("inner");
    check_readable(before);
    OpenedFiles all;
    const OpenedFilesScope around(&all);
    check_readable(outer);
    OpenedFiles some;
    {
        const OpenedFilesScope within(&some);
        check_readable(inner);
        EXPECT_THROW(check_readable(folder_ / "none"), FileError);
        const OpenedFilesScope nobody(nullptr);
        check_readable(before);
    }
    EXPECT_EQ(paths_of(some), (std::set<fs::path>{inner, folder_ / "none"}));
    EXPECT_EQ(paths_of(all), (std::set<fs::path>{inner, folder_ / "none", outer}));
}

// The first time counts: what was read then may be old.
TEST_F(OpenedFilesTest, HaveTheTimeFromWhenTheyWereFirstOpened) {
    const fs::path file = made("file");
    const auto time = fs::last_write_time(file);
    OpenedFiles opened;
    const OpenedFilesScope noted(&opened);
    check_readable(file);
    fs::last_write_time(file, time + std::chrono::seconds(3));
    check_readable(file);
    EXPECT_THROW(check_readable(folder_ / "none"), FileError);
    EXPECT_EQ(opened.times().at(file), time);
    EXPECT_EQ(opened.times().at(folder_ / "none"), fs::file_time_type::min());
}

// A folder's clients may name any path: nobody looks whether something is there outside of the folder.
TEST_F(OpenedFilesTest, AreNoneOutsideOfTheFolder) {
    const fs::path outside = made("outside"), in = folder_ / "in";
    fs::create_directories(in);
    write_file(in / "file", "inside");
    fs::create_symlink("../outside", in / "link");
    const Folder folder(in);
    OpenedFiles opened;
    const OpenedFilesScope noted(&opened);
    const FolderScope bound(&folder);
    for (const fs::path& path : {outside, in / "../outside", in / "link", folder_ / "none"})
        EXPECT_THROW(check_readable(path), FileError) << path;
    EXPECT_EQ(paths_of(opened), std::set<fs::path>{});
    check_readable(in / "file");
    EXPECT_THROW(check_readable(in / "none"), FileError);
    EXPECT_EQ(opened.times(), (OpenedFiles::Times{{in / "file", fs::last_write_time(in / "file")},
                                                  {in / "none", fs::file_time_type::min()}}));
}

// A socket cannot be opened as files are. It has a time all the same: it is not missing.
TEST_F(OpenedFilesTest, HaveTheTimeOfWhatCannotBeOpened) {
    fs::create_directories(folder_);
    const fs::path path = folder_ / "socket";
    const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{AF_UNIX, {}};
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(listener);
    const Folder folder(folder_);
    for (const Folder* bound : {static_cast<const Folder*>(nullptr), &folder}) {
        OpenedFiles opened;
        const OpenedFilesScope noted(&opened);
        const FolderScope scope(bound);
        EXPECT_THROW(check_readable(path), FileError);
        EXPECT_EQ(opened.times(), (OpenedFiles::Times{{path, fs::last_write_time(path)}}));
    }
}

TEST_F(OpenedFilesTest, AreThoseOfLoopsOnAllCores) {
    constexpr size_t count = 100;
    std::set<fs::path> files;
    for (size_t i = 0; i < count; ++i) files.insert(made(std::to_string(i)));
    OpenedFiles opened;
    const OpenedFilesScope noted(&opened);
    parallel_for(count, 1, [&](size_t i) { check_readable(folder_ / std::to_string(i)); });
    EXPECT_EQ(paths_of(opened), files);
}

}  // namespace
}  // namespace easypbr::opened_files_test
