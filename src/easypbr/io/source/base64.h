// Base 64: bytes as text.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::io {

/// With the digits + and /, padded.
std::string base64_encoded(std::span<const std::byte> bytes);

/// Takes - and _ for + and / too, and needs no padding. Nothing when there is a character that is no digit.
std::optional<std::vector<std::byte>> base64_decoded(std::string_view text);

}  // namespace easypbr::io
