// Which letter a key stands for: shortcuts go by what is printed on it, the camera's keys by where it lies.
#pragma once

#include <algorithm>
#include <map>
#include <string_view>

#include "easypbr/app/input.h"
#include "easypbr/core/ascii.h"

namespace easypbr::gui {

/// The modifiers that are held after a key's event. `before`: those before it, as GLFW tells them with the
/// event: bits of Shift, Control and Alt.
inline int modifiers_after(int key, bool down, int before) {
    namespace k = app::key;
    const int left = key >= k::right_shift ? key - k::right_shift : key - k::left_shift;
    if (left < 0 || left > k::left_alt - k::left_shift) return before;
    return down ? before | 1 << left : before & ~(1 << left);
}

/// What a key of the keypad stands for: Enter always, the others while they type no digits; any other key for
/// itself. `modifiers`: GLFW's bits.
inline int without_keypad(int key, int modifiers) {
    namespace k = app::key;
    constexpr int first = 320, comma = 330, enter = 335, shift = 1, num_lock = 0x20;
    constexpr int names[] = {k::insert, k::end,  k::down, k::page_down, k::left, 325,
                             k::right,  k::home, k::up,   k::page_up,   k::del};
    if (key == enter) return k::enter;
    // Shift turns it round.
    const bool digits = !(modifiers & num_lock) == !!(modifiers & shift);
    return key >= first && key <= comma && !digits ? names[key - first] : key;
}

/// The keys that are down in a window, as codes of app::InputEvent.
class KeyCodes {
  public:
    /// The code of a key that goes down, or that repeats. `key`: its place, as the letter that a US keyboard
    /// has there; `name`: what the layout has there, UTF-8, null when it types nothing; `modifiers`: GLFW's
    /// bits. With Control it is the layout's letter; without, W A S D Q E are places, and all other letters
    /// those of the layout. A layout without ASCII letters leaves the place's.
    int down(int key, const char* name, int modifiers) {
        return down_.try_emplace(key, code(key, name, modifiers)).first->second;
    }
    /// The code that the key had when it went down, whatever else has changed meanwhile.
    int up(int key) {
        const auto held = down_.find(key);
        if (held == down_.end()) return key;
        const int code = held->second;
        down_.erase(held);
        return code;
    }

  private:
    static bool flies(int code) { return std::ranges::count(std::string_view("WASDQE"), code) > 0; }
    static int code(int key, const char* name, int modifiers) {
        constexpr int control = 2;
        const bool is_letter = name && ascii::is_alpha(name[0]) && name[1] == 0;
        if (!is_letter) return without_keypad(key, modifiers);
        const int letter = static_cast<unsigned char>(ascii::to_upper(name[0]));
        return !(modifiers & control) && (flies(key) || flies(letter)) ? key : letter;
    }

    std::map<int, int> down_;  ///< code by place
};

}  // namespace easypbr::gui
