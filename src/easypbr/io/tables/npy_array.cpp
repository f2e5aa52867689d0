#include "easypbr/io/tables/npy_array.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <functional>
#include <numeric>
#include <optional>

#include "easypbr/io/tables/python_literal.h"
#include "easypbr/io/tables/vertex_arrays.h"

namespace easypbr::io {
namespace {

constexpr size_t most_fields = 10'000, most_dimensions = 32;

/// What a type as "<f4" stands for.
struct TypeCode {
    std::optional<ScalarType> type;  ///< none: bytes that are no numbers
    size_t size = 0;
    char order = '|';
};

std::optional<ScalarType> scalar_type(char kind, size_t size) {
    static constexpr struct {
        char kind;
        size_t size;
        ScalarType type;
    } known[] = {{'b', 1, ScalarType::uint8},   {'i', 1, ScalarType::int8},    {'i', 2, ScalarType::int16},
                 {'i', 4, ScalarType::int32},   {'i', 8, ScalarType::int64},   {'u', 1, ScalarType::uint8},
                 {'u', 2, ScalarType::uint16},  {'u', 4, ScalarType::uint32},  {'u', 8, ScalarType::uint64},
                 {'f', 2, ScalarType::float16}, {'f', 4, ScalarType::float32}, {'f', 8, ScalarType::float64}};
    for (const auto& entry : known)
        if (entry.kind == kind && entry.size == size) return entry.type;
    return {};
}

class NpyParser {
  public:
    NpyParser(const Source& source, std::string_view bytes) : source_(source), bytes_(bytes) {}

    NpyArray parse() {
        const PythonLiteral header = parse_python_literal(header_text());
        const PythonLiteral *descr = header.find("descr"), *order = header.find("fortran_order"),
                            *shape = header.find("shape");
        if (!descr || !order || !shape || shape->kind != PythonLiteral::list)
            refuse("its header has no descr, fortran_order and shape");
        parse_fields(*descr);
        parse_shape(*shape);
        array_.columns_first = order->number != 0;
        check_size();
        return std::move(array_);
    }

  private:
    std::string_view header_text() {
        constexpr std::string_view magic = "\x93NUMPY";
        if (!bytes_.starts_with(magic) || bytes_.size() < 12) refuse("it does not begin with NumPy's mark");
        const bool long_size = bytes_[6] > 1;
        uint32_t size = 0;
        std::memcpy(&size, bytes_.data() + 8, long_size ? 4 : 2);
        const size_t begin = long_size ? 12 : 10;
        if (size > bytes_.size() - begin) refuse("it is truncated within its header");
        array_.data = bytes_.data() + begin + size;
        return bytes_.substr(begin, size);
    }

    TypeCode parse_type(const PythonLiteral& literal) const {
        const std::string& text = literal.text;
        if (literal.kind != PythonLiteral::string || text.size() < 2)
            refuse("it has a type that is not understood");
        const bool has_order = std::string_view("<>|=").find(text[0]) != std::string_view::npos;
        const char kind = text[has_order ? 1 : 0];
        if (kind == 'O') refuse("it holds Python objects");
        TypeCode code{{}, 0, has_order ? text[0] : '|'};
        const char* digits = text.data() + (has_order ? 2 : 1);
        if (std::from_chars(digits, text.data() + text.size(), code.size).ec != std::errc())
            refuse(fmt::format("its type '{}' is not understood", text.substr(0, 40)));
        // Products of sizes stay within 64 bits below.
        if (code.size > most_fields) refuse(fmt::format("its type '{}' is too long", text.substr(0, 40)));
        code.type = scalar_type(kind, code.size);
        if (kind == 'U') code.size *= 4;
        return code;
    }

    void parse_fields(const PythonLiteral& descr) {
        if (descr.kind == PythonLiteral::string) {
            add_field("", parse_type(descr), 1);
            if (array_.fields[0].name == "_") refuse("it does not hold numbers");
            return;
        }
        if (descr.kind != PythonLiteral::list || descr.items.empty())
            refuse("it has a type that is not understood");
        for (const PythonLiteral& field : descr.items) {
            if (field.items.size() < 2 || field.items.size() > 3)
                refuse("it has a field that is not understood");
            const PythonLiteral& name = field.items[0];
            size_t count = 1;
            if (field.items.size() == 3) count = count_of(field.items[2]);
            // A name may be a pair of title and name.
            const std::string& text = name.items.size() == 2 ? name.items[1].text : name.text;
            add_field(text.empty() ? "_" : text, parse_type(field.items[1]), count);
        }
    }

