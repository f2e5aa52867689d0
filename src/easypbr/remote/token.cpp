#include "easypbr/remote/token.h"

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "easypbr/core/ascii.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"

namespace easypbr::remote {
namespace {

constexpr size_t least_length = 32, most_length = 128;

bool is_token(std::string_view text) {
    const auto is_plain = [](char c) { return ascii::is_alnum(c) || c == '_' || c == '-'; };
    return text.size() >= least_length && text.size() <= most_length && std::ranges::all_of(text, is_plain);
}

void require_private(const InputFile& file) {
    struct stat info {};
    if (fstat(file.descriptor(), &info) != 0 || (info.st_mode & 077) != 0)
        throw FormatError(fmt::format("token file {}: others than its owner can read it: chmod 600 it",
                                      file.path().string()));
}

}  // namespace

std::string random_token() {
    std::array<unsigned char, 32> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
        throw Error(fmt::format("no random numbers: {}", std::strerror(errno)));
    std::string text;
    for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

bool same_secret(std::string_view given, std::string_view secret) {
    if (secret.empty()) return false;
    unsigned different = unsigned(given.size() != secret.size());
    for (size_t i = 0; i < given.size(); ++i)
        different |= unsigned(static_cast<unsigned char>(given[i] ^ secret[i % secret.size()]));
    return different == 0;
}

Tokens load_tokens(const std::filesystem::path& path) {
    if (path.empty()) return {random_token(), random_token()};
    InputFile file(path);
    require_private(file);
    const FileBytes bytes(std::move(file));
    std::istringstream lines{std::string(bytes.text())};
    Tokens tokens;
    std::getline(lines, tokens.control);
    if (!std::getline(lines, tokens.watch) || tokens.watch.empty()) tokens.watch = random_token();
    for (const std::string& token : {tokens.control, tokens.watch})
        if (!is_token(token))
            throw FormatError(fmt::format("token file {}: expected {} to {} letters, digits, _ or - a line",
                                          path.string(), least_length, most_length));
    if (tokens.control == tokens.watch)
        throw FormatError(fmt::format("token file {}: both lines are the same", path.string()));
    return tokens;
}

}  // namespace easypbr::remote
