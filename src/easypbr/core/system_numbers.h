// Numbers in the files of /proc and /sys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace easypbr {

/// The number that a file begins with; nothing where that is none, such as "max", or below 0, or where there
/// is no such file.
inline std::optional<uint64_t> number_in(const std::filesystem::path& path) {
    std::ifstream file(path);
    int64_t number = -1;
    return file >> number && number >= 0 ? std::optional(uint64_t(number)) : std::nullopt;
}

/// The same for the number that follows a word.
inline std::optional<uint64_t> number_after(const std::filesystem::path& path, std::string_view word) {
    std::ifstream file(path);
    for (std::string found; file >> found;) {
        int64_t number = -1;
        if (found == word && file >> number && number >= 0) return uint64_t(number);
    }
    return std::nullopt;
}

}  // namespace easypbr
