#include "easypbr/scene/fields.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <type_traits>

#include "easypbr/core/error.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/settings.h"

namespace easypbr::fields_test {

namespace {

std::string message_of(const std::string& name, const std::string& text) {
    Settings settings;
    try {
        set_from_text(settings, name, text);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

/// Some value that the field takes and that is not its default.
Value other_value(const Field& field) {
    const double low = std::max(field.min, -1e3), high = std::min(field.max, 1e3);
    // Two decimals, so that the double is the nearest to a short text, as those that come from floats are.
    const double number = field.whole ? low + 6 : std::round((low + 0.37 * (high - low)) * 100) / 100;
    switch (field.type) {
        case FieldType::boolean:
            return {!std::get<bool>(field.get(Settings{}).data)};
        case FieldType::integer:
        case FieldType::number:
            return {number};
        case FieldType::color:
            return {std::vector<double>{0.1, 0.2, 0.7}};
        case FieldType::vector:
            return {std::vector<double>(field.sizes.back(), number)};
        case FieldType::text:
            return {std::string("some, text = '1'")};
        case FieldType::choice:
            return {field.choices[field.get(Settings{}).data == Value::Data(field.choices[0])]};
        case FieldType::colormap:
            return {std::string("#000080,#ffffff")};
    }
    return {};
}

template <class To, class From>
constexpr bool is_taken = std::is_assignable_v<To&, From>&& std::is_constructible_v<To, From>;

// "auto" converts to true: it would pin the setting that is to be inferred.
static_assert(!is_taken<Auto<bool>, const char*> && !is_taken<Auto<bool>, const char (&)[5]>);
static_assert(!std::is_assignable_v<Auto<bool>&, const char (&)[5]>);
static_assert(!std::is_constructible_v<Auto<bool>, void*> &&
              !std::is_constructible_v<Auto<bool>, void (*)()>);
static_assert(!std::is_convertible_v<std::nullptr_t, Auto<bool>>);
static_assert(!std::is_assignable_v<Override<bool>&, const char (&)[5]>);
static_assert(!std::is_constructible_v<Override<bool>, const char*>);

// All else stays as it is.
static_assert(is_taken<Auto<bool>, bool> && is_taken<Auto<bool>, int> && is_taken<Override<bool>, bool>);
static_assert(is_taken<Auto<bool>, AutomaticTag> && is_taken<Auto<bool>, FollowTag>);
static_assert(is_taken<Auto<std::string>, const char (&)[5]> && is_taken<Auto<std::string>, std::string>);

}  // namespace

TEST(Fields, AreDocumentedOnce) {
    std::set<std::string> names;
    for (const Field& field : fields()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        EXPECT_GT(field.doc.size(), 15u) << field.name;
        EXPECT_EQ(field.doc.back(), '.') << field.name;
        EXPECT_EQ(field.type == FieldType::choice || field.type == FieldType::colormap,
                  !field.choices.empty())
            << field.name;
        EXPECT_LT(field.min, field.max) << field.name;
        EXPECT_EQ(field.can_be_automatic, field.doc.find("utomatic: ") != std::string::npos) << field.name;
    }
}

TEST(Fields, AreComparedEachWithItsState) {
    const Settings defaults;
    EXPECT_TRUE(are_equal(defaults, Settings{}));
    for (const Field& field : fields()) {
        Settings settings;
        EXPECT_TRUE(field.same(settings, defaults)) << field.name;
        field.put(settings, other_value(field));
        EXPECT_FALSE(field.same(settings, defaults)) << field.name;
        EXPECT_FALSE(are_equal(settings, defaults)) << field.name;
        for (const Field& other : fields())
            EXPECT_EQ(other.same(settings, defaults), &other != &field) << field.name;
        if (!field.can_be_automatic || !field.is_kept) continue;
        // The same number, given and latched.
        Value latched = other_value(field);
        latched.state = Value::State::automatic;
        latched.latched = true;
        Settings inferred;
        field.put(inferred, latched);
        if (field.get(inferred).latched) {
            EXPECT_FALSE(field.same(settings, inferred)) << field.name;
        }
    }
}

// Every member of every struct, counted in settings.h; one line per group, so that changes of different
// groups do not meet.
TEST(Fields, AreComplete) {
    std::map<std::string, int> counts;
    for (const Field& field : fields()) ++counts[field.name.substr(0, field.name.find('.'))];
    // clang-format off
    const std::map<std::string, int> expected = {
        {"image", 5},
        {"camera", 14},
        {"environment", 5},
        {"background", 4},
        {"lights", 1 + 3 * 6},
        {"shadows", 3},
        {"ground", 6},
        {"shading", 3},
        {"edl", 3},
        {"ssao", 9},
        {"rays", 2},
        {"bloom", 6},
        {"depth_of_field", 4},
        {"motion_blur", 2},
        {"outline", 8},
        {"path", 4},
        {"transparency", 2},
        {"splats", 6},
        {"tonemap", 3},
        {"material", 4 + 19 + 7 + 1},
        {"style", 27},
        {"points", 1},
        {"clip", 2},
        {"annotation", 5},
        {"load", 2},
        {"limits", 1},
    };
    // clang-format on
    EXPECT_EQ(counts, expected);
}

TEST(Fields, DefaultsAreAllowed) {
    for (const Field& field : fields()) {
        const Value value = field.get(Settings{});
        EXPECT_EQ(checked(field, value), value) << field.name;
        EXPECT_EQ(value.state, field.can_be_automatic ? Value::State::automatic : Value::State::given)
            << field.name;
    }
}

TEST(Fields, EachReachesItsOwnMember) {
    for (const Field& field : fields()) {
        Settings settings;
        const Value value = other_value(field);
        set(settings, field.name, value);
        EXPECT_EQ(get(settings, field.name), value) << field.name;
        for (const Field& other : fields())
            EXPECT_EQ(other.get(settings) == other.get(Settings{}), other.name != field.name)
                << field.name << " and " << other.name;
    }
}

TEST(Fields, SurviveTheWayThroughText) {
    for (const Field& field : fields()) {
        for (const Value& value : {field.get(Settings{}), other_value(field)})
            EXPECT_EQ(parse_value(field, to_text(field, value)), value)
                << field.name << " " << to_text(field, value);
    }
}

// Any float goes through a value and its text without losing a bit, and 0.1f is written 0.1.
TEST(Fields, NumbersKeepTheirBits) {
    std::mt19937 random(1);
    Settings settings;
    const Field& exposure = field("tonemap.exposure");
    for (int i = 0; i < 100000; ++i) {
        const float number = std::bit_cast<float>(uint32_t(random()) & 0x7fffffffu);
        if (!(number <= 1e30f)) continue;
        settings.tonemap.exposure = number;
        Settings read;
        set_from_text(read, "tonemap.exposure", to_text(exposure, exposure.get(settings)));
        ASSERT_EQ(std::bit_cast<uint32_t>(*read.tonemap.exposure), std::bit_cast<uint32_t>(number)) << number;
    }
    // The shortest form of the largest float is larger than it.
    constexpr float largest = std::numeric_limits<float>::max();
    set(settings, "path.clamp", Value{double(largest)});
    set_from_text(settings, "path.clamp", to_text(field("path.clamp"), get(settings, "path.clamp")));
    EXPECT_EQ(settings.path.clamp, largest);
    EXPECT_TRUE(is_valid(field("path.clamp"), get(settings, "path.clamp")));
    settings.camera.margin = 0.1f;
    EXPECT_EQ(to_text(field("camera.margin"), get(settings, "camera.margin")), "0.1");
}

TEST(Fields, ReadCommonSpellings) {
    Settings settings;
    set_from_text(settings, "image.size", "1920x1080");
    EXPECT_EQ(settings.image.size, Vec2i(1920, 1080));
    set_from_text(settings, "background.color", "#ff0000");
    EXPECT_EQ(settings.background.color, Vec3(1, 0, 0));
    EXPECT_EQ(to_text(field("background.color"), get(settings, "background.color")), "#ff0000");
    set_from_text(settings, "camera.position", " 1, -2.5 ,+3e2 ");
    EXPECT_EQ(*settings.camera.position, Vec3d(1, -2.5, 300));
    EXPECT_TRUE(settings.camera.position.is_pinned());
    set_from_text(settings, "shading.multiple_scattering", "off");
    EXPECT_FALSE(settings.shading.multiple_scattering);
    set_from_text(settings, "tonemap.operator", "agx");
    EXPECT_EQ(settings.tonemap.tone_operator, ToneOperator::agx);
    set_from_text(settings, "tonemap.operator", "ACES");
    EXPECT_EQ(settings.tonemap.tone_operator, ToneOperator::aces);
    set_from_text(settings, "camera.up", "+Z");
    EXPECT_EQ(*settings.camera.up, "+z");
    set_from_text(settings, "camera.position", "auto");
    EXPECT_FALSE(settings.camera.position.value());
    set_from_text(settings, "camera.position", "follow");
    EXPECT_TRUE(settings.camera.position.is_follow());
    set(settings, "material.color", {std::string("white")});
    EXPECT_EQ(*settings.material.color, Vec3(1, 1, 1));
}

TEST(Fields, SayWhatTheyExpected) {
    EXPECT_EQ(message_of("camera.fov_y_deg", "400"),
              "setting 'camera.fov_y_deg': expected 1 to 170 degrees, got 400");
    EXPECT_EQ(message_of("image.samples", "1.5"),
              "setting 'image.samples': expected a whole number from 1 to 65536, got 1.5");
    EXPECT_EQ(
        message_of("image.size", "800"),
        "setting 'image.size': expected 2 numbers, each a whole number from 1 to 65536 pixels, got (800)");
    EXPECT_EQ(message_of("camera.near", "0"),
              "setting 'camera.near': expected a number of at least 1e-30 world units, or 'auto' or "
              "'follow', got 0");
    EXPECT_EQ(message_of("tonemap.operator", "acess"),
              "setting 'tonemap.operator': expected one of aces, reinhard, agx, neutral, none, "
              "got 'acess' (did you mean 'aces'?)");
    EXPECT_EQ(message_of("background.color", "whte"),
              "setting 'background.color': expected a colour: '#rgb', '#rrggbb', a name of CSS such as "
              "white, or 3 numbers from 0 to 1, got 'whte' (did you mean 'white'?)");
    EXPECT_EQ(message_of("shading.multiple_scattering", "maybe"),
              "setting 'shading.multiple_scattering': expected true or false, got 'maybe'");
    EXPECT_EQ(message_of("camera.intrinsics", "1,2,3"),
              "setting 'camera.intrinsics': expected none, 6 or 7 numbers, got (1, 2, 3)");
    EXPECT_EQ(message_of("camera.distortion", "1"),
              "setting 'camera.distortion': expected none, 4, 5 or 8 numbers, got (1)");
    EXPECT_EQ(message_of("camera.pose", "1,2"),
              "setting 'camera.pose': expected none or 16 numbers, got (1, 2)");
    EXPECT_NE(message_of("clip.planes", "1,2,3").find("expected a multiple of 4 numbers, up to "),
              std::string::npos);
    EXPECT_EQ(message_of("clip.planes", "nan,0,0,0"),
              "setting 'clip.planes': expected finite numbers, got (nan, 0, 0, 0)");
    EXPECT_EQ(message_of("clip.box", "0,2,0,1,1,1"),
              "setting 'clip.box': expected none or 6 numbers, no minimum above its maximum, got (0, 2, 0, "
              "1, 1, 1)");
    EXPECT_EQ(message_of("clip.box", "0,1,0,1,1,1"), "accepted") << "a flat box";
    EXPECT_EQ(message_of("camera.margin", "auto"), "setting 'camera.margin': expected 0 to 0.9, got 'auto'");
    for (const char* text : {"", "nan", "inf", "1e999", "12abc", "1,2"})
        EXPECT_NE(message_of("environment.rotation_deg", text), "accepted") << text;
    for (const char* text : {"1,2", "1,2,3,4", "1,,2", "1,2,x", "1,2,nan"})
        EXPECT_NE(message_of("camera.position", text), "accepted") << text;
    EXPECT_NE(message_of("background.color", "1,2,3"), "accepted");
    EXPECT_NE(message_of("camera.pose", "1,2,3"), "accepted");
    EXPECT_NE(message_of("camera.up", "north"), "accepted");
}

TEST(Fields, RefuseValuesOfAnotherType) {
    Settings settings;
    EXPECT_THROW(set(settings, "camera.fov_y_deg", {true}), ArgumentError);
    EXPECT_THROW(set(settings, "style.flat", {1.0}), ArgumentError);
    EXPECT_THROW(set(settings, "tonemap.operator", {2.0}), ArgumentError);
    EXPECT_THROW(set(settings, "background.color", {0.5}), ArgumentError);
    EXPECT_THROW(set(settings, "camera.margin", {{}, Value::State::follow}), ArgumentError);
}

TEST(Fields, SayTheSameOfAValueThatNothingHolds) {
    const auto rejected = [](const char* name, std::string_view given, std::string_view owner = {}) {
        try {
            reject_value(field(name), given, owner);
        } catch (const ArgumentError& error) {
            return std::string(error.what());
        }
    };
    EXPECT_EQ(message_of("camera.position", "a,b"),
              "setting 'camera.position': expected 3 numbers, or 'auto' or 'follow', got 'a,b'");
    EXPECT_EQ(rejected("camera.position", "[\"a\"]"),
              "setting 'camera.position': expected 3 numbers, or 'auto' or 'follow', got [\"a\"]");
    EXPECT_EQ(rejected("camera.position", "[]", "mine: "),
              "mine: camera.position: expected 3 numbers, or 'auto' or 'follow', got []");
    EXPECT_EQ(
        rejected("style.flat", std::string(100, 'x')),
        "setting 'style.flat': expected true or false, or 'auto' or 'follow', got " + std::string(80, 'x'));
}

TEST(Fields, SuggestNames) {
    EXPECT_EQ(message_of("camra.fov_y_deg", "1"),
              "there is no setting 'camra.fov_y_deg' (did you mean 'camera.fov_y_deg'?)");
    EXPECT_EQ(message_of("camera.fov", "1"),
              "there is no setting 'camera.fov' (it is called 'camera.fov_y_deg')");
    EXPECT_EQ(message_of("rougness", "1"),
              "there is no setting 'rougness' (did you mean 'material.roughness'?)");
    EXPECT_EQ(message_of("render.azimuth_deg", "1"),
              "there is no setting 'render.azimuth_deg' (did you mean 'camera.azimuth_deg'?)");
    EXPECT_EQ(message_of("margin", "1"), "there is no setting 'margin' (did you mean 'camera.margin'?)");
    EXPECT_EQ(message_of("qqqqqqqq", "1"), "there is no setting 'qqqqqqqq'");
    EXPECT_EQ(message_of("ground", "false"), "there is no setting 'ground' (it is called 'ground.mode')");
    EXPECT_EQ(message_of("material", "red"),
              "there is no setting 'material' (a group of settings: 'material.color', 'material.metallic', "
              "'material.roughness', ...)");
    EXPECT_EQ(message_of("limits", "1"),
              "there is no setting 'limits' (a group of settings: 'limits.memory')");
    EXPECT_EQ(message_of("tonemap", "aces"),
              "there is no setting 'tonemap' (a group of settings: 'tonemap.operator', 'tonemap.exposure', "
              "'tonemap.exposure_compensation')");
}

TEST(Fields, SuggestOtherProgramsWordsWithinTheGroup) {
    const auto hint = [](const std::string& name, const std::string& called) {
        EXPECT_EQ(message_of(name, "red"),
                  "there is no setting '" + name + "' (it is called '" + called + "')");
    };
    hint("background.colour", "background.color");
    hint("lights.key.colour", "lights.key.color");
    hint("ground.colour", "ground.plane_color");
    hint("material.colour", "material.color");
    hint("style.colour", "material.color");
    hint("colour", "material.color");
    hint("background.alpha", "material.opacity");
}

TEST(Fields, KeepLatchedValuesAutomatic) {
    Settings settings;
    settings.camera.position.latch(Vec3d(1, 2, 3));
    const Value value = get(settings, "camera.position");
    EXPECT_EQ(value.state, Value::State::automatic);
    EXPECT_TRUE(value.latched);
    Settings copy;
    set(copy, "camera.position", value);
    EXPECT_FALSE(copy.camera.position.is_pinned());
    EXPECT_EQ(*copy.camera.position, Vec3d(1, 2, 3));
    copy.camera.position.release();
    EXPECT_FALSE(copy.camera.position.value());
}

TEST(Auto, IsInferredLatchedPinnedOrFollowing) {
    Auto<float> setting;
    setting.latch(1);
    EXPECT_EQ(*setting, 1);
    setting.release();
    EXPECT_FALSE(setting.value());
    setting = 2.0f;
    setting.latch(3);
    setting.release();
    EXPECT_EQ(*setting, 2);
    setting = follow;
    setting.latch(4);
    EXPECT_FALSE(setting.value());
    setting = automatic;
    EXPECT_FALSE(setting.is_pinned() || setting.is_follow() || setting.value());
}

// C++ has no other way to tell: an enumeration may hold any number of its underlying type.
TEST(Settings, NumbersThatAreNoChoicesAreRefused) {
    const auto message = [](const auto& change) -> std::string {
        Settings settings;
        change(settings);
        try {
            resolve(SceneSnapshot(), settings, Vec2i(8, 8));
        } catch (const ArgumentError& error) {
            return error.what();
        }
        return "accepted";
    };
    const std::string tone = message([](Settings& s) { s.tonemap.tone_operator = ToneOperator(44); });
    EXPECT_NE(tone.find("'tonemap.operator': expected one of"), std::string::npos) << tone;
    EXPECT_NE(tone.find("44"), std::string::npos) << tone;
    const std::string below = message([](Settings& s) { s.tonemap.tone_operator = ToneOperator(-1); });
    EXPECT_NE(below.find("got '-1'"), std::string::npos) << below;
    const std::string mode = message([](Settings& s) { s.style.mode = DrawMode(99); });
    EXPECT_NE(mode.find("got '99'"), std::string::npos) << mode;
    Style style;
    style.mode = DrawMode(99);
    EXPECT_THROW(validate(style, "mesh: "), ArgumentError);
}

TEST(Auto, TakesTruthValues) {
    Auto<bool> enabled;
    enabled = false;
    EXPECT_TRUE(enabled.is_pinned());
    EXPECT_FALSE(enabled.value_or(true));
    enabled = automatic;
    EXPECT_FALSE(enabled.value());
}

TEST(Settings, StudioLightsAreWarmAndCool) {
    const Settings settings;
    EXPECT_EQ(to_text(field("lights.key.color"), get(settings, "lights.key.color")), "#fff1e0");
    EXPECT_EQ(to_text(field("lights.fill.color"), get(settings, "lights.fill.color")), "#e6efff");
    EXPECT_EQ(to_text(field("lights.rim.color"), get(settings, "lights.rim.color")), "#ffffff");
}

}  // namespace easypbr::fields_test
