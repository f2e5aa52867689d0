// Tables of a file: elements (vertex, face...) with rows of scalar and list properties, in text or binary
// form, read into columns. PLY is made of them; OFF and the formats of point clouds are read as if they were.
#pragma once

#include <array>
#include <bit>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/io/source/source.h"
#include "easypbr/io/tables/misfits.h"
#include "easypbr/io/tables/polygons.h"
#include "easypbr/scene/rounding.h"

namespace easypbr::io {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float16, float32, float64 };

constexpr size_t size_of(ScalarType type) {
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    return sizes[size_t(type)];
}

constexpr bool is_integer(ScalarType type) {
    return type < ScalarType::float16;
}

/// Whether it has numbers within the range of float32 that float32 has not.
constexpr bool is_finer_than_float(ScalarType type) {
    return size_of(type) >= 4 && type != ScalarType::float32;
}

struct Property {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::optional<ScalarType> count_type;  ///< given for a list
    double scale = 1, shift = 0;           ///< a number stands for value * scale + shift
    std::optional<double> missing{};       ///< the value that stands for none, before scale and shift
    bool is_extra = false;                 ///< has a meaning with others of the kind alone, after the rest
};

struct Element {
    std::string name;
    size_t count = 0;
    std::vector<Property> properties;
};

/// Where the values of a property go; a column without any target is skipped.
struct Column {
    /// Scalar target: row i goes to floats[i * stride] as value * scale + shift, computed in double
    /// precision.
    float* floats = nullptr;
    double* doubles = nullptr;  ///< the same; binary only
    /// Scalar target without scale: what is no integer of 32 bits becomes -1, and a warning counts it.
    int32_t* integers = nullptr;
    /// Scalar target of types of 4 bytes: the number's bits. In text those of an integer or, where it is
    /// written as such, of a float.
    uint32_t* bits = nullptr;
    size_t stride = 1;
    double scale = 1, shift = 0;
    List<int32_t>* indices = nullptr;  ///< list targets
    List<float>* values = nullptr;
    Rounding* rounding = nullptr;  ///< beside `floats`: counts what float32 makes of the values

    bool is_scaled() const { return scale != 1 || shift != 0; }
    bool is_skipped() const { return !floats && !doubles && !integers && !bits && !indices && !values; }
};

/// An element and one column per property.
struct ElementPlan {
    const Element* element = nullptr;
    std::vector<Column> columns;
};

/// Least number of bytes that a row takes in binary form.
size_t smallest_row(const Element& element);

/// Reads the elements one after the other from `body` on. Throws FormatError with the byte when the file ends
/// before the rows do or a list has a negative length.
void read_binary_elements(const Source& source, const char* body, std::endian endian,
                          std::vector<ElementPlan>& plans);

/// Reads `count` rows without lists, from row `first` on, that lie at `data`. Counts in `misfits`, for the
/// caller's warning.
void read_binary_rows(const ElementPlan& plan, const char* data, std::endian endian, size_t first,
                      size_t count, Misfits& misfits);

/// How rows of text are written: one per line, numbers between blanks.
struct TextStyle {
    /// What follows it up to the line's end is ignored, and what follows "//"; 0: there are no comments.
    char comment = 0;
    char delimiter =
        0;  ///< between numbers, beside blanks (',', ';' or a tab); nothing between two is NaN; 0: none
};

/// Whether a comment stands at `p`.
inline bool begins_comment(const char* p, const char* end, const TextStyle& style) {
    return style.comment && p != end && (*p == style.comment || (*p == '/' && p + 1 != end && p[1] == '/'));
}

/// A piece of a text.
struct TextChunk {
    const char* begin;
    const char* end;
    size_t row_count;
    size_t first_row;
};

/// The rows of a text from `body` on, counted; empty lines and comments are none.
struct TextRows {
    TextRows(const Source& source, const char* body, TextStyle style);

    size_t count() const { return chunks.empty() ? 0 : chunks.back().first_row + chunks.back().row_count; }

    const char* body;
    TextStyle style;
    std::vector<TextChunk> chunks;  ///< pieces of about 1 MB that end at line ends
};

/// Where rows begin that are spread evenly over [first, first + count), at most offset_sample_count of them.
std::vector<const char*> sample_rows(const TextRows& rows, size_t first, size_t count);

/// Reads the elements' rows one after the other; what stands behind a row's last property is ignored. Throws
/// FormatError with the line.
void read_text_elements(const Source& source, const TextRows& rows, std::vector<ElementPlan>& plans);

/// Throws FormatError when a text file that begins its rows at `body` has less bytes than the elements' rows
/// take.
void check_text_rows(const Source& source, const char* body, const std::vector<Element>& elements);

/// A property among several elements.
struct PropertyPlace {
    size_t element = 0, property = 0;
};

/// The values of properties, which may be of different elements with as many rows, in rows spread evenly, at
/// most offset_sample_count of them; a vector for each row. What is damaged is left out, and all of it where
/// the rows cannot be found without reading all before them (lists).
std::vector<std::vector<double>> sample_binary_rows(const Source& source, const char* body,
                                                    std::endian endian, const std::vector<Element>& elements,
                                                    const std::vector<PropertyPlace>& places);
/// The same for x, y, z (what an offset is chosen by, see scene/offset.h).
std::vector<Vec3d> sample_binary_positions(const Source& source, const char* body, std::endian endian,
                                           const std::vector<Element>& elements,
                                           const std::array<PropertyPlace, 3>& position);
/// The same for text, where the three are of one element.
std::vector<Vec3d> sample_text_positions(const TextRows& rows, const std::vector<Element>& elements,
                                         const std::array<PropertyPlace, 3>& position);

}  // namespace easypbr::io
