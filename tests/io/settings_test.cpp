#include <gtest/gtest.h>

#include <functional>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/io/settings/settings_io.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/settings.h"
#include "io/temporary_folder.h"

namespace easypbr::settings_test {

namespace {

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

std::string parse_message(const std::string& json) {
    return message_of([&] { io::parse_settings(json, "look.json"); });
}

}  // namespace

TEST(SettingsFile, DefaultsRoundTripInEveryField) {
    const Settings settings;
    const Settings read = io::parse_settings(io::to_json({settings, {}, {}}), "x").settings;
    for (const Field& field : fields()) EXPECT_EQ(field.get(read), field.get(settings)) << field.name;
}

TEST(SettingsFile, KeepsWhatIsAutomaticPinnedAndFollowing) {
    Settings settings;
    settings.camera.position.latch(Vec3d(1.0 / 3, -2e-17, 1e20));
    settings.camera.target = follow;
    settings.camera.near = 0.1;
    settings.tonemap.exposure.latch(0.1f);
    settings.lights.key.intensity = 1e-7f;
    settings.image.size = {1920, 1080};
    settings.background.color = Vec3(0.1f, 0.2f, 1.0f / 3);
    const std::string json = io::to_json({settings, {}, {}});
    const Settings read = io::parse_settings(json, "x").settings;
    // Bit for bit: doubles and floats are written with as many digits as give them back.
    EXPECT_EQ(*read.camera.position, *settings.camera.position);
    EXPECT_FALSE(read.camera.position.is_pinned());
    EXPECT_TRUE(read.camera.target.is_follow());
    EXPECT_TRUE(read.camera.near.is_pinned());
    EXPECT_EQ(*read.camera.near, 0.1);
    EXPECT_EQ(*read.tonemap.exposure, 0.1f);
    EXPECT_FALSE(read.tonemap.exposure.is_pinned());
    EXPECT_EQ(*read.lights.key.intensity, 1e-7f);
    EXPECT_FALSE(read.lights.fill.intensity.value().has_value());
    EXPECT_EQ(read.image.size, settings.image.size);
    EXPECT_EQ(read.background.color, settings.background.color);
    EXPECT_NE(json.find("\"auto\": 0.1\n"), std::string::npos) << json;
    EXPECT_EQ(io::to_json({read, {}, {}}), json);
}

TEST(SettingsFile, KeepsLightsAndFiles) {
    Light lamp;
    lamp.type = LightType::spot;
    lamp.enabled = false;
    lamp.position = {0.1, 1e-30, 3e20};
    lamp.direction = {1, 0, 0};
    lamp.color = {0.3f, 0.7f, 1};
    lamp.intensity = 1.0f / 3;
    lamp.inner_cone_deg = 12;
    lamp.outer_cone_deg = 34;
    lamp.range = 56;
    lamp.casts_shadows = false;
    lamp.radius = 0.7f;
    lamp.angular_radius_deg = 3;
    Light inferred;
    inferred.radius.latch(0.3f);
    const TemporaryFolder folder;
    io::save_settings({{}, {{"lamp", lamp}, {"inferred", inferred}, {"plain", {}}}, {{"a/b.ply", "0123"}}},
                      folder / "look.json");
    const io::SettingsFile read = io::load_settings(folder / "look.json");
    const Light& back = read.lights.at("lamp");
    EXPECT_EQ(back.type, lamp.type);
    EXPECT_EQ(back.enabled, lamp.enabled);
    EXPECT_EQ(back.position, lamp.position);
    EXPECT_EQ(back.direction, lamp.direction);
    EXPECT_EQ(back.color, lamp.color);
    EXPECT_EQ(back.intensity, lamp.intensity);
    EXPECT_EQ(back.inner_cone_deg, lamp.inner_cone_deg);
    EXPECT_EQ(back.outer_cone_deg, lamp.outer_cone_deg);
    EXPECT_EQ(back.range, lamp.range);
    EXPECT_EQ(back.casts_shadows, lamp.casts_shadows);
    EXPECT_TRUE(back.radius.is_pinned());
    EXPECT_EQ(back.radius.value(), lamp.radius.value());
    EXPECT_EQ(back.angular_radius_deg, lamp.angular_radius_deg);
    EXPECT_FALSE(read.lights.at("inferred").radius.is_pinned());
    EXPECT_EQ(*read.lights.at("inferred").radius, 0.3f);
    EXPECT_FALSE(read.lights.at("plain").radius.value().has_value());
    EXPECT_EQ(read.files.at("a/b.ply"), "0123");
    lamp.range = -1;
    EXPECT_THROW(io::to_json({{}, {{"lamp", lamp}}, {}}), ArgumentError) << "it could not be read again";
}

// JSON is UTF-8. "caf\xe9" is Latin-1, and with another letter for its last byte would name another file.
TEST(SettingsFile, RefusesNamesThatAreNotUtf8) {
    const std::string name = "caf\xe9", utf8 = "caf\xc3\xa9";
    const auto message = [](const io::SettingsFile& file) { return message_of([&] { io::to_json(file); }); };
    io::SettingsFile file;
    file.settings.environment.file = name;
    const std::string expected =
        "expected UTF-8, which settings are written in, got '" + name + "': rename it";
    EXPECT_EQ(message(file), "setting 'environment.file': " + expected);
    const TemporaryFolder folder;
    write_file(folder / "look.json", "before");
    EXPECT_THROW(io::save_settings(file, folder / "look.json"), ArgumentError);
    EXPECT_EQ(FileBytes(folder / "look.json").text(), "before");
    EXPECT_EQ(message({{}, {{name, {}}}, {}}), "name of a light: " + expected);
    EXPECT_EQ(message({{}, {}, {{name, "0123"}}}), "name of a file: " + expected);
    file.settings.environment.file = utf8;
    EXPECT_EQ(io::parse_settings(io::to_json(file), "x").settings.environment.file, utf8);
}

TEST(SettingsFile, SaysWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> table = {
        {"", "cannot read look.json, line 1, column 1: expected JSON, got the end of the text"},
        {"{\"easypbr\": 1,\n \"settings\": }",
         "cannot read look.json, line 2, column 14: expected JSON, got '}'"},
        {"[]", "\"easypbr\": 1"},
        {"{}", "\"easypbr\": 1"},
        {"{\"easypbr\": 2}", "got 2"},
        {"{\"easypbr\": 1, \"setings\": {}}", "unknown key 'setings'"},
        {"{\"easypbr\": 1, \"settings\": 3}", "expected an object"},
        {"{\"easypbr\": 1, \"settings\": {\"tonemap\": {\"expossure\": 1}}}", "tonemap.exposure"},
        {"{\"easypbr\": 1, \"settings\": {\"image\": {\"samples\": \"many\"}}}", "image.samples"},
        {"{\"easypbr\": 1, \"settings\": {\"image\": {\"samples\": null}}}", "image.samples"},
        {"{\"easypbr\": 1, \"settings\": {\"image\": {\"samples\": {\"auto\": 3}}}}", "image.samples"},
        {"{\"easypbr\": 1, \"settings\": {\"image\": {\"size\": [1, \"x\"]}}}",
         "setting 'image.size': expected 2 numbers, each a whole number from 1 to 65536 pixels, got "
         "[1,\"x\"]"},
        {"{\"easypbr\": 1, \"settings\": {\"background\": {\"color\": \"whte\"}}}",
         "setting 'background.color': expected a colour: '#rgb', '#rrggbb', a name of CSS such as white, "
         "or 3 numbers from 0 to 1, got 'whte' (did you mean 'white'?)"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"type\": \"spott\"}}}", "did you mean 'spot'"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"colour\": [1, 1, 1]}}}", "colour"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"color\": [1, 1]}}}",
         "light 'a': color: expected 3 numbers, got (1, 1)"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"range\": null}}}", "light 'a': range: expected"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"range\": 1e39}}}", "light 'a': range: expected"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"enabled\": 1}}}",
         "light 'a': enabled: expected true or false, got 1"},
        {"{\"easypbr\": 1, \"lights\": {\"a\": {\"radius\": -2}}}", "light 'a': radius: expected"},
        {"{\"easypbr\": 1, \"files\": {\"a\": 1}}", "files 'a'"},
    };
    for (const auto& [json, expected] : table) {
        const std::string message = parse_message(json);
        EXPECT_NE(message.find(expected), std::string::npos) << json << "\n" << message;
        EXPECT_NE(message.find("look.json"), std::string::npos) << message;
    }
    EXPECT_THROW(io::parse_settings("{\"easypbr\": 1, \"settings\": {\"tone\": {\"x\": 1}}}", "x"),
                 NameError);
    EXPECT_THROW(io::load_settings("missing.json"), FileError);
}

TEST(SettingsFile, OfDeepJsonIsRefused) {
    const std::string deep = std::string(300000, '[') + std::string(300000, ']');
    const std::string message = parse_message("{\"easypbr\":1,\"settings\":" + deep + "}");
    EXPECT_NE(message.find("nested more than 512 levels deep"), std::string::npos) << message;
}

TEST(SettingsFile, HashesContent) {
    const TemporaryFolder folder;
    write_file(folder / "a", std::string_view("content"));
    write_file(folder / "b", std::string_view("content"));
    write_file(folder / "c", std::string_view("contents"));
    EXPECT_EQ(io::hash_file(folder / "a"), io::hash_file(folder / "b"));
    EXPECT_NE(io::hash_file(folder / "a"), io::hash_file(folder / "c"));
    EXPECT_EQ(io::hash_file(folder / "a").size(), 32u);
    EXPECT_THROW(io::hash_file(folder / "missing"), FileError);
}

}  // namespace easypbr::settings_test
