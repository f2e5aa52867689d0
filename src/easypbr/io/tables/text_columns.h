// The columns of a text file of points: what separates them and what they hold, told from a header or from
// the numbers themselves.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

/// What stands before the points of a text file, and how the points are written.
struct TextLayout {
    const char* body = nullptr;  ///< where the rows begin
    TextStyle style;
    std::vector<std::string> names;  ///< of a header; empty: there is none
    std::optional<size_t> count;     ///< of PTS files: the number of points, alone in the first line
};

/// A header is a line of words before the first row, perhaps behind '#' or "//".
TextLayout find_text_layout(const Source& source);

/// The cells of the line at `p` without blanks and quotes around them, up to a comment behind them.
/// Delimiters in quotes separate nothing; behind the last one is a cell, too.
std::vector<std::string_view> split_cells(const char* p, const char* end, const TextStyle& style);

/// Names for columns without a header, from sample rows: x y z, then, in any order that the numbers allow,
/// one normal, one colour, intensities and labels (see docs/formats.md). `intensity_first`: a single column
/// after the positions is taken before a colour, as PTS has them.
std::vector<std::string> guess_columns(const std::vector<std::vector<double>>& samples, bool intensity_first);

}  // namespace easypbr::io
