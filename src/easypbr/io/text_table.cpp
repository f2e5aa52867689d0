#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "easypbr/core/parallel.h"
#include "easypbr/io/element_table.h"
#include "easypbr/io/text_scanner.h"

namespace easypbr::io {
namespace {

constexpr size_t chunk_bytes = 1 << 20;
constexpr size_t slab = 64;  ///< chunks after which the memory of the text before is given back

/// The lists of a chunk's rows, one after the other.
struct ListPart {
    std::vector<uint32_t> lengths;
    std::vector<int32_t> indices;
    std::vector<float> values;
};

/// A piece of the text: its first row, and the lists that it holds per plan and column.
struct Chunk {
    const char* begin;
    const char* end;
    size_t row_count = 0;
    size_t first_row = 0;
    std::vector<std::vector<ListPart>> lists;
};

/// The first character of a row at or after `p`, or null when only empty lines and comments are left.
const char* next_row(const char* p, const char* end, char comment) {
    while (p != end) {
        p = skip_blanks(p, end);
        if (p != end && *p != '\n' && !(comment && *p == comment)) return p;
        p = next_line(p, end);
    }
    return nullptr;
}

size_t count_rows(const char* p, const char* end, char comment) {
    size_t rows = 0;
    for (; (p = next_row(p, end, comment)); p = next_line(p, end)) ++rows;
    return rows;
}

std::vector<Chunk> split_rows(const Source& source, const char* body, char comment) {
    const std::vector<size_t> starts = line_chunks({body, size_t(source.end() - body)}, chunk_bytes);
    std::vector<Chunk> chunks;
    for (size_t i = 0; i + 1 < starts.size(); ++i)
        chunks.push_back({body + starts[i], body + starts[i + 1], 0, 0, {}});
    parallel_for(chunks.size(), 1, [&](size_t i) {
        chunks[i].row_count = count_rows(chunks[i].begin, chunks[i].end, comment);
    });
    for (size_t i = 1; i < chunks.size(); ++i)
        chunks[i].first_row = chunks[i - 1].first_row + chunks[i - 1].row_count;
    return chunks;
}

class ChunkReader {
  public:
    ChunkReader(const Source& source, const std::vector<ElementPlan>& plans, Chunk& chunk)
        : source_(source), plans_(plans), chunk_(chunk) {
        for (const ElementPlan& plan : plans) chunk.lists.emplace_back(plan.columns.size());
    }

    void read(char comment) {
        size_t plan = 0, row = chunk_.first_row;
        for (const char* p = chunk_.begin; (p = next_row(p, chunk_.end, comment));
             p = next_line(p, chunk_.end)) {
            while (plan < plans_.size() && row >= plans_[plan].element->count)
                row -= plans_[plan++].element->count;
            if (plan == plans_.size()) return;
            p = read_row(p, plan, row++);
        }
    }

  private:
    const char* read_row(const char* p, size_t plan, size_t row) {
        const Element& element = *plans_[plan].element;
        for (size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            const Column& column = plans_[plan].columns[i];
            if (property.count_type) {
                read_list(p, column, property, chunk_.lists[plan][i]);
            } else if (column.floats) {
                column.floats[row * column.stride] = number<float>(p, property) * column.scale;
            } else if (column.integers) {
                column.integers[row * column.stride] = integer(p, property);
            } else if (read_word(p, chunk_.end).empty()) {
                fail_missing(p, property);
            }
        }
        return p;
    }

    void read_list(const char*& p, const Column& column, const Property& property, ListPart& part) {
        const int32_t length = integer(p, property);
        // Each entry takes at least a blank and a digit.
        if (length < 0 || length > (chunk_.end - p + 1) / 2)
            fail_at_line(source_, p,
                         fmt::format("list '{}' has length {}, more than stand in its line or less than 0",
                                     property.name, length));
        if (!column.is_skipped()) part.lengths.push_back(uint32_t(length));
        for (int32_t k = 0; k < length; ++k) {
            if (column.indices) {
                part.indices.push_back(integer(p, property));
            } else {
                const float value = number<float>(p, property);
                if (column.values) part.values.push_back(value);
            }
        }
    }

    template <class Number>
    Number number(const char*& p, const Property& property) const {
        Number value;
        if (!read_number(p, chunk_.end, value)) fail_missing(p, property);
        return value;
    }

