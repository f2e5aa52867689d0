// Images in a terminal, by the protocols that terminals have for them.
#pragma once

#include <string>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr::cli {

/// kitty: the graphics protocol of kitty; iterm: inline images of iTerm2; sixel: DEC's graphics in 252
/// colours; blocks: characters that are half a pixel's column each, on any terminal of 24-bit colours.
enum class TerminalProtocol { none, kitty, iterm, sixel, blocks };

struct Terminal {
    TerminalProtocol protocol = TerminalProtocol::none;
    Vec2i most{0, 0};  ///< pixels of an image that has room; 0: unknown
};

/// The terminal that standard output goes to; none where it is no terminal, or not known to show images.
/// EASYPBR_TERMINAL says which protocol it understands, else the variables by which terminals name
/// themselves. Throws ArgumentError when EASYPBR_TERMINAL names none.
Terminal terminal_of_stdout();

/// A size of the same shape that has room.
Vec2i fitted_to(const Terminal& terminal, Vec2i size);

/// What shows an image, of 8 bits per channel, when it is printed.
std::string terminal_text(const Image& image, TerminalProtocol protocol);

}  // namespace easypbr::cli