    size_t count_of(const PythonLiteral& shape) const {
        size_t count = 1;
        for (const PythonLiteral& side :
             shape.kind == PythonLiteral::list ? shape.items : std::vector{shape}) {
            if (side.kind != PythonLiteral::integer || side.number < 0 ||
                side.number > int64_t(most_fields) || count * size_t(side.number) > most_fields)
                refuse("it has a field whose shape is not understood");
            count *= size_t(side.number);
        }
        return count;
    }

    void add_field(const std::string& name, const TypeCode& code, size_t count) {
        if (code.order == '<' || code.order == '>') {
            const std::endian endian = code.order == '<' ? std::endian::little : std::endian::big;
            if (ordered_ && endian != array_.endian) refuse("its fields have different byte orders");
            array_.endian = endian;
            ordered_ = true;
        }
        if (code.type)
            array_.fields.push_back({name, *code.type, count});
        else
            array_.fields.push_back({"_", ScalarType::uint8, code.size * count});
        values_ += array_.fields.back().count;
        if (values_ > most_fields) refuse(fmt::format("it has more than {} values in a row", most_fields));
    }

    void parse_shape(const PythonLiteral& shape) {
        if (shape.items.size() > most_dimensions) refuse("it has too many dimensions");
        for (const PythonLiteral& side : shape.items) {
            if (side.kind != PythonLiteral::integer || side.number < 0) refuse("its shape is not understood");
            array_.shape.push_back(size_t(side.number));
        }
    }

    void check_size() const {
        size_t item = 0;
        for (const NpyArray::Field& field : array_.fields) item += field.count * size_of(field.type);
        const size_t left = size_t(bytes_.data() + bytes_.size() - array_.data);
        // The product is compared step by step, so that it cannot overflow.
        if (item == 0) refuse("it does not hold numbers");
        size_t room = left / item;
        bool empty = false;
        for (const size_t side : array_.shape) empty = empty || side == 0;
        for (const size_t side : array_.shape)
            if (!empty) room /= side;
        if (empty && array_.columns() > most_fields)
            refuse(fmt::format("it has more than {} values in a row", most_fields));
        if (!empty && room == 0)
            refuse(
                fmt::format("it is truncated: items of {} bytes and shape ({}) expected, {} bytes are left",
                            item, fmt::join(array_.shape, ", "), left));
    }

    [[noreturn]] void refuse(std::string_view why) const {
        fail(source_, fmt::format("the array cannot be read: {}", why));
    }

    const Source& source_;
    const std::string_view bytes_;
    bool ordered_ = false;
    size_t values_ = 0;
    NpyArray array_;
};

}  // namespace

size_t NpyArray::size() const {
    return std::accumulate(shape.begin(), shape.end(), size_t(1), std::multiplies<>());
}

std::string NpyArray::shape_text() const {
    return fmt::format("({})", fmt::join(shape, ", "));
}

size_t NpyArray::columns() const {
    return is_structured() || shape.size() < 2 ? 1 : shape.back();
}

size_t NpyArray::rows() const {
    return columns() ? size() / columns() : 0;
}

std::vector<Element> NpyArray::elements(const std::vector<std::string>& names) const {
    Element all{"row", rows(), {}};
    if (is_structured()) {
        for (const Field& field : fields)
            for (const std::string& name : names_of_parts(field.name, field.count))
                all.properties.push_back({name, field.type, {}, 1, 0});
        return {all};
    }
    for (const std::string& name : names) all.properties.push_back({name, fields[0].type, {}, 1, 0});
    if (!columns_first || columns() == 1) return {all};
    std::vector<Element> one_each;
    for (const Property& property : all.properties) one_each.push_back({"row", rows(), {property}});
    return one_each;
}

NpyArray parse_npy(const Source& source, std::string_view bytes) {
    return NpyParser(source, bytes).parse();
}

}  // namespace easypbr::io
