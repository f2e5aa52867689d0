// The header of a PLY file (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<Element> elements;      ///< those without properties are left out: they have no bytes
    std::vector<std::string> textures;  ///< names in "comment TextureFile NAME"
    std::optional<Vec3d> up;            ///< of "comment up X Y Z"; zero: it has none
    const char* body = nullptr;         ///< first byte after the header
};

/// Throws FormatError with the line of what is not understood.
PlyHeader parse_ply_header(const Source& source);

}  // namespace easypbr::io
