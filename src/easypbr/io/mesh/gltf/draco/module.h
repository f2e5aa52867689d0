// What the Draco module exports; libeasypbr finds the function by name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace easypbr::io {

/// An attribute of compressed geometry: what is asked for, and its rows.
struct DracoAttribute {
    uint32_t id = 0;            ///< its unique id in the compressed data
    size_t component_type = 0;  ///< of the rows, as glTF numbers it: 5120 to 5126
    int components = 0;         ///< 1 to 4
    std::vector<std::byte> rows;
};

struct DracoMesh {
    std::vector<uint32_t> indices;  ///< three of each triangle, each less than the rows of the attributes
    std::vector<DracoAttribute> attributes;
};

}  // namespace easypbr::io

extern "C" {
/// Fills the indices, and the rows of the attributes that `mesh` asks for. `error`: what is wrong with the
/// data; empty: nothing. Throws FormatError for more than reading may take.
void easypbr_draco_decode(std::span<const std::byte> bytes, easypbr::io::DracoMesh& mesh, std::string& error);
}
