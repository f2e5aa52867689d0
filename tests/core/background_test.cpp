#include "easypbr/core/background.h"

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/parallel.h"

namespace easypbr::background_test {
namespace {

TEST(Background, MakesAValue) {
    const BackgroundValue<int> value([] { return 7; });
    BackgroundWork::wait_for_all();
    ASSERT_NE(value.get(), nullptr);
    EXPECT_EQ(*value.get(), 7);
}

TEST(Background, HasNoValueWhereMakingItFails) {
    const BackgroundValue<int> value([]() -> int { throw std::runtime_error("no"); });
    BackgroundWork::wait_for_all();
    EXPECT_EQ(value.get(), nullptr);
}

// Its work never ends by itself.
TEST(Background, IsInterruptedWhenItIsDropped) {
    if (thread_count() < 2) GTEST_SKIP() << "it is done at once";
    std::atomic<bool> begun = false, interrupted = false;
    std::optional<BackgroundWork> work(std::in_place, [&] {
        begun = true;
        try {
            for (;;) check_interrupt();
        } catch (const Interrupted&) {
            interrupted = true;
            throw;
        }
    });
    while (!begun) std::this_thread::yield();
    EXPECT_FALSE(interrupted);
    work.reset();
    EXPECT_TRUE(interrupted);
}

TEST(Background, KeepsWhatItUsesUntilItIsDropped) {
    auto used = std::make_shared<int>(3);
    {
        const BackgroundValue<int> value([used] { return *used; });
        BackgroundWork::wait_for_all();
        EXPECT_GE(used.use_count(), 2);
    }
    EXPECT_EQ(used.use_count(), 1);
}

}  // namespace
}  // namespace easypbr::background_test
