// Secrets that let a client in.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace easypbr::remote {

/// Who holds `control` may change what is seen, who holds `watch` sees it.
struct Tokens {
    std::string control, watch;
    bool asked = true;  ///< false: whoever can send messages controls
};

/// 256 random bits of the system as 64 hexadecimal digits. Throws Error when the system gives none.
std::string random_token();

/// Whether two texts are equal, in a time that depends on the length of `given` alone.
bool same_secret(std::string_view given, std::string_view secret);

/// The secrets of a file: the first line controls, the second watches and is random where it is missing; 32
/// to 128 of the characters A-Z a-z 0-9 _ - each. An empty path: both are random. Throws FileError, and
/// FormatError for another content and for a file that others than its owner can read.
Tokens load_tokens(const std::filesystem::path& path);

}  // namespace easypbr::remote
