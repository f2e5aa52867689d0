#include "easypbr/io/tables/text_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/vertex_arrays.h"

namespace easypbr::io {
namespace {

bool is_number(std::string_view cell) {
    double value;
    const char* p = cell.data();
    return read_number(p, cell.data() + cell.size(), value) && p == cell.data() + cell.size();
}

/// Blanks, tabs, commas or semicolons, whatever the line has; commas may stand within what semicolons
/// separate. What stands in quotes or behind a comment separates nothing.
char delimiter_in(std::string_view line) {
    char found = 0;
    const char* const end = line.data() + line.size();
    for (const char* p = line.data(); p != end;) {
        if (*p == ';') return ';';
        if (*p == ',') found = ',';
        if (*p == '#' && p != line.data() && is_blank(p[-1])) break;
        const char* behind = skip_quoted(p, end);
        p = behind == p ? p + 1 : behind;
    }
    return found;
}

size_t parse_count(const Source& source, std::string_view cell) {
    size_t count = 0;
    const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), count);
    if (result.ec != std::errc() || result.ptr != cell.data() + cell.size() || count > INT32_MAX)
        fail_at_line(
            source, cell.data(),
            fmt::format("the number of points expected, 0 to {}, found '{}'", INT32_MAX, cell.substr(0, 40)));
    return count;
}

/// A name without its unit: "X (m)", "x[m]".
std::string without_unit(std::string_view cell) {
    const size_t end = std::min(cell.find_first_of("(["), cell.size());
    std::string_view name = cell.substr(0, end);
    while (!name.empty() && is_blank(name.back())) name.remove_suffix(1);
    return std::string(name.empty() ? cell : name);
}

/// The names in a line, or nothing when they do not say where the points are.
std::vector<std::string> header_names(std::string_view line, char delimiter) {
    const TextStyle style{.delimiter = delimiter};
    std::vector<std::string> names;
    for (const std::string_view cell : split_cells(line.data(), line.data() + line.size(), style))
        names.push_back(without_unit(cell));
    // A delimiter at the end separates nothing.
    if (!names.empty() && names.back().empty()) names.pop_back();
    return std::ranges::any_of(names, is_known_field) ? names : std::vector<std::string>();
}

/// The columns of the sample rows from one on, as seen by the guesses.
class Columns {
  public:
    explicit Columns(const std::vector<std::vector<double>>& samples) : samples_(samples) {}

    size_t count() const { return samples_.empty() ? 0 : samples_[0].size(); }

    /// Whether three columns are unit vectors (or zero, for points without a normal).
    bool is_normal(size_t first) const {
        bool any = false;
        const bool all = every_triple(first, [&](double x, double y, double z) {
            const double length = std::sqrt(x * x + y * y + z * z);
            any = any || length > 0;
            return length == 0 || std::abs(length - 1) < 0.02;
        });
        return all && any;
    }

    /// Whether three columns are bytes, or all are within 0 .. 1.
    bool is_color(size_t first) const {
        const auto is_byte = [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); };
        const auto is_part = [](double v) { return v >= 0 && v <= 1; };
        return every_triple(first, [&](double r, double g,
                                       double b) { return is_byte(r) && is_byte(g) && is_byte(b); }) ||
               every_triple(first, [&](double r, double g, double b) {
                   return is_part(r) && is_part(g) && is_part(b);
               });
    }

    bool is_whole(size_t column) const {
        return std::ranges::all_of(samples_, [&](const auto& row) {
            return row[column] == std::floor(row[column]) && std::abs(row[column]) < 1e6;
        });
    }

  private:
    template <class Test>
    bool every_triple(size_t first, Test&& test) const {
        return first + 3 <= count() && std::ranges::all_of(samples_, [&](const auto& row) {
                   return test(row[first], row[first + 1], row[first + 2]);
               });
    }

    const std::vector<std::vector<double>>& samples_;
};

/// Names columns from the left.
class Guess {
  public:
    Guess(const Columns& columns, bool intensity_first)
        : columns_(columns), intensity_first_(intensity_first) {}

    std::vector<std::string> names() {
        take({"x", "y", "z"});
        while (names_.size() < columns_.count()) take_next();
        return std::move(names_);
    }

