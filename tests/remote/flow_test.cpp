// How much is sent: windows by answers, quality by delays, headers bit for bit.
#include "easypbr/remote/flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "easypbr/remote/frame_header.h"
#include "easypbr/remote/inbox.h"

namespace easypbr::remote::flow_test {
namespace {

TEST(FlowControl, AFewPicturesAreOnTheirWayAtATime) {
    FlowControl flow;
    EXPECT_TRUE(flow.has_room());
    flow.sent(1, 0, 1000, 0);
    flow.sent(2, 0, 1000, 0.03);
    EXPECT_EQ(flow.count(), 2u);
    EXPECT_FALSE(flow.has_room());
    EXPECT_DOUBLE_EQ(flow.waits_s(1), 1);
    flow.drawn(1, 0, 0.04);
    EXPECT_TRUE(flow.has_room());
    EXPECT_DOUBLE_EQ(flow.latency_s(), 0.04);
    flow.drawn(7, 0, 0.05);  // Never sent.
    EXPECT_EQ(flow.count(), 1u);
}

TEST(FlowControl, AnAnswerCountsForAllBefore) {
    FlowControl flow;
    for (uint32_t frame = 1; frame < 5; ++frame) flow.sent(frame, 0, 10, 0);
    flow.drawn(3, 0, 1);
    EXPECT_EQ(flow.count(), 1u);
}

/// 150 ms there and back at 30 pictures a second: with two on their way there would be 13 a second.
TEST(FlowControl, TheWindowGrowsWithTheLine) {
    FlowControl flow;
    double now = 0;
    for (uint32_t frame = 1; frame < 100; ++frame) {
        flow.sent(frame, 0, 10, now);
        flow.drawn(frame, 0, now + 0.15);
        now += 1.0 / 30;
    }
    EXPECT_GE(flow.window(), 5u);
    EXPECT_LE(flow.window(), FlowControl::most_window);
}

/// A line of 100 ms there and back, pictures that take 60 ms to be made and 40 ms in the page: the window
/// does not lock at what it let through before.
TEST(FlowControl, TheWindowLetsThroughWhatIsDrawn) {
    FlowControl flow;
    std::deque<std::pair<uint32_t, double>> coming;
    uint32_t frame = 0, late_frames = 0;
    double made_s = 0;
    for (double now = 0; now < 20; now += 0.001) {
        for (; !coming.empty() && coming.front().second <= now; coming.pop_front())
            flow.drawn(coming.front().first, 0, now);
        if (now < made_s || !flow.has_room()) continue;
        made_s = now + 0.06;
        flow.sent(++frame, 0, 10, now);
        coming.emplace_back(frame, now + 0.14);
        late_frames += now > 10;
    }
    EXPECT_GE(late_frames, 160u);  // 16.7 a second
}

/// A line of `rate` bytes a second and `delay_s` there and back, and what comes between before and after it.
struct Simulation {
    double rate, delay_s, server_s, page_s;

