#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/element_table.h"
#include "easypbr/io/tables/value_copy.h"

namespace easypbr::io {
namespace {

constexpr size_t record_grain = 1 << 15;
/// Bytes after which the memory of the rows before is given back.
constexpr size_t record_slab = size_t(64) << 20;

/// What is counted of a column while its rows are read.
struct ColumnCounts {
    RoundingCounts rounding;
    size_t misfits = 0;
};

/// Whether a type has numbers that are no integers of 32 bits.
constexpr bool has_misfits(ScalarType type) {
    return type > ScalarType::int32;
}

/// Counts what float32 or an integer makes of the values of a block of scalars, one in each row: columns of
/// lists ask for no counts. `values`: room for them, kept from block to block.
void count_block(ValueBlock block, ScalarType type, bool swap, const Column& column, ColumnCounts& counts,
                 std::vector<double>& values) {
    const bool are_integers = column.integers && has_misfits(type);
    if (!column.rounding && !are_integers) return;
    if (are_integers) block.scale = 1, block.shift = 0;
    values.resize(block.rows);
    block.out_stride = 1;
    copy_values(block, type, swap, values.data());
    if (column.rounding)
        for (const double value : values) column.rounding->count(value, counts.rounding);
    if (are_integers)
        counts.misfits +=
            size_t(std::ranges::count_if(values, [](double value) { return !is_int32(value); }));
}

void add_counts(const ColumnCounts& counts, const Property& property, const Column& column,
                Misfits& misfits) {
    if (column.rounding) column.rounding->add(counts.rounding);
    misfits.add(property.name, counts.misfits);
}

/// Copies a block of scalars to the column's places from `place` on.
void copy_scalars(const ValueBlock& block, ScalarType type, bool swap, const Column& column, size_t place) {
    if (column.floats) copy_values(block, type, swap, column.floats + place);
    if (column.doubles) copy_values(block, type, swap, column.doubles + place);
    if (column.integers) copy_values(block, type, swap, column.integers + place);
    if (column.bits) copy_bits(block, swap, column.bits + place);
}

/// Reads one element; keeps what the functions below share.
class ElementReader {
  public:
    ElementReader(const Source& source, std::endian endian, ElementPlan& plan, Progress& progress)
        : source_(source),
          swap_(endian != std::endian::native),
          plan_(plan),
          element_(*plan.element),
          progress_(progress) {}

    /// Returns the end of the element.
    const char* read(const char* body) {
        const size_t room = size_t(source_.end() - body), least = smallest_row(element_);
        if (element_.count == 0 || element_.properties.empty()) return body;
        if (element_.count > room / least) {
            fail_at_byte(source_, body,
                         fmt::format("{} {} rows of at least {} bytes expected, but only {} bytes are left",
                                     element_.count, element_.name, least, room));
        }
        if (const char* end = read_uniform(body)) return end;
        misfits_.clear();  // Of rows that were read as if all were alike.
        return read_varied(body);
    }

    const Misfits& misfits() const { return misfits_; }

  private:
    int64_t list_length(const Property& property, const char* p) const {
        const ValueBlock block{p, 0, 1, 1, 1};
        if (*property.count_type == ScalarType::uint32) {
            uint32_t length = 0;
            copy_bits(block, swap_, &length);
            return length;
        }
        int32_t length = 0;
        copy_values(block, *property.count_type, swap_, &length);
        return length;
    }

    size_t checked_length(const Property& property, const char* p) const {
        if (size_t(source_.end() - p) < size_of(*property.count_type)) fail_truncated();
        const int64_t length = list_length(property, p);
        if (length < 0)
            fail_at_byte(source_, p, fmt::format("list '{}' has length {}", property.name, length));
        if (size_t(length) > size_t(source_.end() - p) / size_of(property.type)) fail_truncated();
        return size_t(length);
    }

    [[noreturn]] void fail_truncated() const {
        fail_at_byte(
            source_, source_.end(),
            fmt::format("the file ends before its {} rows of '{}' do", element_.count, element_.name));
    }

    /// Length of each property's list in the row at `row` (1 for a scalar), and the row's size in bytes at
    /// the end.
    std::vector<size_t> row_layout(const char* row) const {
        std::vector<size_t> widths;
        const char* p = row;
        for (const Property& property : element_.properties) {
            widths.push_back(property.count_type ? checked_length(property, p) : 1);
            p += (property.count_type ? size_of(*property.count_type) : 0) +
                 widths.back() * size_of(property.type);
            if (p > source_.end()) fail_truncated();
        }
        widths.push_back(size_t(p - row));
        return widths;
    }

