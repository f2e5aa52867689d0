#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/log.h"
#include "easypbr/io/mesh/cloud_reader.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/text_columns.h"

namespace easypbr::io {
namespace {

/// More than files have; a row of them is still short.
constexpr size_t most_columns = 1000;

/// Rows as numbers, NaN for what is none; all as long as the first.
struct Samples {
    std::vector<std::vector<double>> rows;
    std::vector<bool> is_text;  ///< for each column: it holds words
};

Samples samples_of(const Source& source, const TextRows& rows) {
    Samples samples;
    for (const char* row : sample_rows(rows, 0, rows.count())) {
        const auto cells = split_cells(row, source.end(), rows.style);
        if (cells.size() > most_columns)
            fail_at_line(source, row,
                         fmt::format("{} columns, at most {} are read", cells.size(), most_columns));
        if (samples.rows.empty()) samples.is_text.assign(cells.size(), false);
        std::vector<double> numbers(samples.is_text.size(), NAN);
        for (size_t i = 0; i < std::min(cells.size(), numbers.size()); ++i) {
            const char* p = cells[i].data();
            const char* end = p + cells[i].size();
            const bool is_number = read_number(p, end, numbers[i]) && p == end;
            if (!is_number && !cells[i].empty()) samples.is_text[i] = true;
        }
        samples.rows.push_back(std::move(numbers));
    }
    return samples;
}

/// Leaves out a last column without a name in which nothing stands: a delimiter at the end of each row
/// separates nothing.
void drop_empty_last(const TextLayout& layout, Samples& samples) {
    const size_t count = samples.is_text.size();
    const bool is_named = layout.names.size() >= count && count > 0;
    const auto is_empty = [](const std::vector<double>& row) { return std::isnan(row.back()); };
    if (count == 0 || is_named || samples.is_text.back() || !std::ranges::all_of(samples.rows, is_empty))
        return;
    samples.is_text.pop_back();
    for (std::vector<double>& row : samples.rows) row.pop_back();
}

/// A column for each cell of the rows; those of words are skipped.
Element describe(const Source& source, const TextLayout& layout, const Samples& samples, size_t count,
                 bool is_pts) {
    std::vector<std::string> names =
        layout.names.empty() ? guess_columns(samples.rows, is_pts) : layout.names;
    if (!layout.names.empty() && names.size() > samples.is_text.size() && !samples.rows.empty())
        fail_at_line(source, layout.body,
                     fmt::format("{} columns expected, as in the header, found {}", names.size(),
                                 samples.is_text.size()));
    if (!samples.rows.empty()) names.resize(samples.is_text.size());
    Element points{"point", count, {}};
    std::vector<std::string> skipped;
    for (size_t i = 0; i < names.size(); ++i) {
        const bool is_text = i < samples.is_text.size() && samples.is_text[i];
        if (is_text) skipped.push_back(names[i].empty() ? fmt::format("{}", i + 1) : names[i]);
        if (names[i].empty()) names[i] = fmt::format("column_{}", i + 1);
        // A text may have more digits than float32 holds.
        points.properties.push_back({is_text ? "_" : names[i], ScalarType::float64, {}, 1, 0});
    }
    if (!skipped.empty())
        log_warning(fmt::format("{}: columns that hold words are left out: {}", source.path.string(),
                                fmt::join(skipped, ", ")));
    return points;
}

}  // namespace

MeshData read_xyz(const Source& given, bool is_pts) {
    if (given.bytes.empty()) fail(given, "the file is empty");
    const TextSource text(given);
    const Source& source = text.source();
    const TextLayout layout = find_text_layout(source);
    const TextRows rows(source, layout.body, layout.style);
    const size_t count = layout.count.value_or(rows.count());
    if (count < rows.count())
        log_warning(fmt::format("{}: {} rows behind the {} points that the file says it has are left out",
                                source.path.string(), rows.count() - count, count));
    Samples samples = samples_of(source, rows);
    drop_empty_last(layout, samples);
    MeshData mesh = read_text_cloud(source, rows, describe(source, layout, samples, count, is_pts));
    drop_points_without_position(source, mesh);
    return mesh;
}

}  // namespace easypbr::io
