#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/gl/context.h"
#include "easypbr/gl/texture.h"

namespace easypbr::gl::framebuffer_test {
namespace {

class FramebufferTest : public testing::Test {
  protected:
    static std::array<uint8_t, 4> pixel_of(const Texture& texture) {
        std::array<uint8_t, 4> pixel{};
        Framebuffer({&texture}).read(0, Format::rgba8, 0, 0, 1, 1, std::as_writable_bytes(std::span(pixel)));
        return pixel;
    }

    const std::unique_ptr<Context> context_ = Context::create(DrawDevice::gl);
    const ContextScope scope_{*context_};
};

// GPUs' drivers give the name of a deleted texture to the next one; llvmpipe does not.
TEST_F(FramebufferTest, FollowsATextureThatGetsTheNameOfADeletedOne) {
    Framebuffer framebuffer;
    for (int i = 0; i < 20; ++i) {
        const Texture texture(Format::rgba8, 4, 4);
        framebuffer.attach({&texture});
        const float gray = float(i) / 255;
        framebuffer.clear_color(0, {gray, gray, gray, 1});
        EXPECT_EQ(pixel_of(texture)[0], i);
    }
}

TEST_F(FramebufferTest, IsMadeAgainForOtherTexturesAlone) {
    const Texture first(Format::rgba8, 4, 4), second(Format::rgba8, 4, 4), depth(Format::depth32f, 4, 4);
    Framebuffer framebuffer;
    const auto clear = [&](float value) { framebuffer.clear_color(0, {value, 0, 0, 1}); };
    framebuffer.attach({&first});
    clear(1);
    framebuffer.attach({&second});
    clear(0);
    EXPECT_EQ(pixel_of(first)[0], 255);
    EXPECT_EQ(pixel_of(second)[0], 0);
    framebuffer.attach({&second}, &depth);
    framebuffer.bind();
    framebuffer.clear_depth(0.5f);
    framebuffer.attach({&first}, &depth);
    clear(0);
    EXPECT_EQ(pixel_of(first)[0], 0);
}

TEST_F(FramebufferTest, SerialsAreNeverGivenAgain) {
    std::vector<uint64_t> serials;
    for (int i = 0; i < 20; ++i) {
        Texture texture(Format::r8, 1, 1);
        EXPECT_NE(texture.serial(), 0u);
        EXPECT_EQ(std::ranges::count(serials, texture.serial()), 0);
        serials.push_back(texture.serial());
        const Texture moved = std::move(texture);
        EXPECT_EQ(moved.serial(), serials.back());
        EXPECT_EQ(texture.serial(), 0u);  // NOLINT(bugprone-use-after-move): what is left
    }
}

}  // namespace
}  // namespace easypbr::gl::framebuffer_test
