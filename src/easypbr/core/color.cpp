#include "easypbr/core/color.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/named_colors.h"
#include "easypbr/core/suggest.h"

namespace easypbr {
namespace {

Vec3 of_code(unsigned rgb) {
    return Vec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.0f;
}

std::optional<Vec3> parse_hex(std::string_view text) {
    const std::string_view digits = text.substr(1);
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    if (digits.size() == 6) return of_code(value);
    if (digits.size() == 3) return Vec3((value >> 8) & 15, (value >> 4) & 15, value & 15) / 15.0f;
    return std::nullopt;
}

std::optional<Vec3> parse_numbers(std::string_view text) {
    Vec3 color;
    const char* at = text.data();
    const char* const stop = text.data() + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [end, error] = std::from_chars(at, stop, color[i]);
        const bool last = i == 2;
        if (error != std::errc() || (last ? end != stop : end == stop || *end != ',')) return std::nullopt;
        at = end + 1;
    }
    if (!(color.minCoeff() >= 0 && color.maxCoeff() <= 1)) return std::nullopt;
    return color;
}

}  // namespace

const float* srgb8_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (int i = 0; i < 256; ++i) values[i] = linear_from_srgb(float(i) / 255.0f);
        return values;
    }();
    return table.data();
}

Vec3 srgb_from_linear(const Vec3& c) {
    return c.unaryExpr([](float v) { return srgb_from_linear(v); });
}

Vec3 linear_from_srgb(const Vec3& c) {
    const float* const of_code = srgb8_table();
    return c.unaryExpr([&](float v) {
        // Most colours come from files of 8 bits.
        const size_t code = v >= 0 && v <= 1 ? size_t(std::lrint(v * 255)) : 0;
        return float(code) / 255 == v ? of_code[code] : linear_from_srgb(v);
    });
}

Rgb8 to_rgb8(const Vec3& srgb) {
    Rgb8 result;
    for (int i = 0; i < 3; ++i)
        result[size_t(i)] = uint8_t(std::lround(std::clamp(srgb[i], 0.0f, 1.0f) * 255));
    return result;
}

std::optional<Vec3> find_color(std::string_view text) {
    if (!text.empty() && text[0] == '#') return parse_hex(text);
    if (const auto code = named_color(text)) return of_code(*code);
    return parse_numbers(text);
}

Vec3 parse_color(std::string_view text) {
    if (const auto color = find_color(text)) return *color;
    throw ArgumentError(fmt::format("expected a colour: {}, got '{}'{}", color_forms, text,
                                    did_you_mean(text, color_names())));
}

std::string to_hex(const Vec3& srgb) {
    const auto code = [&](int i) { return int(std::lround(std::clamp(srgb[i], 0.0f, 1.0f) * 255.0f)); };
    return fmt::format("#{:02x}{:02x}{:02x}", code(0), code(1), code(2));
}

}  // namespace easypbr