    /// A minute of pictures of 16 kB at full quality, 30 a second as far as the window allows. The share of
    /// the quality that is left.
    double share() const {
        FlowControl flow;
        WireQuality quality;
        struct Coming {
            uint32_t frame;
            double at_s;
            OffTheLine off;
        };
        std::deque<Coming> coming;
        double free_s = 0;
        uint32_t frame = 0;
        for (double now = 0; now < 60; now += 1.0 / 30) {
            for (; !coming.empty() && coming.front().at_s <= now; coming.pop_front()) {
                flow.drawn(coming.front().frame, 0, coming.front().at_s, coming.front().off);
                quality.drawn(flow.queued_s(), now);
            }
            if (!flow.has_room()) continue;
            const double bytes = 16000 * quality.share();
            flow.sent(++frame, 0, size_t(bytes), now);
            free_s = std::max(free_s, now) + bytes / rate;
            const bool busy = std::fmod(now, 4) < 2;  // Two seconds of four.
            const OffTheLine off = busy ? OffTheLine{page_s, server_s} : OffTheLine();
            coming.push_back({frame, free_s + delay_s + off.page_s + off.server_s, off});
        }
        return quality.share();
    }
};

TEST(WireQuality, ABusyServerOrPageIsNoSlowLine) {
    const double fast = 1e8 / 8;
    EXPECT_EQ((Simulation{fast, 0.02, 0, 0}.share()), 1);
    EXPECT_EQ((Simulation{fast, 0.02, 0.15, 0}.share()), 1);
    EXPECT_EQ((Simulation{fast, 0.02, 0, 0.15}.share()), 1);
    // 1 Mbit/s for 3.84: a quarter gets through.
    EXPECT_LT((Simulation{1e6 / 8, 0.02, 0, 0}.share()), 0.4);
    EXPECT_LT((Simulation{1e6 / 8, 0.02, 0.05, 0.05}.share()), 0.4);
}

TEST(FlowControl, AMegabyteIsEnough) {
    FlowControl flow;
    flow.sent(1, 0, size_t(2) << 20, 0);
    EXPECT_FALSE(flow.has_room());
    flow.drawn(1, 0, 1);
    EXPECT_TRUE(flow.has_room());
}

TEST(FlowControl, ChunksGetFewerOnALineThatQueues) {
    FlowControl flow;
    uint16_t chunk = 0;
    flow.sent(1, chunk, 10, 0);
    flow.drawn(1, chunk++, 0.01);
    for (int i = 0; i < 8; ++i, ++chunk) {
        flow.sent(1, chunk, 10, 1);
        flow.drawn(1, chunk, 1.5);
    }
    EXPECT_TRUE(flow.has_chunk_room());
    flow.sent(1, chunk, 10, 2);
    EXPECT_FALSE(flow.has_chunk_room());
}

/// A page that is busy for a moment is no line that queues: of eight answers in half a second one is late.
TEST(WireQuality, AMomentChangesNothing) {
    WireQuality quality;
    double now = 0;
    for (int i = 0; i < 200; ++i) quality.drawn(i % 8 == 0 ? 0.12 : 0, now += 0.06);
    EXPECT_EQ(quality.share(), 1);
}

TEST(WireQuality, GoesDownWhereTheLineQueuesAndUpAgain) {
    WireQuality quality;
    EXPECT_EQ(quality.jpeg_quality(), 80);
    EXPECT_EQ(quality.resolution(), 1);
    double now = 0;
    const auto pass = [&](double queued, double seconds) {
        for (const double end = now + seconds; now < end; now += 0.1) quality.drawn(queued, now);
    };
    pass(0.3, 2.6);
    EXPECT_LT(quality.jpeg_quality(), 80);
    EXPECT_EQ(quality.resolution(), 1);  // The quality goes first.
    pass(0.3, 20);
    EXPECT_EQ(quality.jpeg_quality(), 40);
    EXPECT_LT(quality.resolution(), 0.5);
    EXPECT_GE(quality.resolution(), 0.25);
    pass(0.03, 5);  // Between the two thresholds it stays.
    const double kept = quality.share();
    pass(0.03, 5);
    EXPECT_EQ(quality.share(), kept);
    pass(0.005, 60);
    EXPECT_EQ(quality.jpeg_quality(), 80);
    EXPECT_EQ(quality.resolution(), 1);
}

TEST(FrameHeader, IsLittleEndian) {
    FrameHeader header;
    header.kind = FrameKind::still;
    header.codec = Codec::png;
    header.flags = 0x0102;
    header.frame = 0x03040506;
    header.input = 7;
    header.width = 0x0809;
    header.height = 10;
    header.refined = 11;
    header.total = 12;
    header.chunk = 13;
    header.bytes = 14;
    header.wait_us = 0x15161718;
    const auto bytes = header.encoded();
    const auto at = [&](size_t i) { return int(bytes[i]); };
    EXPECT_EQ(at(0), 2);
    EXPECT_EQ(at(1), 2);
    EXPECT_EQ(at(2), 2);
    EXPECT_EQ(at(3), 1);
    EXPECT_EQ(at(4), 6);
    EXPECT_EQ(at(7), 3);
    EXPECT_EQ(at(8), 7);
    EXPECT_EQ(at(14), 9);
    EXPECT_EQ(at(15), 8);
    EXPECT_EQ(at(16), 10);
    EXPECT_EQ(at(18), 11);
    EXPECT_EQ(at(20), 12);
    EXPECT_EQ(at(22), 13);
    EXPECT_EQ(at(24), 14);
    EXPECT_EQ(at(36), 0x18);
    EXPECT_EQ(at(39), 0x15);
}

Order pointer_order(ClientId from, app::InputEvent::Kind kind, uint32_t id, double arrived) {
    Input input;
    input.id = id;
    input.event.kind = kind;
    return {from, input, arrived};
}

TEST(Inbox, MergesMovesAndNothingElse) {
    using Kind = app::InputEvent::Kind;
    Inbox inbox;
    inbox.add(pointer_order(1, Kind::move, 1, 1));
    inbox.add(pointer_order(1, Kind::move, 2, 2));
    inbox.add(pointer_order(1, Kind::press, 3, 3));
    inbox.add(pointer_order(1, Kind::move, 4, 4));
    inbox.add(pointer_order(2, Kind::move, 5, 5));
    const std::vector<Order> orders = inbox.take();
    ASSERT_EQ(orders.size(), 4u);
    EXPECT_EQ(std::get<Input>(orders[0].message).id, 2u);
    EXPECT_EQ(orders[0].arrived_s, 2);
    EXPECT_FALSE(inbox.has_orders());
}

TEST(Inbox, KeepsTheViewsApart) {
    using Kind = app::InputEvent::Kind;
    Inbox inbox;
    for (uint32_t id = 1; id < 7; ++id) {
        Order order = pointer_order(id % 2, Kind::move, id, id);
        order.view = ViewId(id % 2);
        inbox.add(order);
    }
    EXPECT_TRUE(inbox.has_orders(0));
    const std::vector<Order> shared = inbox.take(0);
    ASSERT_EQ(shared.size(), 1u);  // What came between was another view's.
    EXPECT_EQ(std::get<Input>(shared[0].message).id, 6u);
    EXPECT_FALSE(inbox.has_orders(0));
    ASSERT_EQ(inbox.take(1).size(), 1u);
    EXPECT_FALSE(inbox.has_orders(2));
}

TEST(Inbox, IsBounded) {
    Inbox inbox;
    for (uint32_t i = 0; i < 5000; ++i) inbox.add(pointer_order(1, app::InputEvent::Kind::press, i, 0));
    EXPECT_EQ(inbox.take().size(), Inbox::most_orders);
}

}  // namespace
}  // namespace easypbr::remote::flow_test
