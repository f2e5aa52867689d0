// Zstandard (RFC 8878), over libzstd.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace easypbr::io {

/// Whether a whole frame, or several, fill `out` to its last byte and no further.
bool unpack_zstandard(std::string_view packed, std::span<char> out);

}  // namespace easypbr::io
