#include "easypbr/cli/written_paths.h"

#include <fmt/format.h>

#include <map>

#include "easypbr/cli/command.h"

namespace easypbr::cli {
namespace {

/// Without links and dots; empty for what is there and no file.
fs::path resolved(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) return {};
    std::error_code failed;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path, ignored), failed);
    return failed ? fs::absolute(path, ignored).lexically_normal() : whole;
}

}  // namespace

void check_paths(std::string_view command, const std::vector<NamedPath>& written,
                 const std::vector<NamedPath>& read) {
    std::map<fs::path, std::string> options;
    for (const NamedPath& output : written) {
        const fs::path file = resolved(output.path);
        if (file.empty()) continue;
        const auto [first, is_new] = options.emplace(file, output.option);
        if (!is_new)
            throw UsageError(fmt::format("{}: {} and {} would both write {}", command, first->second,
                                         output.option, output.path.string()));
    }
    for (const NamedPath& input : read) {
        std::error_code ignored;
        if (!fs::exists(input.path, ignored)) continue;
        if (const auto output = options.find(resolved(input.path)); output != options.end())
            throw UsageError(fmt::format("{}: {} would write over {}, which {} reads", command,
                                         output->second, input.path.string(), input.option));
    }
}

}  // namespace easypbr::cli
