#include "easypbr/core/recent_values.h"

#include <gtest/gtest.h>

#include <limits>

namespace easypbr::recent_values_test {
namespace {

/// Counts what has to be made.
struct Squares {
    RecentValues<double, double> known{3};
    int made = 0;

    double get(double key) {
        return known.get(key, [&] {
            ++made;
            return key * key;
        });
    }
};

TEST(RecentValues, KeepTheLastOnes) {
    Squares squares;
    for (const double key : {1, 2, 3, 1, 2, 3}) EXPECT_EQ(squares.get(key), key * key);
    EXPECT_EQ(squares.made, 3);
    squares.get(1);
    squares.get(4);  // 2 is the one that was not asked for since.
    squares.get(1);
    squares.get(3);
    EXPECT_EQ(squares.made, 4);
    EXPECT_EQ(squares.get(2), 4);
    EXPECT_EQ(squares.made, 5);
}

TEST(RecentValues, TakeNoRoomForWhatEqualsNothing) {
    Squares squares;
    squares.get(1);
    for (int i = 0; i < 5; ++i) squares.get(std::numeric_limits<double>::quiet_NaN());
    squares.get(1);
    EXPECT_EQ(squares.made, 6);
}

}  // namespace
}  // namespace easypbr::recent_values_test
