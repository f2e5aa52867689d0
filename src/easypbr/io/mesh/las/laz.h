// Compressed points of LAZ files. This library has no decompressor; one can be given to it.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace easypbr::io {

/// Gives the point records of a LAZ file, `size` bytes as LAS has them, from the content of its LASzip record
/// and what begins where its points do, at the byte `place` of the file. Throws an Error that says what is
/// wrong. Called from any thread.
using LazDecompressor =
    std::function<std::string(std::string_view laszip, std::string_view points, size_t place, size_t size)>;

/// For all files that are read from now on; the Python package sets one that asks lazrs. Thread-safe.
void set_laz_decompressor(LazDecompressor decompressor);

}  // namespace easypbr::io
