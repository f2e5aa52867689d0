// What is said of text that is no JSON: the file, the line, the column and what stands there.
#include "easypbr/io/source/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace easypbr::json_text_test {

namespace {

std::string refusal(const std::string& text) {
    try {
        io::parse_json<nlohmann::json>(text, "a.json");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST(JsonText, NamesThePlaceOfAMistake) {
    EXPECT_EQ(refusal("{\"a\": [1, 2.5, null]}"), "accepted");
    EXPECT_EQ(refusal(""), "cannot read a.json, line 1, column 1: expected JSON, got the end of the text");
    EXPECT_EQ(refusal("[{"), "cannot read a.json, line 1, column 3: expected JSON, got the end of the text");
    EXPECT_EQ(refusal("[1,\n 2,\n]"), "cannot read a.json, line 3, column 1: expected JSON, got ']'");
    EXPECT_EQ(refusal("{\n  \"a\": }"), "cannot read a.json, line 2, column 8: expected JSON, got '}'");
    EXPECT_EQ(refusal("{'a': 1}"), "cannot read a.json, line 1, column 2: expected JSON, got '''");
    EXPECT_EQ(refusal("[\x01]"), "cannot read a.json, line 1, column 2: expected JSON, got the byte 0x01");
    EXPECT_EQ(refusal("[\"a\n\"]"),
              "cannot read a.json, line 1, column 4: expected JSON, got the end of the line");
    EXPECT_EQ(refusal("[1e999]"), "cannot read a.json: a number is beyond what float64 holds");
}

}  // namespace easypbr::json_text_test
