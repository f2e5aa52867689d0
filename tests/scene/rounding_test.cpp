#include "easypbr/scene/rounding.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/scene/mesh.h"

namespace easypbr::rounding_test {

namespace {

bool are_lost(const std::vector<double>& values) {
    return rounding_of(values).are_lost();
}

/// `count` numbers from `first` on, this far apart.
std::vector<double> steps(double first, double step, int count = 1000) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(first + i * step);
    return values;
}

}  // namespace

TEST(Rounding, TellsWhereNumbersBecomeEqual) {
    // Numbers of float32 are 128 apart at 1.7e9: all of a minute are one.
    EXPECT_TRUE(are_lost(steps(1.7e9, 0.06)));
    // 0.5 s apart over an hour.
    EXPECT_TRUE(are_lost(steps(1.7e9, 0.5, 7200)));
    // Two fifths of a spacing apart, 4096 = 2^12: 2^-11.
    EXPECT_TRUE(are_lost(steps(4096, 0.4 / 2048)));
}

TEST(Rounding, TellsWhereWholeNumbersAreOthers) {
    EXPECT_TRUE(are_lost({123456789, 5, 123456791}));
    EXPECT_EQ(rounding_of(std::vector<double>{5, 123456789}).text(), "holds 123456789 as 123456792");
    EXPECT_EQ(rounding_of(std::vector<double>{123456789, 123456791}).text(),
              "holds 123456789 and 123456791 as one number");
    // 2^24 is the last below which none is missing.
    EXPECT_FALSE(are_lost({16777215, 16777216}));
    EXPECT_TRUE(are_lost({16777217}));
}

/// What becomes of whole numbers of 64 bits.
template <class Integer>
RoundingCounts counts_of(const std::vector<Integer>& values) {
    RoundingCounts counts;
    for (const Integer value : values) counts.add(value);
    return counts;
}

TEST(Rounding, OfIntegersIsSeenBeyondDoublePrecision) {
    // 10^18 lies within 2^59 and 2^60, where numbers of double precision are 2^7 = 128 apart, of float32
    // 2^36.
    const int64_t id = 1'000'000'000'000'000'000;
    const RoundingCounts ids = counts_of<int64_t>({id, id + 1, id + 2});
    EXPECT_TRUE(ids.are_lost());
    EXPECT_EQ(ids.text(), "holds 1000000000000000000 and 1000000000000000001 as one number");
    EXPECT_EQ(counts_of<int64_t>({-id, -id - 1}).text(),
              "holds -1000000000000000000 and -1000000000000000001 as one number");
    const RoundingCounts largest = counts_of<uint64_t>({UINT64_MAX - 1, UINT64_MAX});
    EXPECT_TRUE(largest.are_lost());
    EXPECT_EQ(largest.text(), "holds 18446744073709551614 and 18446744073709551615 as one number");
    // 2^60 + 2^37 has 24 bits.
    const int64_t apart = int64_t(1) << 60, step = int64_t(1) << 37;
    EXPECT_FALSE(counts_of<int64_t>({apart, apart + step, -apart, 5, -5, INT64_MIN}).are_lost());
    EXPECT_FALSE(counts_of<uint64_t>({uint64_t(1) << 63, 7}).are_lost());
    EXPECT_EQ(counts_of<int64_t>({5, 123456789}).text(), "holds 123456789 as 123456792");
    EXPECT_TRUE(counts_of<int32_t>({123456789, 5, 123456791}).are_lost());
}

TEST(Rounding, IsOfNoMatterElsewhere) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(are_lost({}));
    EXPECT_FALSE(are_lost({nan, nan}));
    // Digits that float32 has not, of numbers that it tells apart.
    EXPECT_FALSE(are_lost({0.1, 0.2, nan, 0.3}));
    // Neighbours become equal, but an offset would not keep them apart: they reach from zero on.
    EXPECT_FALSE(are_lost(steps(0, 1e-9, 100)));
    EXPECT_FALSE(are_lost(steps(0, 0x1p-27, 1 << 20)));
    EXPECT_FALSE(are_lost({1e20, 1e20, 1e20}));
}

TEST(Rounding, IsTheSameInPieces) {
    RoundingCounts whole, first, second;
    for (const double value : {1.7e9, 1.7e9 + 0.5, 1.7e9 + 1}) first.add(value), whole.add(value);
    for (const double value : {1.7e9 + 2, 1.7e9 + 2.5}) second.add(value), whole.add(value);
    first.add(second);
    EXPECT_TRUE(first.are_lost());
    EXPECT_EQ(first.text(), whole.text());
    EXPECT_EQ(first.text(), "holds 1700000000 and 1700000000.5 as one number");
}

TEST(Rounding, OfDoublesOfAProgramIsAWarning) {
    std::vector<std::string> warnings;
    set_log_sink([&](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    Mesh mesh;
    mesh.set_V(Array3f::Dense::Zero(2, 3));
    mesh.add_scalar("stamp", Eigen::VectorXd{{1.7e9, 1.7e9 + 0.5}});
    mesh.add_scalar("heat", Eigen::VectorXd{{0.1, 0.2}});
    mesh.add_scalar("given", Array1f::Dense{{1.7e9f, 1.7e9f}});
    set_log_sink({});
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("'stamp'"), std::string::npos) << warnings[0];
    EXPECT_EQ(mesh.scalar("heat"), Array1f::Dense({{0.1f, 0.2f}}));
}

}  // namespace easypbr::rounding_test
