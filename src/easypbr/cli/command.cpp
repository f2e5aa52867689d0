#include "easypbr/cli/command.h"

#include <fmt/format.h>

#include <algorithm>

#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::cli {

void require(bool given, std::string_view command, std::string_view what) {
    if (!given) throw UsageError(fmt::format("{}: expected {}", command, what));
}

bool is_image_file(const fs::path& path) {
    const std::vector<std::string> known = io::writable_image_extensions();
    return std::find(known.begin(), known.end(), extension_of(path)) != known.end();
}

}  // namespace easypbr::cli
