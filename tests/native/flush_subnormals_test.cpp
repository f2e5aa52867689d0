#include "easypbr/native/flush_subnormals.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "easypbr/native/shaders.h"

namespace easypbr::flush_subnormals_test {
namespace {

/// A subnormal product, which compilers cannot know.
float tiny_product() {
    volatile float a = 2e-38f, b = 0.01f;
    return a * b;
}

TEST(FlushSubnormals, HoldsWhileItLives) {
    ASSERT_GT(tiny_product(), 0.0f);
    {
        const native::FlushSubnormals flush;
        EXPECT_EQ(tiny_product(), 0.0f);
        {
            const native::FlushSubnormals within;
            EXPECT_EQ(tiny_product(), 0.0f);
        }
        EXPECT_EQ(tiny_product(), 0.0f);
    }
    EXPECT_GT(tiny_product(), 0.0f);
}

TEST(FlushSubnormals, KernelsHaveNone) {
    constexpr int count = int(native::stream_alignment);
    const float rotation[3][3] = {{2e-38f, 0, 0}, {0, 2e-38f, 0}, {0, 0, 2e-38f}};
    const std::vector<float> u(count, 0.5f), cosines(count, 0.01f), sines(count, 1.0f);
    const std::string_view before = native::instruction_set();
    for (const std::string_view set : native::instruction_sets()) {
        native::use_instruction_set(set);
        std::vector<float> x(count, 1.0f), y = x, z = x;
        native::find_map_directions(rotation, u.data(), cosines.data(), sines.data(), count,
                                    {x.data(), y.data(), z.data()});
        EXPECT_EQ(y.front(), 0.0f) << set;
        EXPECT_EQ(z.front(), -2e-38f) << set;
        EXPECT_GT(tiny_product(), 0.0f) << set;
    }
    native::use_instruction_set(before);
}

}  // namespace
}  // namespace easypbr::flush_subnormals_test
