// A piece of an OBJ file, parsed on its own.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/io/source/source.h"

namespace easypbr::io {

/// Which of a corner's three indices.
enum ObjIndex { obj_position, obj_uv, obj_normal };

/// The index of a corner that has none.
inline constexpr int32_t no_index = -1;
/// Of a vertex without a colour beside others that have one.
inline constexpr float no_color = std::numeric_limits<float>::quiet_NaN();

/// Indices of one kind. Those in `relative` count from the first vertex of the chunk, the others from the
/// file's first.
struct ObjIndices {
    std::vector<int32_t> values;
    std::vector<uint32_t> relative;
};

struct ObjChunk {
    std::vector<float> positions, uv, normals;  ///< 3, 2, 3 per vertex
    std::vector<float> colors;                  ///< 3 per vertex; empty when no vertex has one
    std::vector<uint32_t> face_sizes;           ///< corners of each face
    std::array<ObjIndices, 3> corners;          ///< uv and normals are empty when no corner has one
    ObjIndices edges;                           ///< pairs of positions
    std::vector<std::pair<uint32_t, std::string>> materials;  ///< usemtl: number of faces before it, name
    std::vector<std::string> libraries;                       ///< mtllib
    size_t broken_line_count = 0;                             ///< 'l' that are left out
    const char* first_broken_line = nullptr;                  ///< in the source

    size_t vertex_count(ObjIndex kind) const {
        return kind == obj_position ? positions.size() / 3
               : kind == obj_uv     ? uv.size() / 2
                                    : normals.size() / 3;
    }

    /// Of the values, which are as many in a mesh's arrays.
    size_t byte_count() const {
        size_t numbers = positions.size() + uv.size() + normals.size() + colors.size() + face_sizes.size() +
                         edges.values.size() + edges.relative.size();
        for (const ObjIndices& indices : corners) numbers += indices.values.size() + indices.relative.size();
        return numbers * sizeof(float) + materials.size() * sizeof(materials[0]) +
               libraries.size() * sizeof(std::string);
    }
};

/// Throws FormatError with the line of what is not understood, beside 'l', which are counted. `text` is a
/// part of `source` that ends at a line's end; `offset` is subtracted from positions.
ObjChunk parse_obj_chunk(const Source& source, std::string_view text, const Vec3d& offset);

/// The offset of a file's positions (see scene/offset.h), from vertices spread over the text.
Vec3d choose_obj_offset(const Source& source);

}  // namespace easypbr::io
