#include <fmt/format.h>

#include "easypbr/cli/command.h"
#include "easypbr/cli/parse_errors.h"
#include "easypbr/core/cache.h"
#include "easypbr/core/error.h"

namespace easypbr::cli {
namespace {

struct CacheOptions {
    bool clear = false;
    double limit_gb = -1;
};

void declare(CLI::App& command, CacheOptions& options) {
    CLI::Option* clear = command.add_flag("--clear", options.clear, "Remove all entries");
    command
        .add_option("--limit", options.limit_gb,
                    "Remove the least recently used entries until the rest takes at most this many GB")
        ->check(at_least_zero())
        ->option_text("GB")
        ->excludes(clear);
}

std::string megabytes(uint64_t bytes) {
    return fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

int run_cache(const CacheOptions& options) {
    const bool trims = options.clear || options.limit_gb >= 0;
    const uint64_t limit = options.clear ? 0
                           : trims       ? uint64_t(std::min(options.limit_gb, 1e9) * 1e9)
                                         : cache_limit();
    const CacheUse use = trims ? trim_cache(limit) : cache_use();
    if (trims && use.bytes > limit)
        throw FileError(fmt::format("cannot remove entries of the cache {}: {} entries, {}, are left",
                                    cache_folder().string(), use.entries, megabytes(use.bytes)));
    if (options.clear) return 0;
    const std::string folder = cache_folder().string();
    fmt::print("{:<12}{}\n", "folder", folder.empty() ? "none" : folder);
    fmt::print("{:<12}{}\n", "entries", use.entries);
    fmt::print("{:<12}{}\n", "size", megabytes(use.bytes));
    fmt::print("{:<12}{}\n", "limit", megabytes(cache_limit()));
    return 0;
}

}  // namespace

void add_cache(CLI::App& app, Job& job) {
    set_job<CacheOptions>(
        *app.add_subcommand("cache", "Show or clear the cache of prefiltered environment maps"), job, declare,
        run_cache);
}

}  // namespace easypbr::cli
