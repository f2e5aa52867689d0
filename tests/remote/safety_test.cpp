// Who is let in: names, origins, secrets, rates; what is answered to requests.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "easypbr/core/error.h"
#include "easypbr/remote/gate.h"
#include "easypbr/remote/hosts.h"
#include "easypbr/remote/http_answer.h"
#include "easypbr/remote/token.h"

namespace easypbr::remote::safety_test {
namespace {

TEST(Hosts, LoopbackIsAllowedUnderAllItsNames) {
    const HostRules rules("127.0.0.1", {}, {});
    for (const char* host :
         {"localhost", "localhost:8123", "LOCALHOST:1", "127.0.0.1:80", "127.9.9.9", "[::1]:5"})
        EXPECT_TRUE(rules.allows_host(host)) << host;
}

TEST(Hosts, OtherNamesAreNot) {
    const HostRules rules("127.0.0.1", {}, {});
    for (const char* host : {"", ":80", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example",
                             "127.0.0.1:80:80", "localhost:port", "localhost:123456", "[::1", "[::1]x",
                             "127.1", "localhost ", "local host", "127.0.0.1@evil.example"})
        EXPECT_FALSE(rules.allows_host(host)) << host;
    EXPECT_FALSE(rules.allows_host(std::string(100000, 'a')));
}

TEST(Hosts, NamesAndAddressesThatWereGivenAre) {
    const HostRules rules("10.0.0.5", {"gpu.example.org", "fe80::1"}, {});
    EXPECT_TRUE(rules.allows_host("10.0.0.5:8123"));
    EXPECT_TRUE(rules.allows_host("GPU.example.org"));
    EXPECT_TRUE(rules.allows_host("[fe80::1]:80"));
    EXPECT_FALSE(rules.allows_host("10.0.0.6"));
    const HostRules all("0.0.0.0", {}, {});
    for (const std::string& address : addresses_of("0.0.0.0")) EXPECT_TRUE(all.allows_host(address + ":80"));
    EXPECT_FALSE(all.allows_host("203.0.113.9"));  // of no interface: RFC 5737
    EXPECT_FALSE(all.allows_host("evil.example"));
    EXPECT_EQ(addresses_of("10.0.0.5"), std::vector<std::string>{"10.0.0.5"});
    EXPECT_THROW(HostRules("", {"https://gpu"}, {}), ArgumentError);
    EXPECT_THROW(HostRules("", {""}, {}), ArgumentError);
}

TEST(Hosts, AnOriginIsTheHostItselfOrOneThatWasGiven) {
    const HostRules rules("127.0.0.1", {"gpu"}, {"https://hub.example.org"});
    EXPECT_TRUE(rules.allows_origin("", "localhost:1"));
    EXPECT_TRUE(rules.allows_origin("http://localhost:1", "localhost:1"));
    EXPECT_TRUE(rules.allows_origin("https://gpu", "gpu"));
    EXPECT_TRUE(rules.allows_origin("https://hub.example.org", "gpu:1"));
    EXPECT_FALSE(rules.allows_origin("http://localhost:2", "localhost:1"));
    EXPECT_FALSE(rules.allows_origin("http://hub.example.org", "gpu:1"));
    EXPECT_FALSE(rules.allows_origin("https://hub.example.org.evil.example", "gpu:1"));
    EXPECT_FALSE(rules.allows_origin("null", "localhost:1"));
    EXPECT_FALSE(rules.allows_origin("file://", "localhost:1"));
    EXPECT_FALSE(rules.allows_origin("http://evil.example", "evil.example"));
    EXPECT_THROW(HostRules("", {}, {"hub.example.org"}), ArgumentError);
    EXPECT_THROW(HostRules("", {}, {"https://hub.example.org/path"}), ArgumentError);
    // It would end the policy's line and begin another one.
    EXPECT_THROW(HostRules("", {}, {"https://a;script-src *"}), ArgumentError);
}

TEST(Tokens, AreRandomAndLong) {
    const std::string one = random_token(), other = random_token();
    EXPECT_EQ(one.size(), 64u);
    EXPECT_NE(one, other);
    EXPECT_TRUE(same_secret(one, one));
    EXPECT_FALSE(same_secret(other, one));
    EXPECT_FALSE(same_secret(one.substr(1), one));
    EXPECT_FALSE(same_secret(one + one, one));
    EXPECT_FALSE(same_secret("", one));
    EXPECT_FALSE(same_secret("", ""));
}

class TokenFile : public testing::Test {
  protected:
    void write(const std::string& text, mode_t mode = 0600) {
        std::ofstream(path_) << text;
        ASSERT_EQ(chmod(path_.c_str(), mode), 0);
    }
    void TearDown() override { std::filesystem::remove(path_); }

