// Where the ticks of a colour bar are, and what they say.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "easypbr/app/annotation.h"

namespace easypbr::app::ticks_test {

namespace {

std::vector<std::string> texts(double min, double max, int most) {
    std::vector<std::string> result;
    for (const Tick& tick : ticks_of(min, max, most)) result.push_back(tick.text);
    return result;
}

}  // namespace

TEST(Ticks, AreRound) {
    using Texts = std::vector<std::string>;
    EXPECT_EQ(texts(0, 1, 6), (Texts{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
    EXPECT_EQ(texts(-1, 2, 5), (Texts{"\u22121", "0", "1", "2"}));
    EXPECT_EQ(texts(312.4, 347.1, 4), (Texts{"320", "330", "340"}));
    EXPECT_EQ(texts(0, 5e6, 6), (Texts{"0", "1e6", "2e6", "3e6", "4e6", "5e6"}));
    EXPECT_EQ(texts(0, 2e-5, 5), (Texts{"0", "5.0e-6", "1.0e-5", "1.5e-5", "2.0e-5"}));
    EXPECT_EQ(texts(-2e6, 1e6, 4), (Texts{"\u22122e6", "\u22121e6", "0", "1e6"}));
    EXPECT_EQ(texts(1000.0001, 1000.0004, 4), (Texts{"1000.0001", "1000.0002", "1000.0003", "1000.0004"}));
    // Ends as float32 holds them: 1e-4 and 1e38 are less there.
    EXPECT_EQ(texts(0, double(1e-4f), 3), (Texts{"0", "5e-5", "1e-4"}));
    EXPECT_EQ(texts(0, double(1e38f), 2), (Texts{"0", "1e38"}));
    EXPECT_EQ(texts(0.3, 0.4, 1).size(), 1u);
    // Of the distance 5 there is none; 2 and 4 of the next one, 2, of which 4 is the last.
    EXPECT_EQ(texts(0.5, 4.52, 2), (Texts{"2", "4"}));
    EXPECT_EQ(texts(0.5, 4.52, 1), (Texts{"4"}));
    // 1.05 is the only multiple of 0.05; of the four of 0.02 there may be two.
    EXPECT_EQ(texts(1.01, 1.09, 2), (Texts{"1.02", "1.08"}));
}

// A mantissa from 1 to 10, of as many digits as the tick that needs the most: 1.5e-6 needs two, 1e7 one.
TEST(Ticks, HaveOneFormat) {
    using Texts = std::vector<std::string>;
    EXPECT_EQ(texts(0, 1e7, 3), (Texts{"0", "5e6", "1e7"}));
    EXPECT_EQ(texts(-1e7, 1e7, 5), (Texts{"\u22121e7", "\u22125e6", "0", "5e6", "1e7"}));
    EXPECT_EQ(texts(1e-6, 3e-6, 5), (Texts{"1.0e-6", "1.5e-6", "2.0e-6", "2.5e-6", "3.0e-6"}));
    EXPECT_EQ(texts(8e6, 1.2e7, 5), (Texts{"8.0e6", "9.0e6", "1.0e7", "1.1e7", "1.2e7"}));
    EXPECT_EQ(texts(12345678, 12345682, 3), (Texts{"1.2345678e7", "1.2345680e7", "1.2345682e7"}));
    EXPECT_EQ(texts(-0.3, 0.7, 2), (Texts{"0.0", "0.5"}));
    EXPECT_EQ(texts(-1e-9, 1e-9, 3), (Texts{"\u22121e-9", "0", "1e-9"}));
}

TEST(Ticks, AreInTheRangeAndNotTooMany) {
    for (double min : {-1e37, -3.7, 0.0, 1e-30, 12.0})
        for (double span : {1e-6, 0.7, 33.0, 1e9, 1e38}) {
            const double max = min + span * (1 + std::abs(min) * 1e-3);
            if (!(max > min)) continue;
            for (int most : {2, 3, 7}) {
                const auto ticks = ticks_of(min, max, most);
                EXPECT_LE(int(ticks.size()), most);
                EXPECT_GE(int(ticks.size()), 2) << min << " " << max;
                for (const Tick& tick : ticks) {
                    EXPECT_GE(tick.value, min - 1e-5 * (max - min));
                    EXPECT_LE(tick.value, max + 1e-5 * (max - min));
                }
            }
        }
}

TEST(Ticks, OfALogarithmicScaleArePowersOfTen) {
    const auto texts = [](float min, float max, int most) {
        std::vector<std::string> all;
        for (const Tick& tick : ticks_of(ValueRange{min, max, min, max, ColorScale::log}, most))
            all.push_back(tick.text);
        return all;
    };
    using Texts = std::vector<std::string>;
    EXPECT_EQ(texts(0.01f, 100, 8), (Texts{"0.01", "0.1", "1", "10", "100"}));
    EXPECT_EQ(texts(0.02f, 99, 8), (Texts{"0.1", "1", "10"}));
    EXPECT_EQ(texts(1e-8f, 1e-5f, 8), (Texts{"1e-8", "1e-7", "1e-6", "1e-5"}));
    EXPECT_EQ(texts(1, 1e6f, 4), (Texts{"1e0", "1e2", "1e4", "1e6"}));
    // Without two powers: those of a linear scale.
    EXPECT_EQ(texts(2, 8, 4), (Texts{"2", "4", "6", "8"}));
}

}  // namespace easypbr::app::ticks_test
