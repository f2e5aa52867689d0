// The header of a PCD file (Point Cloud Library, "The PCD (Point Cloud Data) file format", version 0.7).
#pragma once

#include <string>
#include <vector>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

enum class PcdData { ascii, binary, binary_compressed };

/// A field: `count` neighbouring values of one type.
struct PcdField {
    std::string name;
    ScalarType type = ScalarType::float32;
    size_t count = 1;

    size_t size() const { return count * size_of(type); }
};

struct PcdHeader {
    std::vector<PcdField> fields;
    size_t points = 0;
    size_t rows = 1;  ///< of a depth image; 1: the points have no order
    PcdData data = PcdData::ascii;
    const char* body = nullptr;  ///< first byte after the header
};

/// Throws FormatError with the line of what is not understood or contradicts another line.
PcdHeader parse_pcd_header(const Source& source);

}  // namespace easypbr::io
