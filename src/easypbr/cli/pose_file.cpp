#include "easypbr/cli/pose_file.h"

#include <fmt/format.h>

#include <charconv>
#include <string>

#include "easypbr/core/error.h"
#include "easypbr/core/file.h"

namespace easypbr::cli {
namespace {

std::vector<double> parse_numbers(std::string_view text, const fs::path& path) {
    constexpr std::string_view separators = " \t\r\n,;[]";
    std::vector<double> numbers;
    while (!text.empty()) {
        const size_t begin = std::min(text.find_first_not_of(separators), text.size());
        const size_t end = std::min(text.find_first_of(separators, begin), text.size());
        const std::string_view word = text.substr(begin, end - begin);
        text.remove_prefix(end);
        if (word.empty()) continue;
        double number = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || stop != word.data() + word.size())
            throw FormatError(fmt::format("{}: expected 16 numbers, got '{}'", path.string(), word));
        numbers.push_back(number);
    }
    return numbers;
}

}  // namespace

std::vector<double> load_pose(const std::filesystem::path& path, PoseAxes axes) {
    const FileBytes file(path);
    std::vector<double> pose = parse_numbers(file.text(), path);
    if (pose.size() != 16)
        throw FormatError(
            fmt::format("{}: expected the 16 numbers of a 4x4 matrix, got {}", path.string(), pose.size()));
    if (axes == PoseAxes::opencv)
        for (int row = 0; row < 3; ++row)
            for (int column : {1, 2}) pose[size_t(row) * 4 + size_t(column)] *= -1;
    return pose;
}

}  // namespace easypbr::cli
