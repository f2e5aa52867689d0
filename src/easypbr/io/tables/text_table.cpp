#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/source/text_scanner.h"
#include "easypbr/io/tables/element_table.h"
#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

constexpr size_t chunk_bytes = 1 << 20;
constexpr size_t chunk_slab = 64;  ///< chunks after which the memory of the text before is given back

/// The lists of a chunk's rows, one after the other.
struct ListPart {
    std::vector<uint32_t> lengths;
    std::vector<int32_t> indices;
    std::vector<float> values;
};

/// The lists of a chunk, per plan and column.
using ChunkLists = std::vector<std::vector<ListPart>>;

/// The begin of a row at or after `p`, the begin of a line: its first character, or that of the line where
/// tabs separate cells, of which the first may be empty. Null when only empty lines and comments are left.
const char* next_row(const char* p, const char* end, const TextStyle& style) {
    while (p != end) {
        const char* const line = p;
        p = skip_blanks(p, end);
        if (p != end && *p != '\n' && !begins_comment(p, end, style))
            return style.delimiter == '\t' ? line : p;
        p = next_line(p, end);
    }
    return nullptr;
}

size_t count_rows(const char* p, const char* end, const TextStyle& style) {
    size_t rows = 0;
    for (; (p = next_row(p, end, style)); p = next_line(p, end)) ++rows;
    return rows;
}

/// Passes over the delimiter before every number but the first of a row. True when no number follows.
bool at_empty_cell(const char*& p, const char* end, const TextStyle& style, bool is_first) {
    if (!style.delimiter) return false;
    p = skip_blanks_before(p, end, style.delimiter);
    if (!is_first && p != end && *p == style.delimiter) p = skip_blanks_before(p + 1, end, style.delimiter);
    return p == end || *p == '\n' || *p == style.delimiter;
}

/// Passes over what stands in a column that nobody wants. False when nothing does.
bool skip_word(const char*& p, const char* end, const TextStyle& style) {
    const char* first = p = skip_blanks(p, end);
    if (style.delimiter) p = skip_quoted(p, end);
    while (p != end && *p != '\n' && (style.delimiter ? *p != style.delimiter : !is_blank(*p))) ++p;
    return p != first;
}

class ChunkReader {
  public:
    ChunkReader(const Source& source, const TextChunk& chunk, const TextStyle& style,
                const std::vector<ElementPlan>& plans)
        : source_(source), chunk_(chunk), style_(style), plans_(plans) {
        for (const ElementPlan& plan : plans) {
            lists_.emplace_back(plan.columns.size());
            rounding_.emplace_back(plan.columns.size());
        }
    }

    /// Values of columns of integers that are none or do not fit.
    const MisfitCounts& misfits() const { return misfits_; }

    ChunkLists read() {
        size_t plan = 0, row = chunk_.first_row;
        for (const char* p = chunk_.begin; (p = next_row(p, chunk_.end, style_));
             p = next_line(p, chunk_.end)) {
            while (plan < plans_.size() && row >= plans_[plan].element->count)
                row -= plans_[plan++].element->count;
            if (plan == plans_.size()) break;
            p = read_row(p, plan, row++);
        }
        add_rounding();
        return std::move(lists_);
    }

  private:
    const char* read_row(const char* p, size_t plan, size_t row) {
        const Element& element = *plans_[plan].element;
        for (size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            const Column& column = plans_[plan].columns[i];
            if (at_empty_cell(p, chunk_.end, style_, i == 0)) {
                fill_empty(p, column, property, row);
            } else if (property.count_type) {
                read_list(p, column, property, lists_[plan][i]);
            } else if (column.floats) {
                column.floats[row * column.stride] =
                    column.is_scaled() ? float(number<double>(p, property) * column.scale + column.shift)
                    : column.rounding  ? counted(p, property, *column.rounding, rounding_[plan][i])
                                       : number<float>(p, property);
            } else if (column.integers) {
                column.integers[row * column.stride] = integer(p, property);
            } else if (column.bits) {
                column.bits[row * column.stride] = bits(p, property);
            } else if (!skip_word(p, chunk_.end, style_)) {
                fail_missing(p, property);
            }
        }
        return p;
    }

    /// Numbers of few characters are read once: float32 tells them apart.
    float counted(const char*& p, const Property& property, const Rounding& rounding,
                  RoundingCounts& counts) const {
        constexpr ptrdiff_t most_exact_characters = 7;
        const char* again = p = skip_blanks(p, chunk_.end);
        const float value = number<float>(p, property);
        const bool is_long = p - again > most_exact_characters;
        rounding.count(is_long ? number<double>(again, property) : double(value), counts);
        return value;
    }

