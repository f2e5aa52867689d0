// The cache folder, and the hashes that its keys are made of.
#include "easypbr/core/cache.h"

#include <gtest/gtest.h>
#include <pwd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/hash.h"
#include "io/temporary_folder.h"

namespace easypbr::cache_test {
namespace {

/// A cache in a new folder for every test, gone afterwards.
class Cache : public testing::Test {
  protected:
    Cache() { setenv("EASYPBR_CACHE_DIR", (folder_ / "cache").c_str(), 1); }
    ~Cache() override { unsetenv("EASYPBR_CACHE_DIR"); }

    const TemporaryFolder folder_;
};

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
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
    std::string text(FileBytes(blob).text());
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

/// The key of a test's blob, as of any: a word and a hash.
std::string key_of(int number) {
    return "test1-" + content_hash(bytes_of(std::to_string(number)));
}

/// Blobs that were used one after the other: 1032 bytes each, 32 of them the hash.
void store_blobs(int count) {
    for (int i = 0; i < count; ++i) {
        cache_store(key_of(i), bytes_of(std::string(1000, 'x')));
        fs::last_write_time(cache_folder() / key_of(i),
                            fs::file_time_type::clock::now() - std::chrono::minutes(count - i));
    }
}

TEST_F(Cache, DropsWhatWasNotUsedForTheLongest) {
    store_blobs(4);
    EXPECT_EQ(cache_use().entries, 4u);
    EXPECT_EQ(cache_use().bytes, 4 * 1032u);
    EXPECT_TRUE(cache_load(key_of(0)));
    const CacheUse left = trim_cache(2 * 1032);
    EXPECT_EQ(left.entries, 2u);
    EXPECT_EQ(left.bytes, 2 * 1032u);
    // 1 and 2 are the oldest now.
    for (const int i : {0, 3}) EXPECT_TRUE(cache_load(key_of(i))) << i;
    for (const int i : {1, 2}) EXPECT_FALSE(cache_load(key_of(i))) << i;
    EXPECT_EQ(trim_cache(0).entries, 0u);
    EXPECT_TRUE(fs::is_empty(cache_folder()));
}

TEST_F(Cache, StaysWithinItsLimit) {
    EXPECT_EQ(cache_limit(), 1'000'000'000u);
    store_blobs(3);
    setenv("EASYPBR_CACHE_LIMIT", "0.0000025", 1);
    EXPECT_EQ(cache_limit(), 2500u);
    cache_store(key_of(3), bytes_of(std::string(1000, 'x')));
    EXPECT_EQ(cache_use().bytes, 2 * 1032u);
    EXPECT_TRUE(cache_load(key_of(2)) && cache_load(key_of(3)));
    // What is larger than all room drops nothing else.
    cache_store(key_of(4), bytes_of(std::string(3000, 'x')));
    EXPECT_EQ(cache_use().entries, 2u);
    setenv("EASYPBR_CACHE_LIMIT", "0", 1);
    cache_store(key_of(5), {});
    EXPECT_FALSE(cache_load(key_of(5)));
    setenv("EASYPBR_CACHE_LIMIT", "", 1);
    EXPECT_EQ(cache_limit(), 1'000'000'000u);
    unsetenv("EASYPBR_CACHE_LIMIT");
}

TEST_F(Cache, RefusesALimitThatIsNoNumber) {
    store_blobs(1);
    for (const char* wrong : {"-1", "1GB", "nan", "abc"}) {
        setenv("EASYPBR_CACHE_LIMIT", wrong, 1);
        EXPECT_THROW(cache_limit(), ArgumentError) << wrong;
        // Before the work whose result would be kept.
        EXPECT_THROW(cache_load(key_of(0)), ArgumentError) << wrong;
        EXPECT_NO_THROW(cache_store(key_of(1), {})) << wrong;
    }
    unsetenv("EASYPBR_CACHE_LIMIT");
    EXPECT_TRUE(cache_load(key_of(0)));
}

// The folder may be one that holds other things.
TEST_F(Cache, LeavesFilesOfOthersAlone) {
    store_blobs(1);
    const std::string text = "d41d8cd98f00b204e9800998ecf8427e  sums.txt";
    const fs::path folder = cache_folder();
    for (const std::string& name :
         {std::string("sums.txt"), std::string(".hidden.tmp"), "a-" + std::string(32, 'g')})
        write_file(folder / name, std::string_view(text));
    write_file(folder / ("photo-" + std::string(32, 'a')),
               std::string_view("not a hash, but more than 32 bytes long"));
    fs::create_directory(folder / key_of(7));
    fs::create_symlink(folder / "sums.txt", folder / key_of(8));
    // A killed process leaves a part of a blob; another one may be writing.
    const std::string old = ".easypbr.123.0.tmp", young = ".easypbr.124.0.tmp";
    for (const std::string& name : {old, young}) write_file(folder / name, std::string_view("part"));
    fs::last_write_time(folder / old, fs::file_time_type::clock::now() - std::chrono::hours(2));
    EXPECT_EQ(cache_use().entries, 1u);
    EXPECT_EQ(trim_cache(0).entries, 0u);
    EXPECT_FALSE(fs::exists(folder / old));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 7);
}

TEST_F(Cache, IsSharedByProcesses) {
    setenv("EASYPBR_CACHE_LIMIT", "0.00001", 1);
    std::vector<pid_t> children;
    for (int child = 0; child < 4; ++child) {
        children.push_back(fork());
        if (children.back() != 0) continue;
        bool right = true;
        for (int i = 0; i < 300; ++i) {
            const auto blob = bytes_of(std::string(1000, char('a' + i % 20)));
            cache_store(key_of(i % 20), blob);
            // Another process may have dropped it; it is never another's or half of one.
            const auto back = cache_load(key_of(i % 20));
            right &= !back || *back == blob;
        }
        _exit(right ? 0 : 1);
    }
    for (const pid_t child : children) {
        int status = -1;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    }
    EXPECT_LE(cache_use().bytes, 10'000u);
    EXPECT_EQ(trim_cache(0).entries, 0u);
    EXPECT_TRUE(fs::is_empty(cache_folder()));
    unsetenv("EASYPBR_CACHE_LIMIT");
}

/// Sets a variable of the environment, or unsets it (null), as long as it lives.
class Variable {
  public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        set(value);
    }
    ~Variable() { set(old_ ? old_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    void set(const char* value) const { value ? setenv(name_, value, 1) : unsetenv(name_); }
    const char* name_;
    std::optional<std::string> old_;
};

TEST_F(Cache, FollowsNoLinks) {
    write_file(folder_ / "victim", std::string_view("precious"));
    fs::create_directory(cache_folder());
    fs::create_symlink(folder_ / "victim", cache_folder() / key_of(0));
    cache_store(key_of(0), bytes_of("content"));
    EXPECT_EQ(FileBytes(folder_ / "victim").text(), "precious");
    EXPECT_EQ(cache_load(key_of(0)), bytes_of("content"));
    EXPECT_FALSE(fs::is_symlink(cache_folder() / key_of(0)));
    // Nor is a good entry read through one.
    fs::rename(cache_folder() / key_of(0), folder_ / "moved");
    fs::create_symlink(folder_ / "moved", cache_folder() / key_of(0));
    EXPECT_FALSE(cache_load(key_of(0)));
}

TEST_F(Cache, KnowsWhichKeyAnEntryIsOf) {
    for (const int i : {0, 1}) cache_store(key_of(i), bytes_of("content " + std::to_string(i)));
    const fs::path a = cache_folder() / key_of(0), b = cache_folder() / key_of(1), other = folder_ / "other";
    fs::rename(a, other);
    fs::rename(b, a);
    fs::rename(other, b);
    for (const int i : {0, 1}) EXPECT_FALSE(cache_load(key_of(i))) << i;
}

TEST_F(Cache, IsOfNoOtherUser) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
    constexpr uid_t another = 65534;
    const Variable not_chosen("EASYPBR_CACHE_DIR", nullptr),
        its_own("XDG_CACHE_HOME", folder_.path().c_str());
    ASSERT_EQ(cache_folder(), folder_ / "easypbr");
    cache_store(key_of(0), bytes_of("content"));
    cache_store(key_of(1), bytes_of("content"));
    EXPECT_EQ(fs::status(cache_folder()).permissions(), fs::perms::owner_all);
    ASSERT_EQ(::chown((cache_folder() / key_of(1)).c_str(), another, gid_t(-1)), 0);
    EXPECT_TRUE(cache_load(key_of(0)));
    EXPECT_FALSE(cache_load(key_of(1)));
    EXPECT_EQ(cache_problem(), "");

    ASSERT_EQ(::chown(cache_folder().c_str(), another, gid_t(-1)), 0);
    EXPECT_EQ(cache_problem(), "it belongs to another user");
    EXPECT_FALSE(cache_load(key_of(0)));
    cache_store(key_of(2), bytes_of("content"));
    EXPECT_FALSE(fs::exists(cache_folder() / key_of(2)));
    EXPECT_EQ(cache_use().entries, 0u);
    // Who names the folder shares it on purpose.
    const Variable chosen("EASYPBR_CACHE_DIR", (folder_ / "easypbr").c_str());
    for (const int i : {0, 1}) EXPECT_TRUE(cache_load(key_of(i))) << i;
}

TEST_F(Cache, IsInTheHomeOfAUserWhoseEnvironmentNamesNone) {
    const Variable not_chosen("EASYPBR_CACHE_DIR", nullptr), none("XDG_CACHE_HOME", nullptr),
        homeless("HOME", nullptr);
    const passwd* const user = ::getpwuid(::geteuid());
    EXPECT_EQ(cache_folder(), user ? fs::path(user->pw_dir) / ".cache" / "easypbr" : fs::path());
}

// XXH3-128 of nothing with seed 0, from the reference implementation's published test vectors.
TEST(Hash, IsXxh3) {
    EXPECT_EQ(content_hash({}), "99aa06d3014798d86001c324468d497f");
    EXPECT_NE(content_hash(bytes_of("a")), content_hash(bytes_of("b")));
    const uint64_t first = next_revision();
    EXPECT_GT(next_revision(), first);
}

}  // namespace
}  // namespace easypbr::cache_test
