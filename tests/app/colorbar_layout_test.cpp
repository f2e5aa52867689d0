// Where the ticks of a logarithmic colour bar stand, and how bars and legends get into narrow pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "easypbr/app/annotation.h"

namespace easypbr::app::colorbar_layout_test {
namespace {

using Texts = std::vector<std::string>;

Texts log_texts(float min, float max, int most) {
    Texts all;
    for (const Tick& tick : ticks_of(ValueRange{min, max, min, max, ColorScale::log}, most))
        all.push_back(tick.text);
    return all;
}

}  // namespace

TEST(LogTicks, AreOneTwoAndFiveTimesPowersOfTen) {
    EXPECT_EQ(log_texts(1.01f, 99, 5), (Texts{"2", "5", "10", "20", "50"}));
    EXPECT_EQ(log_texts(0.11f, 9.9f, 5), (Texts{"0.2", "0.5", "1", "2", "5"}));
    EXPECT_EQ(log_texts(1.5f, 95, 6), (Texts{"2", "5", "10", "20", "50"}));
    // The ends as float32 holds them.
    EXPECT_EQ(log_texts(0.1f, 1, 4), (Texts{"0.1", "0.2", "0.5", "1"}));
    EXPECT_EQ(log_texts(2e-8f, 1e-7f, 4), (Texts{"2e-8", "5e-8", "1e-7"}));
}

// Each second or third of them, the last one always, or every n-th power of ten.
TEST(LogTicks, AreThinnedWhereThereIsNoRoom) {
    EXPECT_EQ(log_texts(1.01f, 99, 4), (Texts{"2", "10", "50"}));
    EXPECT_EQ(log_texts(1.01f, 99, 2), (Texts{"5", "50"}));
    EXPECT_EQ(log_texts(0.9f, 110, 3), (Texts{"1", "10", "100"}));
    EXPECT_EQ(log_texts(1, 1e6f, 4), (Texts{"1e0", "1e2", "1e4", "1e6"}));
}

TEST(LogTicks, AreThoseOfALinearScaleWithinPartOfADecade) {
    EXPECT_EQ(log_texts(1.2f, 1.9f, 4), (Texts{"1.2", "1.4", "1.6", "1.8"}));
    EXPECT_EQ(log_texts(2.5f, 4.5f, 4), (Texts{"3", "4"}));
}

// A bar holds two rows of text for each of the `most` ticks; texts on less than 0.6 rows of their own touch.
TEST(LogTicks, DoNotTouch) {
    for (const float min : {0.003f, 0.7f, 1.0f, 1.01f, 4.0f, 8.9f})
        for (const float decades : {0.05f, 0.3f, 0.6f, 0.99f, 1.2f, 1.99f, 2.5f, 7.0f})
            for (const int most : {2, 3, 5, 8}) {
                const float max = min * std::pow(10.0f, decades);
                const ValueRange range{min, max, min, max, ColorScale::log};
                const std::vector<Tick> ticks = ticks_of(range, most);
                EXPECT_GE(ticks.size(), 1u) << min << " " << max;
                EXPECT_LE(int(ticks.size()), most) << min << " " << max;
                for (size_t i = 1; i < ticks.size(); ++i)
                    EXPECT_GE(
                        (place_on_scale(ticks[i].value, range) - place_on_scale(ticks[i - 1].value, range)) *
                            2 * most,
                        0.6)
                        << min << " to " << max << ", " << most;
            }
}

}  // namespace easypbr::app::colorbar_layout_test