    void add_rounding() const {
        for (size_t plan = 0; plan < plans_.size(); ++plan)
            for (size_t i = 0; i < rounding_[plan].size(); ++i)
                if (Rounding* rounding = plans_[plan].columns[i].rounding) rounding->add(rounding_[plan][i]);
    }

    /// What a row ends without is missing; what is left out between delimiters has no value.
    void fill_empty(const char* p, const Column& column, const Property& property, size_t row) const {
        if (p == chunk_.end || *p != style_.delimiter) {
            const bool is_last = p != chunk_.begin && has_delimiter_before(p);
            if (!is_last) fail_missing(p, property);
        }
        if (column.floats) column.floats[row * column.stride] = NAN;
        if (column.integers) column.integers[row * column.stride] = -1;
    }

    /// Whether a delimiter stands before `p`, blanks aside: the row's last cell is there and empty.
    bool has_delimiter_before(const char* p) const {
        while (p != chunk_.begin && is_blank(p[-1]) && p[-1] != style_.delimiter) --p;
        return p != chunk_.begin && p[-1] == style_.delimiter;
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
        p = skip_blanks(p, chunk_.end);
        const bool is_quoted = style_.delimiter && p != chunk_.end && *p == '"';
        if (is_quoted) ++p;
        Number value;
        if (!read_number(p, chunk_.end, value)) fail_missing(p, property);
        if (is_quoted && p != chunk_.end && *p == '"') ++p;
        return value;
    }

    /// An integer, perhaps written as a real number; -1, which is counted, when it is none or does not fit.
    int32_t integer(const char*& p, const Property& property) {
        p = skip_blanks(p, chunk_.end);
        const char* start = p;
        int32_t value = 0;
        if (read_integer(p, chunk_.end, value) && value != INT32_MAX && value != -INT32_MAX &&
            (p == chunk_.end || is_blank(*p) || *p == '\n' || *p == style_.delimiter))
            return value;
        // What saturated, too.
        p = start;
        const double real = number<double>(p, property);
        if (is_int32(real)) return int32_t(real);
        ++misfits_[property.name];
        return -1;
    }

    uint32_t bits(const char*& p, const Property& property) const {
        const char* first = p = skip_blanks(p, chunk_.end);
        int64_t value = 0;
        const auto result = std::from_chars(p, chunk_.end, value);
        p = result.ptr;
        const bool is_integer = result.ec == std::errc() && value >= INT32_MIN && value <= UINT32_MAX &&
                                (p == chunk_.end || is_blank(*p) || *p == '\n' || *p == style_.delimiter);
        return is_integer ? uint32_t(value) : std::bit_cast<uint32_t>(number<float>(p = first, property));
    }

    [[noreturn]] void fail_missing(const char* p, const Property& property) const {
        const std::string_view found = read_word(p, chunk_.end);
        fail_at_line(source_, p,
                     fmt::format("a number expected for '{}', found '{}'", property.name,
                                 found.empty() ? "the line's end" : found.substr(0, 40)));
    }

    const Source& source_;
    const TextChunk& chunk_;
    const TextStyle style_;
    const std::vector<ElementPlan>& plans_;
    ChunkLists lists_;
    std::vector<std::vector<RoundingCounts>> rounding_;  ///< per plan and column
    MisfitCounts misfits_;
};

