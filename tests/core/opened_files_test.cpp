#include "easypbr/core/opened_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"

namespace easypbr::opened_files_test {
namespace {

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
    EXPECT_EQ(some.paths(), (std::set<fs::path>{inner, folder_ / "none"}));
    EXPECT_EQ(all.paths(), (std::set<fs::path>{inner, folder_ / "none", outer}));
}

TEST_F(OpenedFilesTest, AreThoseOfLoopsOnAllCores) {
    constexpr size_t count = 100;
    std::set<fs::path> files;
    for (size_t i = 0; i < count; ++i) files.insert(made(std::to_string(i)));
    OpenedFiles opened;
    const OpenedFilesScope noted(&opened);
    parallel_for(count, 1, [&](size_t i) { check_readable(folder_ / std::to_string(i)); });
    EXPECT_EQ(opened.paths(), files);
}

}  // namespace
}  // namespace easypbr::opened_files_test
