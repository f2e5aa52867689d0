#include "easypbr/gpu/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "easypbr/gl/context.h"

namespace easypbr::gpu::radix_sort_test {
namespace {

struct Pairs {
    std::vector<uint32_t> keys, values;
};

Pairs sorted(const Pairs& pairs) {
    RadixSort sort;
    const gl::Buffer keys{std::as_bytes(std::span(pairs.keys))},
        values{std::as_bytes(std::span(pairs.values))};
    sort.run(keys, values, uint32_t(pairs.keys.size()));
    Pairs read = pairs;
    keys.read(0, std::as_writable_bytes(std::span(read.keys)));
    values.read(0, std::as_writable_bytes(std::span(read.values)));
    return read;
}

/// Around the sizes of groups and blocks. Of few different keys many are equal.
TEST(RadixSort, IsStable) {
    const auto context = gl::Context::create();
    const gl::ContextScope scope(*context);
    std::mt19937 random(1);
    for (const uint32_t most : {3u, 1000u, 0xffffffffu})
        for (const size_t count : {1u, 2u, 255u, 256u, 257u, 2047u, 2048u, 2049u, 70001u}) {
            Pairs pairs;
            for (size_t i = 0; i < count; ++i)
                pairs.keys.push_back(std::uniform_int_distribution<uint32_t>(0, most)(random));
            pairs.values.resize(count);
            std::iota(pairs.values.begin(), pairs.values.end(), 0u);
            const Pairs found = sorted(pairs);
            std::vector<uint32_t> expected = pairs.values;
            std::ranges::stable_sort(expected, {}, [&](uint32_t i) { return pairs.keys[i]; });
            EXPECT_EQ(found.values, expected) << most << " " << count;
            EXPECT_TRUE(std::ranges::is_sorted(found.keys)) << most << " " << count;
        }
}

TEST(RadixSort, TakesNothing) {
    const auto context = gl::Context::create();
    const gl::ContextScope scope(*context);
    RadixSort().run(gl::Buffer(4), gl::Buffer(4), 0);
}

}  // namespace
}  // namespace easypbr::gpu::radix_sort_test
