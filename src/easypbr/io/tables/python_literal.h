// Python's literals, as far as headers of NPY files have them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace easypbr::io {

struct PythonEntry;

/// A value; tuples are lists, True and False are the integers 1 and 0.
struct PythonLiteral {
    enum Kind { none, integer, string, list, dictionary };
    Kind kind = none;
    int64_t number = 0;
    std::string text;
    std::vector<PythonLiteral> items;
    std::vector<PythonEntry> entries;

    /// The entry of a dictionary, or null.
    const PythonLiteral* find(std::string_view key) const;
};

/// Of a dictionary.
struct PythonEntry {
    std::string key;
    PythonLiteral value;
};

/// The value at the text's begin; what is not understood gives `none`, and ends what holds it.
PythonLiteral parse_python_literal(std::string_view text);

}  // namespace easypbr::io
