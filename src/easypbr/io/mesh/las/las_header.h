// The header of LAS and LAZ files (ASPRS, "LAS Specification 1.4 - R15", and 1.0 to 1.3).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

struct LasHeader {
    int minor_version = 0;
    int format = 0;           ///< of the point records, 0 to 10
    bool compressed = false;  ///< LAZ
    size_t points = 0;
    size_t record_size = 0;
    size_t body = 0;  ///< first byte of the point records
    Vec3d scale, offset;
    std::string_view laszip;      ///< content of LAZ's own record; empty: there is none
    std::vector<Property> extra;  ///< documented bytes behind the standard fields; "_" for others
    bool has_new_layout() const { return format >= 6; }
};

/// Throws FormatError when it is no LAS, of another version, or contradicts itself.
LasHeader parse_las_header(const Source& source);

/// Standard fields of a record of this format, "_" for what is skipped. The byte with the return number and
/// the number of returns is called "return_number"; legacy classifications have flags in their upper 3 bits.
std::vector<Property> las_fields(const LasHeader& header);

}  // namespace easypbr::io
