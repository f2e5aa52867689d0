#include "easypbr/dataset/rle.h"

#include <gtest/gtest.h>

#include <random>

#include "easypbr/core/error.h"

namespace easypbr::dataset::rle_test {
namespace {

// Value of cocoapi's maskApi.c for a 5 x 7 mask whose rows 1-3, columns 2-4 are set.
TEST(Rle, IsCocos) {
    std::vector<uint8_t> mask(5 * 7);
    for (size_t y = 1; y <= 3; ++y)
        for (size_t x = 2; x <= 4; ++x) mask[y * 7 + x] = 1;
    const std::vector<uint32_t> counts = rle_counts(mask, 7, 5);
    EXPECT_EQ(counts, (std::vector<uint32_t>{11, 3, 2, 3, 2, 3, 11}));
    EXPECT_EQ(rle_string(counts), ";320009");
}

// Long runs, masks that begin with 1, empty and full ones come back as they were.
TEST(Rle, RoundTrips) {
    std::mt19937 random(3);
    for (const double density : {0.0, 0.001, 0.5, 0.999, 1.0}) {
        std::vector<uint8_t> mask(301 * 207);
        for (uint8_t& pixel : mask) pixel = std::uniform_real_distribution<>(0, 1)(random) < density;
        const auto counts = rle_counts(mask, 301, 207);
        EXPECT_EQ(rle_parse(rle_string(counts)), counts);
        EXPECT_EQ(rle_mask(counts, 301, 207), mask);
    }
}

TEST(Rle, RefusesWhatIsNone) {
    EXPECT_THROW(rle_parse("\x01"), FormatError);
    EXPECT_THROW(rle_parse("n"), FormatError);  // A group that promises another one.
    EXPECT_THROW(rle_mask(std::vector<uint32_t>{3, 4}, 3, 3), FormatError);
}

}  // namespace
}  // namespace easypbr::dataset::rle_test
