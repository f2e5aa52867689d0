// Vertices as rows of numbers: what PLY, PCD, NPY and text files are written of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "easypbr/io/tables/element_table.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// Neighbouring fields of one type, and how they are written for a row, in this machine's byte order.
struct RowPart {
    std::vector<std::string> names;
    ScalarType type = ScalarType::float32;
    std::function<void(Eigen::Index row, char* out)> write;
    size_t size = names.size() * size_of(type);
};

/// Which names and forms a format uses.
struct RowStyle {
    std::vector<std::string> normal_names{"nx", "ny", "nz"};
    std::vector<std::string> uv_names{"s", "t"};
    /// Red, green, blue (and alpha) as one number of 4 bytes, "rgb" or "rgba".
    bool packed_colors = false;
    /// Without types, as in text, the numbers tell what colours range over (see scene/color_range.h).
    bool has_types = true;
};

/// All that a mesh has for its vertices: positions (float64, with the offset added, unless that is zero),
/// normals, colours as bytes (or their fractions of 255, where nothing else tells these from 0 to 1), texture
/// coordinates, tangents, bitangent lengths, labels, intensities, scalars. Names of scalars are
/// scalar_field_names().
std::vector<RowPart> vertex_row_parts(const MeshData& mesh, const RowStyle& style = {});

/// What the scalars of a mesh are called in a file: with '_' for what separates names in some format or
/// quotes them, with a number where that makes two alike, and as scalar_field_name() says.
std::vector<std::string> scalar_field_names(const MeshData& mesh);

/// The scalars that get another name back, for a message: "'heat (K)' as 'heat__K_'".
std::vector<std::string> renamed_scalars(const MeshData& mesh);

/// What the faces have beside their corners: labels and scalars.
std::vector<RowPart> face_row_parts(const MeshData& mesh);

/// The rows one after the other.
void append_rows(const std::vector<RowPart>& parts, size_t count, std::string& out);

/// The rows as text: numbers with the fewest digits that read back as the same.
void append_text_rows(const std::vector<RowPart>& parts, size_t count, char delimiter, std::string& out);

}  // namespace easypbr::io
