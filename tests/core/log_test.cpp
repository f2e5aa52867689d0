#include "easypbr/core/log.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace easypbr::log_test {
namespace {

constexpr int heard = 7;

/// Made before main(), and so destroyed after what is made at the first call of log().
struct Late {
    bool speaks = false;
    ~Late() {
        if (speaks) log_warning("late");
    }
};
Late late;

// Other static objects log when the process ends, as a viewer may. What the sink holds must be there then.
TEST(Log, KeepsItsSinkUntilTheProcessEnds) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto end = [] {
        // Numbers that freed memory does not keep.
        const std::vector<int> kept(1000, heard);
        set_log_sink([kept](LogLevel, std::string_view text) {
            if (text == "late") std::_Exit(kept == std::vector<int>(1000, heard) ? heard : 1);
        });
        late.speaks = true;
        std::exit(0);
    };
    EXPECT_EXIT(end(), testing::ExitedWithCode(heard), "");
}

}  // namespace
}  // namespace easypbr::log_test
