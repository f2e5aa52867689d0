// Pixels that are read while others are drawn.
#include "easypbr/gl/readback.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/gl/context.h"

namespace easypbr::gl::readback_test {
namespace {

class Readbacks : public testing::Test {
  protected:
    void fill(float red) {
        const float color[4] = {red, 0, 0, 1};
        framebuffer_.clear_color(0, color);
    }
    /// The red of all pixels, -1 where they differ.
    int red(Readback& readback, int pixels) {
        std::vector<std::byte> bytes(size_t(pixels) * 4);
        readback.finish(bytes);
        for (int i = 1; i < pixels; ++i)
            if (bytes[size_t(i) * 4] != bytes[0]) return -1;
        return int(bytes[0]);
    }
    void begin(Readback& readback) { readback.begin(framebuffer_, 0, Format::rgba8, 0, 0, 5, 3); }

    std::unique_ptr<Context> context_ = Context::create();
    ContextScope scope_{*context_};
    Texture texture_{Format::rgba8, 5, 3};
    Framebuffer framebuffer_{&texture_};
};

TEST_F(Readbacks, HaveWhatWasThereWhenTheyBegan) {
    Readback first, second;
    fill(1.0f);
    begin(first);
    fill(0.4f);  // 0.4 * 255 = 102
    begin(second);
    fill(0);
    EXPECT_TRUE(first.is_pending());
    EXPECT_EQ(red(second, 15), 102);
    EXPECT_EQ(red(first, 15), 255);
    EXPECT_FALSE(first.is_pending());
    EXPECT_FALSE(first.is_done());
}

TEST_F(Readbacks, AreDoneSoonAndUsedAgain) {
    Readback readback;
    for (const int value : {10, 200, 30}) {
        fill(float(value) / 255);
        begin(readback);
        // The driver has nothing else to do; a second of asking is more than it can take.
        for (int i = 0; i < 1000 && !readback.is_done(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_TRUE(readback.is_done());
        EXPECT_EQ(red(readback, 15), value);
    }
    fill(1);
    begin(readback);
    readback.begin(framebuffer_, 0, Format::rgba8, 1, 1, 2, 2);  // Another size, the first given up.
    EXPECT_EQ(red(readback, 4), 255);
}

TEST_F(Readbacks, RefuseBuffersThatDoNotFit) {
    Readback readback;
    std::vector<std::byte> bytes(60);
    EXPECT_THROW(readback.finish(bytes), ArgumentError);
    begin(readback);
    bytes.resize(59);
    EXPECT_THROW(readback.finish(bytes), ArgumentError);
    EXPECT_EQ(red(readback, 15), 0);
}

// Whoever holds them may let them die on a thread that has no context.
TEST_F(Readbacks, DieAnywhere) {
    auto readback = std::make_unique<Readback>();
    begin(*readback);
    std::thread([&] { readback.reset(); }).join();
    context_->deletions()->flush();
}

}  // namespace
}  // namespace easypbr::gl::readback_test