  private:
    void take(std::vector<std::string> names) { names_.insert(names_.end(), names.begin(), names.end()); }

    void take_next() {
        const size_t at = names_.size(), left = columns_.count() - at;
        const bool before_color = intensity_first_ && at == 3 && left >= 4 && columns_.is_color(at + 1);
        if (!before_color && !has("nx") && columns_.is_normal(at)) return take({"nx", "ny", "nz"});
        if (!before_color && !has("red") && columns_.is_color(at)) return take({"red", "green", "blue"});
        if (!lost_ && left == 1 && at > 3 && columns_.is_whole(at)) return take({"label"});
        if (!lost_ && !has("intensity") && (left == 1 || left >= 4)) return take({"intensity"});
        // From here on columns may be anything.
        lost_ = true;
        take({fmt::format("column_{}", at + 1)});
    }

    bool has(std::string_view name) const { return std::ranges::find(names_, name) != names_.end(); }

    const Columns& columns_;
    const bool intensity_first_;
    bool lost_ = false;
    std::vector<std::string> names_;
};

}  // namespace

std::vector<std::string_view> split_cells(const char* p, const char* end, const TextStyle& style) {
    std::vector<std::string_view> cells;
    const char* stop = line_end(p, end);
    bool goes_on = p != stop;
    while (goes_on) {
        p = skip_blanks_before(p, stop, style.delimiter);
        const char* first = p;
        p = skip_quoted(p, stop);
        while (p != stop && (style.delimiter ? *p != style.delimiter : !is_blank(*p))) {
            const bool is_in_cell = style.delimiter ? p != first && is_blank(p[-1]) : p == first;
            if (is_in_cell && begins_comment(p, stop, style))
                stop = p;
            else
                ++p;
        }
        const char* last = p;
        while (last != first && is_blank(last[-1])) --last;
        if (last - first > 1 && *first == '"' && last[-1] == '"') ++first, --last;
        if (first != last || style.delimiter) cells.emplace_back(first, size_t(last - first));
        // What a delimiter ends is followed by a cell, if by an empty one.
        goes_on = p != stop;
        if (goes_on) ++p;
        if (!style.delimiter) goes_on = p != stop;
    }
    return cells;
}

TextLayout find_text_layout(const Source& source) {
    TextLayout layout;
    std::vector<std::string> names_between_tabs;
    layout.style.comment = '#';
    layout.body = source.begin();
    while (layout.body != source.end()) {
        const char* p = layout.body;
        std::string_view line = read_rest(p, source.end());
        const bool commented = line.starts_with('#') || line.starts_with("//");
        if (commented) line.remove_prefix(line.starts_with('#') ? 1 : 2);
        layout.style.delimiter = delimiter_in(line);
        const auto cells = split_cells(line.data(), line.data() + line.size(), layout.style);
        const size_t number_count = size_t(std::ranges::count_if(cells, is_number));
        const bool is_row = !commented && !cells.empty() && 2 * number_count >= cells.size();
        if (is_row && cells.size() > 1) break;
        if (is_row)
            layout.count = parse_count(source, cells[0]);
        else if (auto names = header_names(line, layout.style.delimiter); !names.empty()) {
            layout.names = std::move(names);
            names_between_tabs = header_names(line, '\t');
        } else if (!commented && !cells.empty())
            fail_at_line(source, layout.body,
                         fmt::format("numbers or names of columns expected, found '{}'", line.substr(0, 40)));
        layout.body = next_line(layout.body, source.end());
    }
    const char* const row_end = line_end(layout.body, source.end());
    const auto tabs = size_t(std::count(layout.body, row_end, '\t'));
    // Tabs are more than blanks where they are as many as between the names: cells may be empty.
    if (layout.style.delimiter == 0 && tabs > 0 && tabs + 1 == names_between_tabs.size() &&
        std::ranges::find(names_between_tabs, "") == names_between_tabs.end()) {
        layout.style.delimiter = '\t';
        layout.names = std::move(names_between_tabs);
    }
    return layout;
}

std::vector<std::string> guess_columns(const std::vector<std::vector<double>>& samples,
                                       bool intensity_first) {
    return Guess(Columns(samples), intensity_first).names();
}

}  // namespace easypbr::io
