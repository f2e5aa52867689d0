// Channels: clients whose messages the program carries, all of one person.
#include "easypbr/remote/server.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <iterator>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "easypbr/remote/mailbox.h"
#include "easypbr/scene/mesh.h"
#include "easypbr/scene/scene.h"
#include "easypbr/scene/settings.h"

namespace easypbr::remote::channel_test {
namespace {

using nlohmann::json;

const char* const hello = R"({"kind":"hello","token":"","width":32,"height":24})";

class ChannelTest : public testing::Test {
  protected:
    ChannelTest() : channel(Scene(), Settings()) {}

    /// The next message of this kind that comes to a client; null where none does.
    json until(uint64_t client, const std::string& kind) {
        for (int i = 0; i < 100; ++i) {
            for (auto at = unread.begin(); at != unread.end(); ++at) {
                if (at->client != client || at->text.empty()) continue;
                const json words = json::parse(at->text, nullptr, false);
                if (!words.is_object() || words["kind"] != kind) continue;
                unread.erase(unread.begin(), std::next(at));
                return words;
            }
            for (ChannelMessage& message : channel.take(0.1)) unread.push_back(std::move(message));
        }
        return {};
    }

    Channel channel;
    std::vector<ChannelMessage> unread;
};

TEST_F(ChannelTest, LetsClientsInWithoutASecret) {
    channel.receive(7, hello);
    EXPECT_FALSE(until(7, "welcome").is_null());
    EXPECT_EQ(channel.client_count(), 1u);
    EXPECT_TRUE(until(7, "control")["controls"]);
}

TEST_F(ChannelTest, HandsControlToWhoAsks) {
    channel.receive(1, hello);
    EXPECT_TRUE(until(1, "control")["controls"]);
    channel.receive(1, R"({"kind":"turn","id":1,"right":5,"up":0})");
    channel.receive(2, hello);
    EXPECT_FALSE(until(2, "control")["controls"]);
    channel.receive(2, R"({"kind":"act","what":"take"})");
    EXPECT_TRUE(until(2, "control")["controls"]);
}

TEST_F(ChannelTest, SendsAwayWhoSaysWhatIsNoMessage) {
    channel.receive(1, hello);
    until(1, "control");
    channel.receive(1, R"({"kind":"nonsense"})");
    int code = 0;
    for (int i = 0; i < 100 && code == 0; ++i)
        for (const ChannelMessage& message : channel.take(0.1)) code = std::max(code, message.close_code);
    EXPECT_EQ(code, int(CloseCode::refused));
    EXPECT_EQ(channel.client_count(), 0u);
}

TEST_F(ChannelTest, ForgetsWhoLeaves) {
    channel.receive(1, hello);
    channel.receive(2, hello);
    EXPECT_EQ(channel.client_count(), 2u);
    channel.leave(1);
    channel.leave(1);
    channel.leave(99);
    EXPECT_EQ(channel.client_count(), 1u);
    // A sign of life of somebody who is not there begins nothing.
    channel.receive(1, "");
    EXPECT_EQ(channel.client_count(), 1u);
}

TEST_F(ChannelTest, ClosesWhileSomebodyWaits) {
    channel.receive(1, hello);
    channel.close();
    channel.close();
    EXPECT_FALSE(channel.is_open());
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(channel.take(30).empty());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    channel.receive(2, hello);
    EXPECT_EQ(channel.client_count(), 1u);
}

TEST(Attendance, ForgetsWhoIsSilent) {
    Attendance attendance;
    EXPECT_TRUE(attendance.note(1, 0));
    EXPECT_TRUE(attendance.note(2, 100));
    EXPECT_FALSE(attendance.note(2, 150));
    EXPECT_TRUE(attendance.drop_silent(180).empty());
    EXPECT_EQ(attendance.drop_silent(181), std::vector<ClientId>{1});
    EXPECT_EQ(attendance.count(), 1u);
}

TEST(Mailbox, KeepsTheOrderAndPutsTheHeaderFirst) {
    Mailbox mailbox;
    mailbox.send(1, std::make_shared<const std::string>("first"));
    const auto bytes = std::make_shared<const std::vector<std::byte>>(5, std::byte(9));
    mailbox.send(2, Packet{FrameHeader(), bytes, 2, 3});
    const auto taken = mailbox.take(0);
    ASSERT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0].text, "first");
    EXPECT_EQ(taken[1].client, 2u);
    EXPECT_EQ(taken[1].bytes.size(), FrameHeader::size + 3);
    EXPECT_EQ(taken[1].bytes.back(), std::byte(9));
    EXPECT_TRUE(mailbox.take(0).empty());
}

// Its function runs on the thread that draws, which cannot wait for its own end.
TEST(ChannelEnd, APanelMayCloseItsChannelAndDropIt) {
    for (const bool drops : {false, true}) {
        auto channel = std::make_unique<Channel>(Scene(), Settings());
        // Shared, as the function may be called once more while the thread ends.
        const auto closed = std::make_shared<std::promise<bool>>();
        const auto first = std::make_shared<std::once_flag>();
        channel->add_panel("Ends", [&channel, drops, closed, first](app::Widgets&) {
            std::call_once(*first, [&] {
                channel->close();
                const bool is_open = channel->is_open();
                if (drops) channel.reset();
                closed->set_value(!is_open);
            });
        });
        channel->receive(1, hello);
        std::future<bool> result = closed->get_future();
        ASSERT_EQ(result.wait_for(std::chrono::seconds(30)), std::future_status::ready);
        EXPECT_TRUE(result.get());
        if (channel) channel->close();
    }
}

}  // namespace
}  // namespace easypbr::remote::channel_test
