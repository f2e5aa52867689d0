// The strict schema of what clients send.
#include "easypbr/remote/messages.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace easypbr::remote::messages_test {
namespace {

template <class T>
T read(const std::string& text) {
    return std::get<T>(parse_message(text));
}

const std::string pointer =
    R"({"kind":"pointer","id":7,"action":"press","button":"right","x":1.5,"y":-2,"wheel":0,"shift":true,"time":3})";

TEST(Messages, ReadsWhatIsRight) {
    EXPECT_EQ(read<Hello>(R"({"kind":"hello","token":"abc","width":640,"height":480})").token, "abc");
    EXPECT_EQ(read<Hello>(R"({"kind":"hello","token":"","width":640,"height":480})").size, Vec2i(640, 480));
    EXPECT_EQ(read<Ack>(R"({"kind":"ack","frame":4294967295,"chunk":2,"busy":0})").frame, 4294967295u);
    EXPECT_EQ(read<Ack>(R"({"kind":"ack","frame":1,"chunk":2,"busy":0.25})").busy_s, 0.25);
    EXPECT_TRUE(read<OwnView>(R"({"kind":"view","own":true,"width":4,"height":3})").own);
    const Input input = read<Input>(pointer);
    EXPECT_EQ(input.id, 7u);
    EXPECT_EQ(input.event.kind, app::InputEvent::Kind::press);
    EXPECT_EQ(input.event.button, app::MouseButton::right);
    EXPECT_EQ(input.event.position, Vec2d(1.5, -2));
    EXPECT_TRUE(input.event.shift);
    const Input key = read<Input>(R"({"kind":"key","id":1,"action":"down","key":"W","shift":false})");
    EXPECT_EQ(key.event.key, 'W');
    EXPECT_FALSE(key.event.control);
    EXPECT_TRUE(read<Decodes>(R"({"kind":"decodes","h264":true})").h264);
    EXPECT_EQ(read<SetField>(R"({"kind":"set","name":"a.b","value":"1"})").value, "1");
    EXPECT_EQ(read<Act>(R"({"kind":"act","what":"undo"})").what, Act::What::undo);
    EXPECT_EQ(read<Shot>(R"({"kind":"shot","id":1,"width":8192,"height":8192})").size, Vec2i(8192, 8192));
}

class WrongMessage : public testing::TestWithParam<const char*> {};

TEST_P(WrongMessage, IsRefused) {
    EXPECT_THROW(parse_message(GetParam()), ProtocolError);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongMessage,
    testing::Values(
        "", "null", "[]", "7", "\"hello\"", "{", "{}", R"({"kind":7})", R"({"kind":"unknown"})",
        R"({"kind":"ack","frame":1})", R"({"kind":"ack","frame":1,"chunk":0,"busy":-1})",
        R"({"kind":"view","own":true})", R"({"kind":"view","own":1,"width":4,"height":3})",
        R"({"kind":"ack","frame":-1,"chunk":0,"busy":0})", R"({"kind":"ack","frame":1.5,"chunk":0,"busy":0})",
        R"({"kind":"ack","frame":4294967296,"chunk":0,"busy":0})",
        R"({"kind":"ack","frame":18446744073709551615,"chunk":0,"busy":0})",
        R"({"kind":"ack","frame":"1","chunk":0,"busy":0})",
        R"({"kind":"ack","frame":1,"chunk":0,"busy":0,"more":1})",
        R"({"kind":"resize","width":0,"height":1})", R"({"kind":"resize","width":4097,"height":1})",
        R"({"kind":"resize","width":true,"height":1})", R"({"kind":"pause","paused":1})",
        R"({"kind":"decodes","h264":"yes"})", R"({"kind":"set","name":"x","value":1})",
        R"({"kind":"set","name":"x\u0000y","value":"1"})", R"({"kind":"act","what":"explode"})",
        R"({"kind":"turn","id":1,"right":1e999,"up":0})", R"({"kind":"turn","id":1,"right":NaN,"up":0})",
        R"({"kind":"turn","id":1,"right":361,"up":0})",
        R"({"kind":"key","id":1,"action":"down","key":"w","shift":false})",
        R"({"kind":"key","id":1,"action":"down","key":"F1","shift":false})",
        R"({"kind":"shot","id":1,"width":16384,"height":16384})",
        R"({"kind":"shot","id":1,"width":16385,"height":1})",
        "{\"kind\":\"select\",\"object\":\"\xff\xfe\"}"));

TEST(Messages, LongTextsAreRefused) {
    const auto set = [](size_t length) {
        return R"({"kind":"set","name":"x","value":")" + std::string(length, 'a') + "\"}";
    };
    EXPECT_EQ(read<SetField>(set(8192)).value.size(), 8192u);
    EXPECT_THROW(parse_message(set(8193)), ProtocolError);
    EXPECT_THROW(parse_message(std::string(60000, '[')), ProtocolError);
    // The program names objects and panels.
    const std::string name(6000, 'a');
    EXPECT_EQ(read<ShowObject>(R"({"kind":"show","visible":true,"object":")" + name + "\"}").object, name);
    const std::string widget = R"({"kind":"widget","name":"Go","use":0,"value":"","panel":")" + name + "\"}";
    EXPECT_EQ(read<SetWidget>(widget).panel, name);
}

/// Messages that were right, changed at random: read or refused, nothing else.
TEST(FuzzMessages, AreReadOrRefused) {
    const char* const asked = std::getenv("EASYPBR_FUZZ_COUNT");
    const int count = asked ? std::atoi(asked) * 100 : 10000;
    const std::vector<std::string> seeds = {
        pointer, R"({"kind":"hello","token":"abc","width":640,"height":480})",
        R"({"kind":"animate","number":1,"plays":true,"time":1.5,"speed":1})",
        R"({"kind":"shot","id":1,"width":100,"height":100})", R"({"kind":"pick","id":1,"x":3,"y":4})"};
    std::mt19937 random(7);
    int read = 0;
    for (int i = 0; i < count; ++i) {
        std::string text = seeds[random() % seeds.size()];
        for (unsigned changes = random() % 4; changes > 0; --changes) {
            const size_t at = random() % text.size();
            const unsigned way = random() % 3;
            if (way == 0) text[at] = char(random());
            if (way == 1) text.erase(at, 1 + random() % 5);
            if (way == 2) text.insert(at, text.substr(random() % text.size(), random() % 9));
            if (text.empty()) text = "{";
        }
        try {
            parse_message(text);
            ++read;
        } catch (const ProtocolError& error) {
            EXPECT_NE(std::string(error.what()), "");
        }
    }
    EXPECT_GT(read, count / 10);
    EXPECT_LT(read, count);
}

}  // namespace
}  // namespace easypbr::remote::messages_test
