// Arrays in NumPy's NPY format (NEP 1; numpy.lib.format), versions 1 to 3.
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

/// An array as it lies in a file.
struct NpyArray {
    /// A field of a structured array; a plain array has one without a name. "_": bytes that are no numbers.
    struct Field {
        std::string name;
        ScalarType type = ScalarType::float32;
        size_t count = 1;
    };
    std::vector<Field> fields;
    std::vector<size_t> shape;
    bool columns_first = false;  ///< Fortran order
    std::endian endian = std::endian::little;
    const char* data = nullptr;  ///< as many bytes as shape and fields say

    bool is_structured() const { return !fields[0].name.empty(); }
    size_t size() const;             ///< product of the shape
    std::string shape_text() const;  ///< "(100, 3)"
    /// All but the last dimension of a plain array, all of a structured one.
    size_t rows() const;
    /// The last dimension of a plain array of two dimensions and more, else 1.
    size_t columns() const;

    /// The array as tables (see read_binary_elements): one, or one for each column in Fortran order. Columns
    /// of a plain array are called as `names` says.
    std::vector<Element> elements(const std::vector<std::string>& names) const;
};

/// Throws FormatError when the bytes are no NPY, hold Python objects, or less than the header says.
NpyArray parse_npy(const Source& source, std::string_view bytes);

}  // namespace easypbr::io
