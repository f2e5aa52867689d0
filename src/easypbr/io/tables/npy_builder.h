// The header of an NPY file, version 1.0.
#pragma once

#include <string>

namespace easypbr::io {

/// `descr` and `shape` as Python writes them. The array's data follow, row by row.
std::string npy_header(const std::string& descr, const std::string& shape);

}  // namespace easypbr::io