/// Joins one column's lists of all chunks.
template <class T>
void join_lists(const Source& source, const std::vector<ChunkLists>& chunks, size_t plan, size_t column,
                List<T>& list, std::vector<T> ListPart::*values) {
    std::vector<size_t> row_begin{0}, value_begin{0};
    for (const ChunkLists& lists : chunks) {
        row_begin.push_back(row_begin.back() + lists[plan][column].lengths.size());
        value_begin.push_back(value_begin.back() + (lists[plan][column].*values).size());
    }
    if (value_begin.back() > UINT32_MAX)
        fail(source, fmt::format("more than {} list entries are not supported", UINT32_MAX));
    list.rows = row_begin.back();
    charge_memory((value_begin.back() + uint64_t(list.rows) + 1) * sizeof(uint32_t), "its lists");
    list.first.assign(list.rows + 1, 0);
    list.values.resize(Eigen::Index(value_begin.back()));
    parallel_for(chunks.size(), 1, [&](size_t i) {
        const ListPart& part = chunks[i][plan][column];
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

TextRows::TextRows(const Source& source, const char* body, TextStyle style) : body(body), style(style) {
    const std::vector<size_t> starts = line_chunks({body, size_t(source.end() - body)}, chunk_bytes);
    for (size_t i = 0; i + 1 < starts.size(); ++i)
        chunks.push_back({body + starts[i], body + starts[i + 1], 0, 0});
    parallel_for(chunks.size(), 1,
                 [&](size_t i) { chunks[i].row_count = count_rows(chunks[i].begin, chunks[i].end, style); });
    for (size_t i = 1; i < chunks.size(); ++i)
        chunks[i].first_row = chunks[i - 1].first_row + chunks[i - 1].row_count;
}

void read_text_elements(const Source& source, const TextRows& rows, std::vector<ElementPlan>& plans) {
    const std::vector<TextChunk>& chunks = rows.chunks;
    size_t expected = 0;
    for (const ElementPlan& plan : plans) expected += plan.element->count;
    if (rows.count() < expected)
        fail_at_line(source, source.end(),
                     fmt::format("{} rows expected, but the file ends after {}", expected, rows.count()));

    std::vector<ChunkLists> lists(chunks.size());
    Misfits misfits;
    Progress progress(source, size_t(source.end() - rows.body));
    for (size_t first = 0; first < chunks.size(); first += chunk_slab) {
        parallel_for(std::min(chunk_slab, chunks.size() - first), 1, [&](size_t i) {
            const TextChunk& chunk = chunks[first + i];
            ChunkReader reader(source, chunk, rows.style, plans);
            lists[first + i] = reader.read();
            misfits.add(reader.misfits());
            progress.advance(size_t(chunk.end - chunk.begin));
        });
        source.release_until(chunks[first].begin);
    }
    misfits.warn(source);
    for (size_t plan = 0; plan < plans.size(); ++plan) {
        for (size_t i = 0; i < plans[plan].columns.size(); ++i) {
            const Column& column = plans[plan].columns[i];
            if (column.indices) join_lists(source, lists, plan, i, *column.indices, &ListPart::indices);
            if (column.values) join_lists(source, lists, plan, i, *column.values, &ListPart::values);
        }
    }
}

namespace {

/// The three properties of the row at `p`; NaN for what is no number.
Vec3d position_in_row(const char* p, const char* end, const TextStyle& style, const Element& element,
                      const std::array<size_t, 3>& properties) {
    Vec3d position = Vec3d::Constant(NAN);
    for (size_t i = 0; i < element.properties.size() && !element.properties[i].count_type; ++i) {
        if (at_empty_cell(p, end, style, i == 0)) continue;
        const auto axis = std::find(properties.begin(), properties.end(), i);
        if (axis == properties.end()) {
            skip_word(p, end, style);
            continue;
        }
        const char* const number = p;
        const bool is_quoted = style.delimiter && p != end && *p == '"';
        p += is_quoted;
        read_number(p, end, position[axis - properties.begin()]);
        if (is_quoted) p = skip_quoted(number, end);
    }
    return position;
}

}  // namespace

std::vector<const char*> sample_rows(const TextRows& rows, size_t first, size_t count) {
    first = std::min(first, rows.count());
    count = std::min(count, rows.count() - first);
    std::vector<size_t> wanted(std::min(count, offset_sample_count));
    for (size_t i = 0; i < wanted.size(); ++i) wanted[i] = first + spread_row(i, wanted.size(), count);
    std::vector<const char*> starts(wanted.size());
    parallel_for(rows.chunks.size(), 1, [&](size_t c) {
        const TextChunk& chunk = rows.chunks[c];
        size_t row = chunk.first_row;
        auto next = std::lower_bound(wanted.begin(), wanted.end(), row);
        for (const char* p = chunk.begin; next != wanted.end(); p = next_line(p, chunk.end), ++row) {
            if (!(p = next_row(p, chunk.end, rows.style))) return;
            if (row == *next) starts[size_t(next++ - wanted.begin())] = p;
        }
    });
    return starts;
}

std::vector<Vec3d> sample_text_positions(const TextRows& rows, const std::vector<Element>& elements,
                                         const std::array<PropertyPlace, 3>& position) {
    const size_t which = position[0].element;
    const std::array properties{position[0].property, position[1].property, position[2].property};
    size_t before = 0;
    for (size_t i = 0; i < which; ++i) before += elements[i].count;
    if (rows.chunks.empty()) return {};
    const char* end = rows.chunks.back().end;
    std::vector<Vec3d> samples;
    for (const char* row : sample_rows(rows, before, elements[which].count))
        samples.push_back(position_in_row(row, end, rows.style, elements[which], properties));
    return samples;
}

}  // namespace easypbr::io
