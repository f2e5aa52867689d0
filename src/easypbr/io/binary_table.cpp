#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "easypbr/core/parallel.h"
#include "easypbr/io/element_table.h"
#include "easypbr/scene/offset.h"

namespace easypbr::io {
namespace {

constexpr size_t grain = 1 << 15;
constexpr size_t slab = grain * 64;  ///< rows after which the memory of the rows before is given back

/// IEEE 754 half precision, as it lies in memory.
struct Half {
    uint16_t bits;

    operator float() const {
        const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
        const float magnitude = exponent == 31  ? (mantissa ? NAN : INFINITY)
                                : exponent == 0 ? std::ldexp(float(mantissa), -24)
                                                : std::ldexp(float(mantissa + 1024), exponent - 25);
        return bits >> 15 ? -magnitude : magnitude;
    }
};

template <class T, bool swap>
T load(const char* p) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), p, sizeof(T));
    if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

/// Conversion to an index or label; what does not fit becomes -1, which no index check lets pass.
template <class To, class From>
To convert(From value) {
    if constexpr (std::is_floating_point_v<To> || (std::is_integral_v<From> && sizeof(From) <= 4)) {
        return To(value);
    } else if constexpr (std::is_integral_v<From>) {
        return std::in_range<To>(value) ? To(value) : To(-1);
    } else {
        const double real = double(value);
        return real >= -2147483648.0 && real < 2147483648.0 ? To(real) : To(-1);
    }
}

/// Reads rows of `width` values each; a row begins every `in_stride` bytes and is written every `out_stride`
/// values.
struct Block {
    const char* in;
    size_t in_stride, rows, width, out_stride;
    double scale = 1, shift = 0;
};

template <class From, bool swap, class To, class Convert>
void copy_values(const Block& block, To* out, Convert&& convert_value) {
    for (size_t row = 0; row < block.rows; ++row) {
        const char* in = block.in + row * block.in_stride;
        To* target = out + row * block.out_stride;
        for (size_t k = 0; k < block.width; ++k)
            target[k] = convert_value(load<From, swap>(in + k * sizeof(From)));
    }
}

template <class From, bool swap, class To>
void copy_block(const Block& block, To* out) {
    if (std::is_floating_point_v<To> && (block.scale != 1 || block.shift != 0))
        return copy_values<From, swap>(block, out, [scale = block.scale, shift = block.shift](From value) {
            return To(double(value) * scale + shift);
        });
    copy_values<From, swap>(block, out, [](From value) { return convert<To>(value); });
}

/// The triangle's case of copy_block with its loop unrolled.
template <class To>
void copy_triples(const Block& block, To* out) {
    for (size_t row = 0; row < block.rows; ++row)
        std::memcpy(out + row * block.out_stride, block.in + row * block.in_stride, 3 * sizeof(To));
}

template <class From, class To>
void copy_block_swapped(const Block& block, bool swap, To* out) {
    const bool same = std::is_same_v<From, To> && block.scale == 1 && block.shift == 0;
    if (same && !swap && block.width == 3) return copy_triples(block, out);
    swap ? copy_block<From, true>(block, out) : copy_block<From, false>(block, out);
}

