// Base 64, against the examples of RFC 4648.
#include "easypbr/io/source/base64.h"

#include <gtest/gtest.h>

namespace easypbr::io::base64_test {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

TEST(Base64, WritesWhatTheStandardSays) {
    for (const auto& [text, code] : {std::pair<std::string_view, std::string_view>{"", ""},
                                     {"f", "Zg=="},
                                     {"fo", "Zm8="},
                                     {"foo", "Zm9v"},
                                     {"foob", "Zm9vYg=="},
                                     {"fooba", "Zm9vYmE="},
                                     {"foobar", "Zm9vYmFy"},
                                     {"\xfb\xff\xfe", "+//+"}})
        EXPECT_EQ(base64_encoded(bytes_of(text)), code);
}

TEST(Base64, ReadsWhatItWrites) {
    std::vector<std::byte> all;
    for (int i = 0; i < 1000; ++i) {
        all.push_back(std::byte(i * 37));
        EXPECT_EQ(base64_decoded(base64_encoded(all)), all);
    }
    EXPECT_FALSE(base64_decoded("Zm9v!"));
}

}  // namespace
}  // namespace easypbr::io::base64_test
