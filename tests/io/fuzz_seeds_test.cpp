// The kept files of tests/fuzz/seeds, good ones and those that once did harm, read as `make fuzz` reads them.
#include <gtest/gtest.h>

#include <set>

#include "easypbr/core/file.h"
#include "fuzz/targets.h"

namespace easypbr::fuzz_seeds_test {
namespace {

fs::path seeds() {
    return fs::path(EASYPBR_TESTS) / "fuzz/seeds";
}

TEST(FuzzSeeds, EachIsReadOrRefused) {
    for (const fuzz::Target& target : fuzz::targets()) {
        size_t files = 0;
        for (const auto& entry : fs::directory_iterator(seeds() / target.name)) {
            const FileBytes bytes(entry.path());
            EXPECT_NO_THROW(target.run(bytes.bytes())) << entry.path();
            EXPECT_LE(bytes.size(), 16384u) << entry.path() << ": kept files are small";
            ++files;
        }
        EXPECT_GT(files, 0u) << target.name << " has no seed";
    }
}

TEST(FuzzSeeds, EachFolderIsThatOfATarget) {
    std::set<std::string> names;
    for (const fuzz::Target& target : fuzz::targets()) names.insert(target.name);
    for (const auto& entry : fs::directory_iterator(seeds()))
        EXPECT_TRUE(names.contains(entry.path().filename().string())) << entry.path();
}

}  // namespace
}  // namespace easypbr::fuzz_seeds_test
