// kitty: https://sw.kovidgoyal.net/kitty/graphics-protocol/, iTerm2:
// https://iterm2.com/documentation-images.html, sixel: DEC VT330/VT340 Programmer Reference, volume 2,
// chapter 14. Each is a few lines; libsixel would be a library of its own quantization for one of them.
#include "easypbr/cli/terminal_image.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/io/source/base64.h"

namespace easypbr::cli {
namespace {

constexpr std::array<std::string_view, 5> protocol_names{"none", "kitty", "iterm", "sixel", "blocks"};

std::string_view variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

TerminalProtocol asked_protocol(std::string_view name) {
    const auto found = std::ranges::find(protocol_names, name);
    if (found == protocol_names.end())
        throw ArgumentError(
            fmt::format("EASYPBR_TERMINAL: expected kitty, iterm, sixel, blocks or none, got '{}'", name));
    return TerminalProtocol(found - protocol_names.begin());
}

TerminalProtocol known_protocol() {
    const std::string_view term = variable("TERM"), program = variable("TERM_PROGRAM");
    const bool has_colors = variable("COLORTERM") == "truecolor" || variable("COLORTERM") == "24bit";
    // A multiplexer keeps the protocols of the terminal around it from the programs inside.
    if (term.starts_with("tmux") || term.starts_with("screen"))
        return has_colors ? TerminalProtocol::blocks : TerminalProtocol::none;
    if (term.find("kitty") != term.npos || term.find("ghostty") != term.npos || program == "WezTerm")
        return TerminalProtocol::kitty;
    if (program == "iTerm.app" || program == "mintty" || program == "vscode" ||
        variable("LC_TERMINAL") == "iTerm2")
        return TerminalProtocol::iterm;
    if (term.starts_with("foot") || term.starts_with("mlterm") || term.starts_with("contour"))
        return TerminalProtocol::sixel;
    return has_colors ? TerminalProtocol::blocks : TerminalProtocol::none;
}

/// The image as PNG file in base 64.
std::string encoded(const Image& image) {
    return io::base64_encoded(io::encode_png(image));
}

std::string kitty_text(const Image& image) {
    constexpr size_t chunk = 4096;
    const std::string data = encoded(image);
    std::string text;
    for (size_t at = 0; at < data.size(); at += chunk) {
        const bool more = at + chunk < data.size();
        // Transmit and display a PNG file; the terminal does not answer.
        text += fmt::format("\x1b_G{}m={};", at == 0 ? "a=T,f=100,q=2," : "", more ? 1 : 0);
        text += std::string_view(data).substr(at, chunk);
        text += "\x1b\\";
    }
    return text + "\n";
}

std::string iterm_text(const Image& image) {
    const std::string data = encoded(image);
    return fmt::format("\x1b]1337;File=inline=1;width={}px;height={}px:{}\a\n", image.width(), image.height(),
                       data);
}

using Rgb = std::array<uint8_t, 3>;

/// A pixel; nothing where more of what is behind it shows.
std::optional<Rgb> rgb_at(const Image& image, int x, int y) {
    if (y >= image.height()) return {};
    const uint8_t* p = image.at<uint8_t>(x, y);
    const int channels = image.channels();
    if (channels % 2 == 0 && p[channels - 1] < 128) return {};
    return channels < 3 ? Rgb{p[0], p[0], p[0]} : Rgb{p[0], p[1], p[2]};
}

std::string blocks_text(const Image& image) {
    constexpr std::string_view upper_half = "\u2580", lower_half = "\u2584";
    std::string text;
    const auto color = [&](int ground, const Rgb& c) {
        fmt::format_to(std::back_inserter(text), "\x1b[{};2;{};{};{}m", ground, c[0], c[1], c[2]);
    };
    for (int y = 0; y < image.height(); y += 2) {
        for (int x = 0; x < image.width(); ++x) {
            const auto upper = rgb_at(image, x, y), lower = rgb_at(image, x, y + 1);
            text += "\x1b[0m";
            if (upper) color(38, *upper);
            if (lower) color(upper ? 48 : 38, *lower);
            text += upper ? upper_half : lower ? lower_half : " ";
        }
        text += "\x1b[0m\n";
    }
    return text;
}

// Sixel: a palette of 6 x 7 x 6 colours, which ordered dithering mixes.
constexpr std::array<int, 3> palette_steps{6, 7, 6};
constexpr int palette_size = palette_steps[0] * palette_steps[1] * palette_steps[2];

/// Bayer's matrix.
constexpr std::array<std::array<int, 4>, 4> bayer{
    {{0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}}};

/// The palette's colour of a pixel; -1: none.
int palette_index(const Image& image, int x, int y) {
    const auto color = rgb_at(image, x, y);
    if (!color) return -1;
    const double threshold = (bayer[size_t(y % 4)][size_t(x % 4)] + 0.5) / 16;
    int index = 0;
    for (size_t c = 0; c < 3; ++c) {
        const int steps = palette_steps[c];
        index = index * steps + std::min(steps - 1, int((*color)[c] / 255.0 * (steps - 1) + threshold));
    }
    return index;
}

std::string sixel_palette() {
    std::string text;
    for (int i = 0; i < palette_size; ++i) {
        const int blue = i % palette_steps[2], green = i / palette_steps[2] % palette_steps[1],
                  red = i / palette_steps[2] / palette_steps[1];
        // In percent.
        fmt::format_to(std::back_inserter(text), "#{};2;{};{};{}", i, red * 100 / (palette_steps[0] - 1),
                       green * 100 / (palette_steps[1] - 1), blue * 100 / (palette_steps[2] - 1));
    }
    return text;
}

/// Columns of six pixels of one colour, the bits of a character from its top; equal ones with their number.
std::string sixel_row(const std::vector<uint8_t>& columns) {
    std::string text;
    for (size_t x = 0, end = 0; x < columns.size(); x = end) {
        while (end < columns.size() && columns[end] == columns[x]) ++end;
        const char six = char('?' + columns[x]);
        if (end - x > 3)
            text += fmt::format("!{}{}", end - x, six);
        else
            text.append(end - x, six);
    }
    return text;
}

std::string sixel_text(const Image& image) {
    const int w = image.width(), h = image.height();
    // Pixels that no colour sets stay as they are.
    std::string text = fmt::format("\x1bP0;1q\"1;1;{};{}", w, h) + sixel_palette();
    for (int top = 0; top < h; top += 6) {
        std::array<std::vector<uint8_t>, palette_size> planes;
        for (int y = top; y < std::min(top + 6, h); ++y)
            for (int x = 0; x < w; ++x) {
                const int index = palette_index(image, x, y);
                if (index < 0) continue;
                std::vector<uint8_t>& plane = planes[size_t(index)];
                plane.resize(size_t(w));
                plane[size_t(x)] |= uint8_t(1 << (y - top));
            }
        for (int i = 0; i < palette_size; ++i)
            if (!planes[size_t(i)].empty()) text += fmt::format("#{}{}$", i, sixel_row(planes[size_t(i)]));
        text += '-';
    }
    return text + "\x1b\\\n";
}

}  // namespace

Terminal terminal_of_stdout() {
    if (!::isatty(STDOUT_FILENO)) return {};
    const std::string_view asked = variable("EASYPBR_TERMINAL");
    Terminal terminal;
    terminal.protocol = asked.empty() ? known_protocol() : asked_protocol(asked);
    winsize window{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0) return terminal;
    // The prompt comes below.
    const int rows = std::max(int(window.ws_row) - 1, 0);
    if (terminal.protocol == TerminalProtocol::blocks)
        terminal.most = {window.ws_col, 2 * rows};
    else if (window.ws_row > 0)
        terminal.most = {window.ws_xpixel, int(window.ws_ypixel) * rows / window.ws_row};
    return terminal;
}

Vec2i fitted_to(const Terminal& terminal, Vec2i size) {
    if (terminal.most.minCoeff() <= 0) return size;
    const double scale =
        std::min({1.0, double(terminal.most.x()) / size.x(), double(terminal.most.y()) / size.y()});
    return (size.cast<double>() * scale).array().round().cast<int>().max(1).matrix();
}

std::string terminal_text(const Image& image, TerminalProtocol protocol) {
    switch (protocol) {
        case TerminalProtocol::kitty:
            return kitty_text(image);
        case TerminalProtocol::iterm:
            return iterm_text(image);
        case TerminalProtocol::sixel:
            return sixel_text(image);
        case TerminalProtocol::blocks:
            return blocks_text(image);
        case TerminalProtocol::none:
            break;
    }
    return {};
}

}  // namespace easypbr::cli