    /// Reads all rows as if their lists were as long as the first row's. Returns null when they are not.
    const char* read_uniform(const char* body) {
        const std::vector<size_t> widths = row_layout(body);
        const size_t stride = widths.back();
        if (element_.count > size_t(source_.end() - body) / stride) return nullptr;
        for (size_t i = 0; i < plan_.columns.size(); ++i) allocate_uniform(plan_.columns[i], widths[i]);
        const size_t slab = std::max(record_grain, record_slab / stride / record_grain * record_grain);
        for (size_t row = 0; row < element_.count; row += slab) {
            const size_t count = std::min(slab, element_.count - row);
            if (!read_uniform_slab(body, widths, row, count)) return nullptr;
            source_.release_until(body + (row + count) * stride);
        }
        return body + element_.count * stride;
    }

    bool read_uniform_slab(const char* body, const std::vector<size_t>& widths, size_t first, size_t count) {
        std::atomic<bool> uniform{true};
        parallel_chunks(count, record_grain, [&](size_t begin, size_t end) {
            if (!read_uniform_rows(body, widths, first + begin, first + end)) uniform = false;
            progress_.advance((end - begin) * widths.back());
        });
        return uniform;
    }

    void allocate_uniform(const Column& column, size_t width) const {
        const auto allocate = [&](auto* list) {
            if (!list) return;
            charge_memory(uint64_t(element_.count) * width * 4, "its lists");
            list->rows = element_.count;
            list->width = width;
            list->values.resize(Eigen::Index(element_.count * width));
        };
        allocate(column.indices);
        allocate(column.values);
    }

    bool read_uniform_rows(const char* body, const std::vector<size_t>& widths, size_t begin, size_t end) {
        const size_t stride = widths.back();
        const char* in = body + begin * stride;
        std::vector<double> room;
        for (size_t i = 0; i < element_.properties.size(); ++i) {
            const Property& property = element_.properties[i];
            const Column& column = plan_.columns[i];
            if (property.count_type) {
                if (!has_lengths(property, {in, stride, end - begin, widths[i], 0})) return false;
                in += size_of(*property.count_type);
            }
            const ValueBlock block{in,
                                   stride,
                                   end - begin,
                                   widths[i],
                                   property.count_type ? widths[i] : column.stride,
                                   column.scale,
                                   column.shift};
            copy_scalars(block, property.type, swap_, column, begin * column.stride);
            ColumnCounts counts;
            count_block(block, property.type, swap_, column, counts, room);
            add_counts(counts, property, column, misfits_);
            if (column.indices)
                copy_values(block, property.type, swap_, column.indices->values.data() + begin * widths[i]);
            if (column.values)
                copy_values(block, property.type, swap_, column.values->values.data() + begin * widths[i]);
            in += widths[i] * size_of(property.type);
        }
        return true;
    }

    /// Whether every row's list has the block's width.
    bool has_lengths(const Property& property, const ValueBlock& block) const {
        if (size_of(*property.count_type) == 1 && block.width < 128) {
            unsigned difference = 0;
            for (size_t row = 0; row < block.rows; ++row)
                difference |= unsigned(uint8_t(block.in[row * block.in_stride])) ^ unsigned(block.width);
            return difference == 0;
        }
        for (size_t row = 0; row < block.rows; ++row)
            if (list_length(property, block.in + row * block.in_stride) != int64_t(block.width)) return false;
        return true;
    }

    /// Reads rows whose lists differ in length: one walk finds where each run of rows begins, then the runs
    /// are read in parallel.
    const char* read_varied(const char* body) {
        std::vector<const char*> starts;
        const char* p = body;
        for (Column& column : plan_.columns) {
            if (column.rounding) column.rounding->clear();  // Of rows that were read as if all were alike.
            if (column.indices) start_lists(*column.indices);
            if (column.values) start_lists(*column.values);
        }
        for (size_t row = 0; row < element_.count; ++row) {
            if (row % record_grain == 0) starts.push_back(p);
            p = measure_row(p, row);
        }
        for (Column& column : plan_.columns) {
            const auto allocate = [](auto* list) {
                if (!list) return;
                charge_memory(uint64_t(list->first.back()) * 4, "its lists");
                list->values.resize(Eigen::Index(list->first.back()));
            };
            allocate(column.indices);
            allocate(column.values);
        }
        parallel_chunks(element_.count, record_grain, [&](size_t begin, size_t end) {
            const char* in = starts[begin / record_grain];
            std::vector<ColumnCounts> counts(plan_.columns.size());
            std::vector<double> room;
            for (size_t row = begin; row < end; ++row) in = read_row(in, row, counts, room);
            for (size_t i = 0; i < counts.size(); ++i)
                add_counts(counts[i], element_.properties[i], plan_.columns[i], misfits_);
            progress_.advance(size_t(in - starts[begin / record_grain]));
        });
        return p;
    }

