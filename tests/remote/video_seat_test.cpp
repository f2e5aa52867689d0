// Who may take which picture of a video, and when key frames are asked for.
#include "easypbr/remote/video_seat.h"

#include <gtest/gtest.h>

#include "easypbr/remote/flow.h"

namespace easypbr::remote::video_seat_test {
namespace {

constexpr VideoMark key{10, 0}, next{11, 10}, later{13, 12};

TEST(VideoSeat, BeginsWithAKeyFrameAndTakesEachPicture) {
    VideoSeat seat;
    EXPECT_FALSE(seat.can_take(key));
    EXPECT_FALSE(seat.wants_key(0));
    seat.decodes(true, 0);
    EXPECT_TRUE(seat.wants_key(0));
    EXPECT_FALSE(seat.can_take(next));
    ASSERT_TRUE(seat.can_take(key));
    seat.took(key, 0);
    EXPECT_FALSE(seat.wants_key(0));
    ASSERT_TRUE(seat.can_take(next));
    seat.took(next, 0.03);
    EXPECT_FALSE(seat.can_take(later));
    EXPECT_TRUE(seat.can_take({20, 0}));
    seat.decodes(false, 1);
    EXPECT_FALSE(seat.can_take(key));
}

TEST(VideoSeat, WaitsLongerEachTimeThatItFallsOut) {
    VideoSeat seat;
    seat.decodes(true, 0);
    double now = 0;
    for (const double wait : {1, 2, 4, 8, 16, 32, 32}) {
        seat.took(key, now);
        seat.missed(now);
        seat.missed(now);  // Once is enough.
        EXPECT_FALSE(seat.can_take(next));
        EXPECT_FALSE(seat.wants_key(now + wait - 0.01)) << wait;
        now += wait;
        EXPECT_TRUE(seat.wants_key(now)) << wait;
    }
    // A minute and more of keeping up is forgiven.
    seat.took(key, now);
    seat.missed(now + 65);
    EXPECT_TRUE(seat.wants_key(now + 66));
}

TEST(VideoSeat, SayingSoAgainIsFallingOut) {
    VideoSeat seat;
    seat.decodes(true, 0);
    seat.took(key, 0);
    seat.decodes(true, 1);
    EXPECT_FALSE(seat.can_take(next));
    EXPECT_FALSE(seat.wants_key(1.9));
    EXPECT_TRUE(seat.wants_key(2));
}

TEST(VideoSeat, WhoLooksAwayComesBackAtOnce) {
    VideoSeat seat;
    seat.decodes(true, 0);
    seat.took(key, 0);
    seat.leave();
    EXPECT_FALSE(seat.can_take(next));
    EXPECT_TRUE(seat.wants_key(0));
}

/// The bit rate goes down to an eighth before the resolution does; both together to 1/32.
TEST(VideoQuality, GivesBitsBeforePixels) {
    WireQuality quality;
    quality.use_video(true);
    EXPECT_EQ(quality.video_rate(1280 * 720), 4e6);
    EXPECT_EQ(quality.video_rate(16 * 16), WireQuality::least_rate);
    EXPECT_EQ(quality.video_rate(7680 * 4320), WireQuality::most_rate);
    double now = 0;
    while (quality.share() > 0.14) quality.drawn(0.3, now += 0.6);
    EXPECT_EQ(quality.resolution(), 1);
    EXPECT_NEAR(quality.video_rate(1280 * 720), 4e6 * quality.share(), 1);
    while (quality.share() > WireQuality::least_share) quality.drawn(0.3, now += 0.6);
    EXPECT_NEAR(quality.resolution(), 0.5, 1e-9);  // sqrt((1/32) / (1/8))
}

}  // namespace
}  // namespace easypbr::remote::video_seat_test
