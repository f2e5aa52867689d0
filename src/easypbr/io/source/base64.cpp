#include "easypbr/io/source/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace easypbr::io {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::array<int8_t, 256> base64_table() {
    std::array<int8_t, 256> table;
    table.fill(-1);
    for (size_t i = 0; i < digits.size(); ++i) table[uint8_t(digits[i])] = int8_t(i);
    table['-'] = 62;
    table['_'] = 63;
    return table;
}

}  // namespace

std::string base64_encoded(std::span<const std::byte> bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? uint32_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k) text += k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::optional<std::vector<std::byte>> base64_decoded(std::string_view text) {
    static const std::array<int8_t, 256> table = base64_table();
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::vector<std::byte> out;
    out.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int8_t digit = table[uint8_t(c)];
        if (digit < 0) return std::nullopt;
        bits = bits << 6 | uint32_t(digit);
        held += 6;
        if (held >= 8) out.push_back(std::byte(bits >> (held -= 8)));
    }
    return out;
}

}  // namespace easypbr::io
