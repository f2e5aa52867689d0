// Reading words and numbers from text without copying it. Every function stops at a line's end.
#pragma once

#include <fast_float/fast_float.h>

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace easypbr::io {

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline const char* skip_blanks(const char* p, const char* end) {
    while (p != end && is_blank(*p)) ++p;
    return p;
}

/// The same up to a delimiter, which may be a blank itself.
inline const char* skip_blanks_before(const char* p, const char* end, char delimiter) {
    while (p != end && is_blank(*p) && *p != delimiter) ++p;
    return p;
}

/// The line feed that ends the line of `p`, or `end`.
inline const char* line_end(const char* p, const char* end) {
    const void* found = std::memchr(p, '\n', size_t(end - p));
    return found ? static_cast<const char*>(found) : end;
}

/// The place after the line feed that ends the line of `p`, or `end`.
inline const char* next_line(const char* p, const char* end) {
    p = line_end(p, end);
    return p == end ? end : p + 1;
}

/// The next word, empty at the line's end; moves `p` behind it.
inline std::string_view read_word(const char*& p, const char* end) {
    p = skip_blanks(p, end);
    const char* first = p;
    while (p != end && *p != '\n' && !is_blank(*p)) ++p;
    return {first, size_t(p - first)};
}

/// Behind the text in quotes that begins at `p`, in which "" is a quote; `p` where there is none that ends in
/// the line.
inline const char* skip_quoted(const char* p, const char* end) {
    if (p == end || *p != '"') return p;
    const char* const stop = line_end(p, end);
    for (const char* q = p + 1; q != stop; ++q) {
        if (*q != '"') continue;
        if (q + 1 == stop || q[1] != '"') return q + 1;
        ++q;
    }
    return p;
}

/// The rest of the line without blanks around it; moves `p` to the line's end.
inline std::string_view read_rest(const char*& p, const char* end) {
    p = skip_blanks(p, end);
    const char* first = p;
    p = line_end(p, end);
    const char* last = p;
    while (last != first && is_blank(last[-1])) --last;
    return {first, size_t(last - first)};
}

/// Reads a number (also "nan" and "inf"; too large is infinite) after blanks. False, with `p` left there, if
/// there is none.
template <class Number>
bool read_number(const char*& p, const char* end, Number& value) {
    p = skip_blanks(p, end);
    const char* first = p != end && *p == '+' ? p + 1 : p;
    const auto result = fast_float::from_chars(first, end, value);
    if (result.ec == std::errc::invalid_argument) return false;
    p = result.ptr;
    return true;
}

/// Reads a decimal integer at `p`; beyond the range of int32 it saturates. False if there is none.
inline bool read_integer(const char*& p, const char* end, int32_t& value) {
    const bool negative = p != end && *p == '-';
    const char* digit = p != end && (*p == '-' || *p == '+') ? p + 1 : p;
    const char* first = digit;
    int64_t magnitude = 0;
    for (; digit != end && unsigned(*digit - '0') < 10; ++digit)
        if (magnitude <= INT32_MAX) magnitude = magnitude * 10 + (*digit - '0');
    if (digit == first) return false;
    if (magnitude > INT32_MAX) magnitude = INT32_MAX;
    value = int32_t(negative ? -magnitude : magnitude);
    p = digit;
    return true;
}

/// Starts of consecutive pieces of about `grain` bytes that end at line ends; the last entry is the text's
/// size.
inline std::vector<size_t> line_chunks(std::string_view text, size_t grain) {
    std::vector<size_t> starts{0};
    while (starts.back() + grain < text.size()) {
        const char* end = text.data() + text.size();
        starts.push_back(size_t(next_line(text.data() + starts.back() + grain, end) - text.data()));
    }
    if (starts.back() != text.size()) starts.push_back(text.size());
    return starts;
}

}  // namespace easypbr::io