    /// An integer, perhaps written as a real number; -1 when it does not fit.
    int32_t integer(const char*& p, const Property& property) const {
        p = skip_blanks(p, chunk_.end);
        const char* start = p;
        int32_t value = 0;
        if (read_integer(p, chunk_.end, value) && (p == chunk_.end || is_blank(*p) || *p == '\n'))
            return value;
        p = start;
        const double real = number<double>(p, property);
        return real >= INT32_MIN && real <= INT32_MAX ? int32_t(real) : -1;
    }

    [[noreturn]] void fail_missing(const char* p, const Property& property) const {
        const std::string_view found = read_word(p, chunk_.end);
        fail_at_line(source_, p,
                     fmt::format("a number expected for '{}', found '{}'", property.name,
                                 found.empty() ? "the line's end" : found.substr(0, 40)));
    }

    const Source& source_;
    const std::vector<ElementPlan>& plans_;
    Chunk& chunk_;
};

/// Joins one column's lists of all chunks.
template <class T>
void join_lists(const Source& source, const std::vector<Chunk>& chunks, size_t plan, size_t column,
                List<T>& list, std::vector<T> ListPart::*values) {
    std::vector<size_t> row_begin{0}, value_begin{0};
    for (const Chunk& chunk : chunks) {
        row_begin.push_back(row_begin.back() + chunk.lists[plan][column].lengths.size());
        value_begin.push_back(value_begin.back() + (chunk.lists[plan][column].*values).size());
    }
    if (value_begin.back() > UINT32_MAX)
        fail(source, fmt::format("more than {} list entries are not supported", UINT32_MAX));
    list.rows = row_begin.back();
    list.first.assign(list.rows + 1, 0);
    list.values.resize(Eigen::Index(value_begin.back()));
    parallel_for(chunks.size(), 1, [&](size_t i) {
        const ListPart& part = chunks[i].lists[plan][column];
        std::copy((part.*values).begin(), (part.*values).end(), list.values.data() + value_begin[i]);
        size_t end = value_begin[i];
        for (size_t row = 0; row < part.lengths.size(); ++row)
            list.first[row_begin[i] + row + 1] = uint32_t(end += part.lengths[row]);
    });
    list.width = list.rows ? list.first[1] : 0;
    bool uniform = true;
    for (size_t row = 0; row < list.rows && uniform; ++row)
        uniform = list.first[row + 1] == list.width * (row + 1);
    if (uniform) list.first.clear();
}

}  // namespace

void check_text_rows(const Source& source, const char* body, const std::vector<Element>& elements) {
    size_t left = size_t(source.end() - body) / 2 + 1;
    for (const Element& element : elements) {
        if (element.count > left)
            fail_at_byte(source, source.end(),
                         fmt::format("{} rows of '{}' expected, but the file ends before", element.count,
                                     element.name));
        left -= element.count;
    }
}

void read_text_elements(const Source& source, const char* body, char comment,
                        std::vector<ElementPlan>& plans) {
    std::vector<Chunk> chunks = split_rows(source, body, comment);
    const size_t rows = chunks.empty() ? 0 : chunks.back().first_row + chunks.back().row_count;
    size_t expected = 0;
    for (const ElementPlan& plan : plans) expected += plan.element->count;
    if (rows < expected)
        fail_at_line(source, source.end(),
                     fmt::format("{} rows expected, but the file ends after {}", expected, rows));

    Progress progress(source, size_t(source.end() - body));
    for (size_t first = 0; first < chunks.size(); first += slab) {
        parallel_for(std::min(slab, chunks.size() - first), 1, [&](size_t i) {
            Chunk& chunk = chunks[first + i];
            ChunkReader(source, plans, chunk).read(comment);
            progress.advance(size_t(chunk.end - chunk.begin));
        });
        source.release_until(chunks[first].begin);
    }
    for (size_t plan = 0; plan < plans.size(); ++plan) {
        for (size_t i = 0; i < plans[plan].columns.size(); ++i) {
            const Column& column = plans[plan].columns[i];
            if (column.indices) join_lists(source, chunks, plan, i, *column.indices, &ListPart::indices);
            if (column.values) join_lists(source, chunks, plan, i, *column.values, &ListPart::values);
        }
    }
}

}  // namespace easypbr::io