    template <class T>
    void start_lists(List<T>& list) const {
        list.rows = element_.count;
        list.width = 0;
        list.first.assign(element_.count + 1, 0);
    }

    const char* measure_row(const char* p, size_t row) {
        for (size_t i = 0; i < element_.properties.size(); ++i) {
            const Property& property = element_.properties[i];
            size_t width = 1;
            if (property.count_type) {
                width = checked_length(property, p);
                p += size_of(*property.count_type);
                add_length(plan_.columns[i], row, width);
            }
            if (width * size_of(property.type) > size_t(source_.end() - p)) fail_truncated();
            p += width * size_of(property.type);
        }
        return p;
    }

    void add_length(Column& column, size_t row, size_t width) const {
        const auto add = [&](auto* list) {
            if (!list) return;
            const size_t end = list->first[row] + width;
            if (end > UINT32_MAX)
                fail(source_, fmt::format("more than {} list entries are not supported", UINT32_MAX));
            list->first[row + 1] = uint32_t(end);
        };
        add(column.indices);
        add(column.values);
    }

    const char* read_row(const char* in, size_t row, std::vector<ColumnCounts>& counts,
                         std::vector<double>& room) const {
        for (size_t i = 0; i < element_.properties.size(); ++i) {
            const Property& property = element_.properties[i];
            const Column& column = plan_.columns[i];
            size_t width = 1;
            if (property.count_type) {
                width = size_t(list_length(property, in));
                in += size_of(*property.count_type);
            }
            const ValueBlock block{in, 0, 1, width, 0, column.scale, column.shift};
            copy_scalars(block, property.type, swap_, column, row * column.stride);
            count_block(block, property.type, swap_, column, counts[i], room);
            if (column.indices)
                copy_values(block, property.type, swap_,
                            column.indices->values.data() + column.indices->first[row]);
            if (column.values)
                copy_values(block, property.type, swap_,
                            column.values->values.data() + column.values->first[row]);
            in += width * size_of(property.type);
        }
        return in;
    }

    const Source& source_;
    const bool swap_;
    ElementPlan& plan_;
    const Element& element_;
    Progress& progress_;
    Misfits misfits_;
};

}  // namespace

size_t smallest_row(const Element& element) {
    size_t size = 0;
    for (const Property& property : element.properties)
        size += size_of(property.count_type.value_or(property.type));
    return size;
}

void read_binary_elements(const Source& source, const char* body, std::endian endian,
                          std::vector<ElementPlan>& plans) {
    Progress progress(source, size_t(source.end() - body));
    for (ElementPlan& plan : plans) {
        ElementReader reader(source, endian, plan, progress);
        body = reader.read(body);
        source.release_until(body);
        reader.misfits().warn(source);
    }
}

void read_binary_rows(const ElementPlan& plan, const char* data, std::endian endian, size_t first,
                      size_t count, Misfits& misfits) {
    const bool swap = endian != std::endian::native;
    const size_t stride = smallest_row(*plan.element);
    parallel_chunks(count, record_grain, [&](size_t begin, size_t end) {
        const char* in = data + begin * stride;
        std::vector<double> room;
        for (size_t i = 0; i < plan.columns.size(); ++i) {
            const Property& property = plan.element->properties[i];
            const ScalarType type = property.type;
            const Column& column = plan.columns[i];
            const ValueBlock block{in, stride, end - begin, 1, column.stride, column.scale, column.shift};
            copy_scalars(block, type, swap, column, (first + begin) * column.stride);
            ColumnCounts counts;
            count_block(block, type, swap, column, counts, room);
            add_counts(counts, property, column, misfits);
            in += size_of(type);
        }
    });
}

}  // namespace easypbr::io
