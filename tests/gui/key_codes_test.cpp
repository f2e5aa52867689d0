// Letters of keyboard layouts: shortcuts go by them, the camera's keys by place.
#include "easypbr/gui/key_codes.h"

#include <gtest/gtest.h>

#include <utility>

#include "easypbr/app/input.h"

namespace easypbr::gui::key_codes_test {
namespace {

/// What a key gives that is pressed and released.
int pressed(int key, const char* name, bool control) {
    KeyCodes codes;
    const int code = codes.down(key, name, control ? 2 : 0);
    EXPECT_EQ(codes.up(key), code);
    return code;
}

TEST(KeyCodes, ShortcutsGoByTheLayout) {
    // German: Z and Y are swapped. French: W types z, Q types a.
    EXPECT_EQ(pressed('Y', "z", true), 'Z');
    EXPECT_EQ(pressed('Z', "y", true), 'Y');
    EXPECT_EQ(pressed('W', "z", true), 'Z');
    EXPECT_EQ(pressed('Q', "a", true), 'A');
    EXPECT_EQ(pressed('Z', "z", true), 'Z');
    EXPECT_EQ(pressed('Z', "y", false), 'Y');
}

TEST(KeyCodes, TheCameraFliesByPlace) {
    EXPECT_EQ(pressed('W', "z", false), 'W');
    EXPECT_EQ(pressed('Q', "a", false), 'Q');
    // The French Z types w: it is no second key that flies.
    EXPECT_EQ(pressed('Z', "w", false), 'Z');
}

TEST(KeyCodes, OtherKeysKeepTheirCode) {
    EXPECT_EQ(pressed('Z', "\u044f", true), 'Z');  // Russian ya
    EXPECT_EQ(pressed('7', "7", true), '7');
    EXPECT_EQ(pressed('7', "\u00e8", false), '7');  // French
    EXPECT_EQ(pressed(app::key::escape, nullptr, false), app::key::escape);
}

// Codes of GLFW: the keypad's 0 is 320, its comma 330, its Enter 335.
TEST(KeyCodes, TheKeypadsKeysAreThoseOfTheSameName) {
    constexpr int shift = 1, num_lock = 0x20;
    namespace k = app::key;
    for (const int modifiers : {0, shift, num_lock})
        EXPECT_EQ(KeyCodes().down(335, nullptr, modifiers), k::enter);
    for (const auto& [key, code] :
         {std::pair(320, k::insert), {321, k::end}, {324, k::left}, {327, k::home}, {330, k::del}}) {
        EXPECT_EQ(KeyCodes().down(key, nullptr, 0), code);
        EXPECT_EQ(KeyCodes().down(key, nullptr, num_lock | shift), code);
        EXPECT_EQ(KeyCodes().down(key, nullptr, num_lock), key);
        EXPECT_EQ(KeyCodes().down(key, nullptr, shift), key);
    }
    EXPECT_EQ(pressed(325, nullptr, false), 325);  // 5 has no other name
    EXPECT_EQ(pressed(331, nullptr, false), 331);  // divides
}

// GLFW says how the modifiers were before the event.
TEST(KeyCodes, AModifierCountsFromItsOwnEventOn) {
    constexpr int shift = 1, control = 2, alt = 4;
    namespace k = app::key;
    EXPECT_EQ(modifiers_after(k::left_shift, true, 0), shift);
    EXPECT_EQ(modifiers_after(k::right_shift, false, shift | alt), alt);
    EXPECT_EQ(modifiers_after(k::right_control, true, shift), shift | control);
    EXPECT_EQ(modifiers_after(k::left_alt, true, 0), alt);
    EXPECT_EQ(modifiers_after('A', true, control), control);
    EXPECT_EQ(modifiers_after(k::end, false, alt), alt);
    EXPECT_EQ(modifiers_after(343, true, 0), 0);  // left super
    EXPECT_EQ(modifiers_after(348, true, 0), 0);  // menu
}

// With Control let go first it would otherwise stay down for ever.
TEST(KeyCodes, AKeyGoesUpAsItWentDown) {
    KeyCodes codes;
    EXPECT_EQ(codes.down('W', "z", 2), 'Z');
    EXPECT_EQ(codes.down('W', "z", 0), 'Z');  // repeats
    EXPECT_EQ(codes.up('W'), 'Z');
    EXPECT_EQ(codes.up('W'), 'W');
}

}  // namespace
}  // namespace easypbr::gui::key_codes_test
