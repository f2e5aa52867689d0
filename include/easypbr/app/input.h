// What a person does with mouse and keyboard, as plain values: no window system is known here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "easypbr/core/math.h"

namespace easypbr::app {

enum class MouseButton { left, right, middle };

/// Letters and digits are their capital ASCII codes, letters as the keyboard's layout has them; these are the
/// others that mean something here.
namespace key {
inline constexpr int space = 32, escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260,
                     del = 261, right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267,
                     home = 268, end = 269, f1 = 290, f12 = 301, left_shift = 340, left_control = 341,
                     left_alt = 342, right_shift = 344, right_control = 345, right_alt = 346;
}

struct InputEvent {
    /// Those up to scroll have a position. bind_gui.cpp and panels.py name them in this order.
    enum class Kind {
        move,     ///< the pointer is at `position`
        press,    ///< of `button`
        release,  ///< of `button`
        scroll,   ///< by `scroll` notches
        key_down,
        key_up,
        text,        ///< of one `code` point
        drop,        ///< files `paths` were dropped
        resize,      ///< the picture has another `size` from now on
        focus_lost,  ///< keys and buttons count as released
        leave        ///< the pointer is over the picture no more
    };
    Kind kind = Kind::move;
    Vec2d position{0, 0};  ///< pixels of the picture, (0, 0) is the top left corner
    MouseButton button = MouseButton::left;
    int key = 0;
    bool repeat = false;                               ///< key_down and text: of a key that is held
    bool shift = false, control = false, alt = false;  ///< held, after the event
    Vec2d scroll{0, 0};                                ///< y: positive away from the person
    uint32_t code = 0;
    std::vector<std::string> paths;
    Vec2i size{0, 0};
    double time = 0;  ///< seconds, from any beginning
};

}  // namespace easypbr::app
