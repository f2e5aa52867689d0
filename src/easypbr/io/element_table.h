// Tables of a file: elements (vertex, face...) with rows of scalar and list properties, in text or binary
// form, read into columns. PLY is made of them; OFF is read as if it were.
#pragma once

#include <bit>
#include <optional>
#include <string>
#include <vector>

#include "easypbr/io/polygons.h"
#include "easypbr/io/source.h"

namespace easypbr::io {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr size_t size_of(ScalarType type) {
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[size_t(type)];
}

constexpr bool is_integer(ScalarType type) {
    return type < ScalarType::float32;
}

struct Property {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::optional<ScalarType> count_type;  ///< given for a list
};

struct Element {
    std::string name;
    size_t count = 0;
    std::vector<Property> properties;
};

/// Where the values of a property go; a column without any target is skipped.
struct Column {
    float* floats = nullptr;  ///< scalar target: row i goes to floats[i * stride], multiplied by `scale`
    int32_t* integers = nullptr;
    size_t stride = 1;
    float scale = 1;
    List<int32_t>* indices = nullptr;  ///< list targets
    List<float>* values = nullptr;

    bool is_skipped() const { return !floats && !integers && !indices && !values; }
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

/// Reads rows of text, one per line; empty lines are skipped, what follows `comment` (unless 0) and what
/// stands behind the last property is ignored. Throws FormatError with the line.
void read_text_elements(const Source& source, const char* body, char comment,
                        std::vector<ElementPlan>& plans);

/// Throws FormatError when a text file that begins its rows at `body` has less lines than the elements have
/// rows.
void check_text_rows(const Source& source, const char* body, const std::vector<Element>& elements);

}  // namespace easypbr::io
