#include "easypbr/core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "easypbr/core/cache.h"
#include "easypbr/core/error.h"
#include "easypbr/core/hash.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"

using namespace easypbr;

namespace {

/// A new folder for every test, gone afterwards.
class FileTest : public testing::Test {
  protected:
    FileTest() {
        std::string name = (fs::temp_directory_path() / "easypbr_core_XXXXXX").string();
        folder_ = mkdtemp(name.data());
        setenv("EASYPBR_CACHE_DIR", (folder_ / "cache").c_str(), 1);
    }
    ~FileTest() override {
        unsetenv("EASYPBR_CACHE_DIR");
        fs::remove_all(folder_);
    }

    size_t file_count() const { return size_t(std::distance(fs::directory_iterator(folder_), {})); }

    fs::path folder_;
};

using File = FileTest;
using Cache = FileTest;

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

TEST_F(File, ReplacesTheWholeFile) {
    write_file(folder_ / "a.txt", std::string_view("a long first content"));
    // The mapping keeps the replaced file: it is another one, not overwritten in place.
    const MappedFile before(folder_ / "a.txt");
    write_file(folder_ / "a.txt", std::string_view("short"));
    EXPECT_EQ(before.text(), "a long first content");
    EXPECT_EQ(MappedFile(folder_ / "a.txt").text(), "short");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, LeavesTheOldFileWhenWritingFails) {
    fs::create_directory(folder_ / "taken");
    write_file(folder_ / "taken" / "inside", std::string_view("x"));
    EXPECT_THROW(write_file(folder_ / "taken", std::string_view("y")), FileError);
    EXPECT_THROW(write_file(folder_ / "missing" / "a.txt", std::string_view("y")), FileError);
    EXPECT_EQ(MappedFile(folder_ / "taken" / "inside").text(), "x");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, TellsBeforehandWhetherItCanWrite) {
    EXPECT_NO_THROW(check_writable(folder_ / "new.png"));
    EXPECT_THROW(check_writable(folder_), FileError);
    EXPECT_THROW(check_writable(folder_ / "missing" / "a.png"), FileError);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(File, MapsOnlyRegularFiles) {
    write_file(folder_ / "empty", std::string_view());
    EXPECT_EQ(MappedFile(folder_ / "empty").size(), 0u);
    EXPECT_THROW(MappedFile(folder_ / "missing"), FileError);
    EXPECT_THROW(MappedFile{folder_}, FileError);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    // A reader of a pipe without writer would wait for ever; the other end is held open.
    std::fstream other_end(folder_ / "pipe");
    EXPECT_THROW(MappedFile(folder_ / "pipe"), FileError);
}

TEST_F(File, KnowsExtensions) {
    EXPECT_EQ(extension_of("a/b.c/Drone.PLY"), "ply");
    EXPECT_EQ(extension_of("a/b.c/drone"), "");
}

TEST_F(Cache, GivesBackWhatWasStored) {
    EXPECT_FALSE(cache_load("key"));
    cache_store("key", bytes_of("content"));
    EXPECT_EQ(cache_load("key"), bytes_of("content"));
    cache_store("key", {});
    EXPECT_EQ(cache_load("key"), std::vector<std::byte>());
}

TEST_F(Cache, ForgetsADamagedBlob) {
    cache_store("key", bytes_of("content"));
    const fs::path blob = cache_folder() / "key";
    std::string text(MappedFile(blob).text());
    text.back() ^= 1;
    write_file(blob, std::string_view(text));
    EXPECT_FALSE(cache_load("key"));
    write_file(blob, std::string_view("cut"));
    EXPECT_FALSE(cache_load("key"));
}

TEST_F(Cache, DoesWithoutAFolder) {
    write_file(folder_ / "cache", std::string_view("a file where the folder should be"));
    EXPECT_NO_THROW(cache_store("key", bytes_of("content")));
    EXPECT_FALSE(cache_load("key"));
}

// XXH3-128 of nothing with seed 0, from the reference implementation's published test vectors.
TEST(Hash, IsXxh3) {
    EXPECT_EQ(content_hash({}), "99aa06d3014798d86001c324468d497f");
    EXPECT_NE(content_hash(bytes_of("a")), content_hash(bytes_of("b")));
    const uint64_t first = next_revision();
    EXPECT_GT(next_revision(), first);
}

TEST(Suggest, FindsTheNearestName) {
    const std::vector<std::string> names = {"roughness", "metallic", "size"};
    EXPECT_EQ(did_you_mean("rougness", names), " (did you mean 'roughness'?)");
    EXPECT_EQ(nearest("metalic", names), "metallic");
    EXPECT_EQ(did_you_mean("banana", names), "");
    EXPECT_EQ(did_you_mean("size", {}), "");
}

TEST(Parallel, VisitsEveryIndexOnceInFixedChunks) {
    std::vector<int> visits(100001);
    parallel_chunks(visits.size(), 1000, [&](size_t begin, size_t end) {
        EXPECT_EQ(begin % 1000, 0u);
        EXPECT_EQ(end, std::min(begin + 1000, visits.size()));
        for (size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ptrdiff_t(visits.size()));
    EXPECT_THROW(parallel_for(100000, 10,
                              [](size_t i) {
                                  if (i == 77777) throw ArgumentError("passed on");
                              }),
                 ArgumentError);
}