template <class To>
void copy_typed(const Block& block, ScalarType type, bool swap, To* out) {
    switch (type) {
        case ScalarType::int8:
            return copy_block_swapped<int8_t>(block, swap, out);
        case ScalarType::uint8:
            return copy_block_swapped<uint8_t>(block, swap, out);
        case ScalarType::int16:
            return copy_block_swapped<int16_t>(block, swap, out);
        case ScalarType::uint16:
            return copy_block_swapped<uint16_t>(block, swap, out);
        case ScalarType::int32:
            return copy_block_swapped<int32_t>(block, swap, out);
        case ScalarType::uint32:
            return copy_block_swapped<uint32_t>(block, swap, out);
        case ScalarType::int64:
            return copy_block_swapped<int64_t>(block, swap, out);
        case ScalarType::uint64:
            return copy_block_swapped<uint64_t>(block, swap, out);
        case ScalarType::float16:
            return copy_block_swapped<Half>(block, swap, out);
        case ScalarType::float32:
            return copy_block_swapped<float>(block, swap, out);
        case ScalarType::float64:
            return copy_block_swapped<double>(block, swap, out);
    }
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
        return read_varied(body);
    }

  private:
    int64_t list_length(const Property& property, const char* p) const {
        int32_t length = 0;
        copy_typed(Block{p, 0, 1, 1, 1}, *property.count_type, swap_, &length);
        return *property.count_type == ScalarType::uint32 ? int64_t(uint32_t(length)) : int64_t(length);
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
        for (size_t row = 0; row < element_.count; row += slab) {
            if (!read_uniform_slab(body, widths, row, std::min(slab, element_.count - row))) return nullptr;
            source_.release_until(body + row * stride);
        }
        return body + element_.count * stride;
    }

    bool read_uniform_slab(const char* body, const std::vector<size_t>& widths, size_t first, size_t count) {
        std::atomic<bool> uniform{true};
        parallel_chunks(count, grain, [&](size_t begin, size_t end) {
            if (!read_uniform_rows(body, widths, first + begin, first + end)) uniform = false;
            progress_.advance((end - begin) * widths.back());
        });
        return uniform;
    }

    void allocate_uniform(const Column& column, size_t width) const {
        const auto allocate = [&](auto* list) {
            if (!list) return;
            list->rows = element_.count;
            list->width = width;
            list->values.resize(Eigen::Index(element_.count * width));
        };
        allocate(column.indices);
        allocate(column.values);
    }

    bool read_uniform_rows(const char* body, const std::vector<size_t>& widths, size_t begin,
                           size_t end) const {
        const size_t stride = widths.back();
        const char* in = body + begin * stride;
        for (size_t i = 0; i < element_.properties.size(); ++i) {
            const Property& property = element_.properties[i];
            const Column& column = plan_.columns[i];
            if (property.count_type) {
                if (!has_lengths(property, {in, stride, end - begin, widths[i], 0})) return false;
                in += size_of(*property.count_type);
            }
            const Block block{in,
                              stride,
                              end - begin,
                              widths[i],
                              property.count_type ? widths[i] : column.stride,
                              column.scale,
                              column.shift};
            if (column.floats) copy_typed(block, property.type, swap_, column.floats + begin * column.stride);
            if (column.integers)
                copy_typed(block, property.type, swap_, column.integers + begin * column.stride);
            if (column.indices)
                copy_typed(block, property.type, swap_, column.indices->values.data() + begin * widths[i]);
            if (column.values)
                copy_typed(block, property.type, swap_, column.values->values.data() + begin * widths[i]);
            in += widths[i] * size_of(property.type);
        }
        return true;
    }

    /// Whether every row's list has the block's width.
    bool has_lengths(const Property& property, const Block& block) const {
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
            if (column.indices) start_lists(*column.indices);
            if (column.values) start_lists(*column.values);
        }
        for (size_t row = 0; row < element_.count; ++row) {
            if (row % grain == 0) starts.push_back(p);
            p = measure_row(p, row);
        }
        for (Column& column : plan_.columns) {
            if (column.indices) column.indices->values.resize(Eigen::Index(column.indices->first.back()));
            if (column.values) column.values->values.resize(Eigen::Index(column.values->first.back()));
        }
        parallel_chunks(element_.count, grain, [&](size_t begin, size_t end) {
            const char* in = starts[begin / grain];
            for (size_t row = begin; row < end; ++row) in = read_row(in, row);
            progress_.advance(size_t(in - starts[begin / grain]));
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

    const char* read_row(const char* in, size_t row) const {
        for (size_t i = 0; i < element_.properties.size(); ++i) {
            const Property& property = element_.properties[i];
            const Column& column = plan_.columns[i];
            size_t width = 1;
            if (property.count_type) {
                width = size_t(list_length(property, in));
                in += size_of(*property.count_type);
            }
            const Block block{in, 0, 1, width, 0, column.scale, column.shift};
            if (column.floats) copy_typed(block, property.type, swap_, column.floats + row * column.stride);
            if (column.integers)
                copy_typed(block, property.type, swap_, column.integers + row * column.stride);
            if (column.indices)
                copy_typed(block, property.type, swap_,
                           column.indices->values.data() + column.indices->first[row]);
            if (column.values)
                copy_typed(block, property.type, swap_,
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
};

}  // namespace

size_t smallest_row(const Element& element) {
    size_t size = 0;
    for (const Property& property : element.properties)
        size += size_of(property.count_type.value_or(property.type));
    return size;
}

namespace {

/// Where a property lies in the file: the value of row i at begin + i * stride. Null when lists stand before.
struct PropertyLayout {
    const char* begin = nullptr;
    size_t stride = 0, rows = 0;
};

PropertyLayout layout_of(const Source& source, const char* body, const std::vector<Element>& elements,
                         PropertyPlace place) {
    const auto has_list = [](const Element& element) {
        return std::ranges::any_of(element.properties, [](const Property& p) { return bool(p.count_type); });
    };
    if (std::any_of(elements.begin(), elements.begin() + long(place.element) + 1, has_list)) return {};
    size_t left = size_t(source.end() - body);
    for (size_t i = 0; i < place.element; ++i) {
        const size_t stride = smallest_row(elements[i]);
        if (stride && elements[i].count > left / stride) return {};
        body += elements[i].count * stride;
        left -= elements[i].count * stride;
    }
    const Element& element = elements[place.element];
    PropertyLayout layout{body, smallest_row(element), 0};
    layout.rows = std::min(element.count, left / layout.stride);
    for (size_t i = 0; i < place.property; ++i) layout.begin += size_of(element.properties[i].type);
    return layout;
}

}  // namespace

std::vector<Vec3d> sample_binary_rows(const Source& source, const char* body, std::endian endian,
                                      const std::vector<Element>& elements,
                                      const std::array<PropertyPlace, 3>& position) {
    std::array<PropertyLayout, 3> layouts;
    for (size_t axis = 0; axis < 3; ++axis) layouts[axis] = layout_of(source, body, elements, position[axis]);
    const size_t rows = std::min({layouts[0].rows, layouts[1].rows, layouts[2].rows});
    std::vector<Vec3d> samples(std::min(rows, offset_sample_count));
    for (size_t i = 0; i < samples.size(); ++i) {
        const size_t row = spread_row(i, samples.size(), rows);
        for (size_t axis = 0; axis < 3; ++axis) {
            const Property& property = elements[position[axis].element].properties[position[axis].property];
            copy_typed(Block{layouts[axis].begin + row * layouts[axis].stride, 0, 1, 1, 1, property.scale,
                             property.shift},
                       property.type, endian != std::endian::native, &samples[i][Eigen::Index(axis)]);
        }
    }
    return samples;
}

void read_binary_elements(const Source& source, const char* body, std::endian endian,
                          std::vector<ElementPlan>& plans) {
    Progress progress(source, size_t(source.end() - body));
    for (ElementPlan& plan : plans) {
        body = ElementReader(source, endian, plan, progress).read(body);
        source.release_until(body);
    }
}

}  // namespace easypbr::io
