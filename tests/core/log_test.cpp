#include "easypbr/core/log.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "easypbr/io/source/source.h"

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

struct GivenUp {};

// Other threads have chunks of the file in hand when the sink throws, and finish them.
TEST(ProgressSink, HearsNoEndOfAFileAfterItThrew) {
    std::vector<double> parts;
    set_progress_sink([&](std::string_view, double part) {
        parts.push_back(part);
        throw GivenUp();
    });
    constexpr size_t half = 25'000'000;
    io::Progress progress(io::Source("", "large.ply"), 2 * half);
    std::this_thread::sleep_for(std::chrono::milliseconds(260));
    EXPECT_THROW(progress.advance(half), GivenUp);
    EXPECT_NO_THROW(progress.advance(half));
    set_progress_sink({});
    EXPECT_EQ(parts, std::vector<double>{0.5});
}

}  // namespace
}  // namespace easypbr::log_test
