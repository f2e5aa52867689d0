#include "easypbr/core/memory_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

namespace easypbr::memory_pool_test {
namespace {

constexpr size_t mib = size_t(1) << 20;

TEST(MemoryPool, GivesTheSameMemoryAgain) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "nothing is kept from the sanitizer";
#endif
    void* first = take_pooled(5 * mib);
    give_pooled(first, 5 * mib);
    void* second = take_pooled(5 * mib - 1000);  // a step of sizes is a quarter of a power of two
    EXPECT_EQ(second, first);
    void* third = take_pooled(5 * mib);
    EXPECT_NE(third, first);
    give_pooled(second, 5 * mib - 1000);
    give_pooled(third, 5 * mib);
}

// What passes of a frame take after each other: the second frame finds all of it.
TEST(MemoryPool, GivesLargerMemoryAgain) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "nothing is kept from the sanitizer";
#endif
    const size_t given = pooled_memory().given;
    void* first = take_pooled(160 * mib);
    give_pooled(first, 160 * mib);
    void* half = take_pooled(80 * mib);
    EXPECT_EQ(half, first);
    EXPECT_EQ(pooled_memory().given, given + 160 * mib);
    give_pooled(half, 80 * mib);
    EXPECT_EQ(pooled_memory().given, given);
    void* less = take_pooled(64 * mib);
    EXPECT_EQ(pooled_memory().given, given + 64 * mib);
    give_pooled(less, 64 * mib);
    EXPECT_EQ(pooled_memory().given, given);
}

// As much as no test has taken before, and then less than a half.
TEST(MemoryPool, NeverHasMoreThanWasGivenAtOnce) {
    const size_t given = pooled_memory().given, most = given + pooled_memory().kept;
    void* large = take_pooled(192 * mib);
    const size_t at_once = std::max(most, pooled_memory().given);
    give_pooled(large, 192 * mib);
    void* other = take_pooled(80 * mib);
    EXPECT_EQ(pooled_memory().given, given + 80 * mib);
    EXPECT_LE(pooled_memory().given + pooled_memory().kept, at_once);
    give_pooled(other, 80 * mib);
    EXPECT_EQ(pooled_memory().given, given);
    EXPECT_LE(pooled_memory().given + pooled_memory().kept, at_once);
}

TEST(MemoryPool, KeepsLittle) {
    void* large = take_pooled(2 * PooledMemory::most_kept);
    give_pooled(large, 2 * PooledMemory::most_kept);
    EXPECT_LE(pooled_memory().kept, PooledMemory::most_kept);
}

TEST(MemoryPool, ThrowsWhereThereIsNone) {
    const PooledMemory before = pooled_memory();
    EXPECT_THROW(static_cast<void>(take_pooled(SIZE_MAX)), std::bad_alloc);
    EXPECT_THROW(static_cast<void>(take_pooled(SIZE_MAX / 4)), std::bad_alloc);
    EXPECT_THROW(static_cast<void>(PooledVector<double>().get_allocator().allocate(SIZE_MAX / 4)),
                 std::bad_alloc);
    EXPECT_EQ(pooled_memory().given, before.given);
}

TEST(MemoryPool, ArraysHaveTheValuesThatTheyAreGiven) {
    PooledVector<double> values(mib, 3.0);
    EXPECT_EQ(values.front(), 3);
    values.assign(2 * mib, 5.0);
    EXPECT_EQ(values.back(), 5);
    values.resize(3 * mib, 7.0);
    EXPECT_EQ(values[2 * mib - 1], 5);
    EXPECT_EQ(values.back(), 7);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(values.data()) % 64, 0u);
}

TEST(MemoryPool, ServesManyThreads) {
    const size_t given = pooled_memory().given;
    std::vector<std::thread> threads;
    std::atomic<int> wrong = 0;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([i, &wrong] {
            for (int turn = 0; turn < 200; ++turn) {
                PooledVector<int> mine(mib / 4 + size_t(turn % 3) * mib / 8, i);
                wrong += mine.front() != i || mine.back() != i;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(pooled_memory().given, given);
}

}  // namespace
}  // namespace easypbr::memory_pool_test
