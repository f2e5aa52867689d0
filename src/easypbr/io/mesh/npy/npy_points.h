// Points in NumPy arrays.
#pragma once

#include "easypbr/io/mesh/cloud_reader.h"
#include "easypbr/io/tables/npy_array.h"
#include "easypbr/io/tables/text_columns.h"

namespace easypbr::io {

/// A structured array by its names, or a plain one of n x 3 positions; what stands behind those is told from
/// the numbers, as in a text without a header. Throws FormatError for other shapes.
BinaryTable point_table(const Source& source, const NpyArray& array);

}  // namespace easypbr::io
