// JSON that is nested deeper than the stack is refused by all that reads JSON; of settings see
// settings_test.cpp.
#include <gtest/gtest.h>

#include "easypbr/io/settings/camera_path_io.h"
#include "easypbr/io/settings/label_map_text.h"
#include "easypbr/io/source/json_depth.h"
#include "io/gltf_decoded.h"
#include "refusal.h"

namespace easypbr::json_depth_test {

namespace {

/// `levels` lists in each other.
std::string nested(size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
}

}  // namespace

TEST(JsonDepth, BracketsCountOutsideOfTextsAlone) {
    const auto check = [](const std::string& text) {
        return refusal<FormatError>([&] { io::check_json_depth(text, "a.json"); });
    };
    EXPECT_EQ(check(nested(512)), "taken");
    EXPECT_EQ(check(nested(513)), "cannot read a.json: its JSON is nested more than 512 levels deep");
    EXPECT_EQ(check("[\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"]"), "taken");
    std::string wide = "[";
    for (int i = 0; i < 1000; ++i) wide += "{\"a\":[]},";
    EXPECT_EQ(check(wide + "0]"), "taken");
    EXPECT_EQ(check("\"\\"), "taken");
}

TEST(JsonDepth, IsLimitedForEveryReader) {
    const std::string deep = nested(300000);
    const std::string gltf =
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"extras\":" + deep +
        ",\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0}]}],\"accessors\":[{\"componentType\":"
        "5126,"
        "\"count\":1,\"type\":\"VEC3\"}]}";
    const std::vector<std::string> messages = {
        refusal<FormatError>([&] { io::decode_gltf(as_span(gltf), "deep"); }), refusal<FormatError>([&] {
            io::parse_camera_path("{\"keys\":[{\"position\":" + deep + "}]}", "deep");
        }),
        refusal<FormatError>([&] { io::parse_label_map("{\"classes\":" + deep + "}", "deep.json"); })};
    for (const std::string& message : messages)
        EXPECT_NE(message.find("nested more than 512 levels deep"), std::string::npos) << message;
}

}  // namespace easypbr::json_depth_test
