// Deflate (RFC 1951), bare as ZIP archives have it or as a gzip file (RFC 1952), over zlib.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace easypbr::io {

enum class DeflateForm { bare, gzip };

/// At most so many bytes come from one.
inline constexpr size_t best_deflate_ratio = 1032;

struct Inflated {
    size_t written = 0;    ///< bytes of what was to be filled
    bool ended = false;    ///< the stream's end was reached
    bool damaged = false;  ///< what follows cannot be read
};

/// Unpacks until `out` is full or the stream ends.
Inflated inflate_into(std::string_view packed, DeflateForm form, std::span<char> out);

/// A gzip file of some bytes. Throws FormatError when zlib cannot be started.
std::string gzip(std::string_view bytes);

}  // namespace easypbr::io
