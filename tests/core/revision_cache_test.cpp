#include "easypbr/core/revision_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <tuple>

namespace easypbr::revision_cache_test {
namespace {

/// Counts what is made. Values cannot be copied, as buffers of a device cannot.
struct Maker {
    int made = 0;
    auto of(int number) {
        return [this, number] {
            ++made;
            return std::make_unique<int>(number);
        };
    }
};

using Cache = RevisionCache<std::tuple<int, bool>, std::unique_ptr<int>>;

TEST(RevisionCache, MakesEachValueOnce) {
    Cache cache;
    Maker maker;
    int* const first = cache.get({1, false}, maker.of(10)).get();
    EXPECT_EQ(*cache.get({1, true}, maker.of(11)), 11);
    EXPECT_EQ(*first, 10);
    EXPECT_EQ(cache.get({1, false}, maker.of(12)).get(), first);
    EXPECT_EQ(maker.made, 2);
}

TEST(RevisionCache, DropsWhatWasNotAskedForSinceTheLastEviction) {
    Cache cache;
    Maker maker;
    cache.get({1, false}, maker.of(1));
    cache.get({2, false}, maker.of(2));
    cache.evict_unused();  // Both have just been asked for.
    EXPECT_EQ(*cache.get({1, false}, maker.of(3)), 1);
    EXPECT_EQ(maker.made, 2);
    cache.evict_unused();
    EXPECT_NE(cache.find({1, false}), nullptr);
    EXPECT_EQ(cache.find({2, false}), nullptr);
    EXPECT_EQ(*cache.get({2, false}, maker.of(4)), 4) << "made anew";
    cache.evict_unused();
    EXPECT_EQ(cache.find({1, false}), nullptr) << "find() is no use";
}

TEST(RevisionCache, ReferencesOutliveNewValuesAndEvictions) {
    RevisionCache<int, int> cache;
    const int& value = cache.get(0, [] { return 7; });
    for (int i = 1; i < 100; ++i) cache.get(i, [i] { return i; });
    cache.evict_unused();
    cache.get(0, [] { return 8; });
    cache.evict_unused();
    EXPECT_EQ(&cache.get(0, [] { return 9; }), &value);
    EXPECT_EQ(value, 7);
}

TEST(RevisionCache, KeepsNothingOfAValueThatCannotBeMade) {
    RevisionCache<int, int> cache;
    EXPECT_THROW(cache.get(1, []() -> int { throw std::runtime_error("no memory"); }), std::runtime_error);
    EXPECT_EQ(cache.find(1), nullptr);
    EXPECT_EQ(cache.get(1, [] { return 5; }), 5);
}

}  // namespace
}  // namespace easypbr::revision_cache_test