    std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("easypbr_token_" + std::to_string(getpid()));
    const std::string a = std::string(40, 'a'), b = std::string(40, 'b');
};

TEST_F(TokenFile, HoldsOneSecretOrTwo) {
    write(a + "\n" + b + "\n");
    EXPECT_EQ(load_tokens(path_).control, a);
    EXPECT_EQ(load_tokens(path_).watch, b);
    write(a);
    EXPECT_EQ(load_tokens(path_).control, a);
    EXPECT_EQ(load_tokens(path_).watch.size(), 64u);
    EXPECT_EQ(load_tokens({}).control.size(), 64u);
}

TEST_F(TokenFile, IsRefusedWhenOthersCanReadItOrItIsWeak) {
    EXPECT_THROW(load_tokens(path_), FileError);
    write(a, 0644);
    EXPECT_THROW(load_tokens(path_), FormatError);
    write("short\n");
    EXPECT_THROW(load_tokens(path_), FormatError);
    write(a + " with spaces\n");
    EXPECT_THROW(load_tokens(path_), FormatError);
    write(a + "\n" + a + "\n");
    EXPECT_THROW(load_tokens(path_), FormatError);
    write("");
    EXPECT_THROW(load_tokens(path_), FormatError);
}

TEST(Gate, MessagesAreLimitedBySecond) {
    MessageRate rate;
    int taken = 0;
    while (rate.take(10)) ++taken;
    EXPECT_EQ(taken, 480);
    EXPECT_FALSE(rate.take(10.001));
    taken = 0;
    while (rate.take(11)) ++taken;
    EXPECT_NEAR(taken, 240, 1);
    EXPECT_TRUE(rate.take(12, MessageRate::ack_cost));
}

TEST(Gate, WrongTokensWaitAfterFive) {
    WrongTokens wrong;
    for (int i = 0; i < 4; ++i) wrong.add(1);
    EXPECT_EQ(wrong.delay_s(1), 0);
    wrong.add(2);
    EXPECT_EQ(wrong.delay_s(2), 1);
    EXPECT_EQ(wrong.delay_s(61.5), 0);
}

HttpRequest request(std::string_view target) {
    HttpRequest request;
    request.method = "GET";
    request.target = target;
    request.host = "localhost:8123";
    return request;
}

TEST(HttpAnswer, ServesTheTableOfNamesBelowAnyPrefix) {
    const HostRules rules("127.0.0.1", {}, {});
    for (const char* target : {"/", "/index.html", "/proxy/8123/", "/?x=1", "/a/b/c/index.html"}) {
        const HttpAnswer page = answer(request(target), rules);
        EXPECT_EQ(page.status, 200) << target;
        EXPECT_EQ(page.type, "text/html; charset=utf-8") << target;
        EXPECT_NE(page.body.find("<!doctype html>"), page.body.npos);
    }
    EXPECT_EQ(answer(request("/app.js"), rules).type, "text/javascript; charset=utf-8");
    EXPECT_EQ(answer(request("/app.css"), rules).type, "text/css; charset=utf-8");
}

TEST(HttpAnswer, HasNothingElse) {
    const HostRules rules("127.0.0.1", {}, {});
    for (const char* target :
         {"/etc/passwd", "/../../etc/passwd", "/%2e%2e/secret", "/app.js/x", "/..", "/app.js%00"})
        EXPECT_EQ(answer(request(target), rules).status, 404) << target;
    EXPECT_EQ(answer(request("index.html"), rules).status, 400);
    HttpRequest post = request("/");
    post.method = "POST";
    EXPECT_EQ(answer(post, rules).status, 405);
}

TEST(HttpAnswer, RefusesNamesOriginsAndProtocols) {
    const HostRules rules("127.0.0.1", {}, {});
    HttpRequest strange = request("/");
    strange.host = "evil.example";
    EXPECT_EQ(answer(strange, rules).status, 403);
    HttpRequest two = request("/");
    two.hosts = 2;
    EXPECT_EQ(answer(two, rules).status, 403);
    HttpRequest socket = request("/socket");
    EXPECT_EQ(answer(socket, rules).status, 426);
    socket.upgrade = true;
    EXPECT_EQ(answer(socket, rules).status, 400);
    socket.protocols = "other, easypbr.1";
    EXPECT_TRUE(answer(socket, rules).is_socket);
    socket.protocols = "easypbr.12";
    EXPECT_FALSE(answer(socket, rules).is_socket);
    socket.protocols = "easypbr.1";
    socket.origin = "http://evil.example";
    EXPECT_EQ(answer(socket, rules).status, 403);
}

TEST(HttpAnswer, CarriesAPolicy) {
    const auto headers = safety_headers(HostRules("127.0.0.1", {}, {"https://hub.example.org"}));
    EXPECT_EQ(headers[0].first, "Content-Security-Policy");
    EXPECT_NE(headers[0].second.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(headers[0].second.find("frame-ancestors 'self' https://hub.example.org"), std::string::npos);
    EXPECT_EQ(headers[0].second.find("unsafe"), std::string::npos);
}

}  // namespace
}  // namespace easypbr::remote::safety_test
