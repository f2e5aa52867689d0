#include "easypbr/io/mesh/content_format.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "easypbr/core/ascii.h"
#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

/// What is looked at; a comment that is longer hides the format.
constexpr size_t looked_at = 1 << 16;

struct Magic {
    std::string_view begin;
    const char* format;
};
constexpr std::array<Magic, 9> magics{{{"ply\n", "ply"},
                                       {"ply\r", "ply"},
                                       {"glTF", "glb"},
                                       {"\x93NUMPY", "npy"},
                                       {"PK\x03\x04", "npz"},
                                       {"LASF", "las"},
                                       {"# .PCD", "pcd"},
                                       {"\x1f\x8b", "spz"},
                                       {"NGSP", "spz"}}};

constexpr std::array<std::string_view, 11> obj_keywords{"v", "vt", "vn", "vp",     "f",     "l",
                                                        "o", "g",  "s",  "mtllib", "usemtl"};

const char* format_of_magic(std::string_view bytes) {
    for (const Magic& magic : magics)
        if (bytes.starts_with(magic.begin)) return magic.format;
    return nullptr;
}

/// Whether the size is that of a binary STL file with as many facets as it says.
bool is_binary_stl(std::string_view bytes) {
    constexpr size_t header_bytes = 84, facet_bytes = 50;
    if (bytes.size() <= header_bytes) return false;
    uint32_t count;
    std::memcpy(&count, bytes.data() + header_bytes - sizeof count, sizeof count);
    return bytes.size() == header_bytes + size_t(count) * facet_bytes;
}

bool is_text(std::string_view bytes) {
    return std::ranges::none_of(
        bytes, [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\n' && !is_blank(c); });
}

/// The words of a line, between blanks, commas or semicolons, in lower case.
std::vector<std::string> words_of(std::string_view line) {
    std::vector<std::string> words(1);
    for (const char c : line) {
        if (!is_blank(c) && c != ',' && c != ';')
            words.back() += ascii::to_lower(c);
        else if (!words.back().empty())
            words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

bool is_number_word(const std::string& word) {
    const char* p = word.data();
    const char* end = p + word.size();
    double value;
    return read_number(p, end, value) && p == end;
}

bool names_position(const std::vector<std::string>& words) {
    return std::ranges::all_of(std::array{"x", "y", "z"}, [&](const char* axis) {
        return std::ranges::find(words, axis) != words.end();
    });
}

/// "OFF490 518 0": files of ModelNet have no blank before the first count.
bool is_off_with_count(std::string_view word) {
    return word.size() > 3 && word.starts_with("off") && std::ranges::all_of(word.substr(3), ascii::is_digit);
}

/// The format that a line of a text belongs to; empty when the line does not tell.
std::string format_of_line(std::string_view line, bool is_first, bool after_count) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) return {};
    const bool is_comment = words[0].starts_with('#') || words[0].starts_with("//");
    if (is_comment) return names_position(words) ? "xyz" : "";
    if (words[0].starts_with('{')) return "gltf";
    if (is_first && words[0] == "solid") return "stl";
    if (words[0].ends_with("off") || is_off_with_count(words[0])) return "off";
    if (words[0] == "version" || words[0] == "fields") return "pcd";
    if (std::ranges::find(obj_keywords, words[0]) != obj_keywords.end()) return "obj";
    if (names_position(words)) return "xyz";
    const bool is_row =
        words.size() >= 3 && std::ranges::all_of(words.begin(), words.begin() + 3, is_number_word);
    return !is_row ? "" : after_count ? "pts" : "xyz";
}

std::string format_of_text(std::string_view text) {
    bool is_first = true, after_count = false;
    for (const char *p = text.data(), *end = p + text.size(); p != end; p = next_line(p, end)) {
        const std::string_view line = read_rest(p, end);
        if (line.empty()) continue;
        if (std::string format = format_of_line(line, is_first, after_count); !format.empty()) return format;
        after_count = is_first && is_number_word(std::string(line));
        if (!after_count && !line.starts_with('#') && !line.starts_with("//")) return {};
        is_first = false;
    }
    return {};
}

}  // namespace

std::string format_of_content(std::string_view bytes) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (const char* format = format_of_magic(bytes)) return format;
    if (is_binary_stl(bytes)) return "stl";
    if (bytes.starts_with(byte_order_mark)) {
        bytes.remove_prefix(byte_order_mark.size());
        if (const char* format = format_of_magic(bytes)) return format;
    }
    const std::string_view begin = bytes.substr(0, looked_at);
    return is_text(begin) ? format_of_text(begin) : std::string();
}

}  // namespace easypbr::io
