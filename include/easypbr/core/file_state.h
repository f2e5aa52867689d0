// What tells whether a file has changed since it was read.
#pragma once

#include <cstdint>
#include <filesystem>

namespace easypbr {

struct FileState {
    std::uintmax_t size = 0;               ///< in bytes
    std::filesystem::file_time_type time;  ///< when it was changed last

    bool operator==(const FileState&) const = default;
};

}  // namespace easypbr
