// Numbers of any type in binary files to arrays of one type.
#pragma once

#include <cstddef>
#include <cstdint>

#include "easypbr/io/tables/element_table.h"

namespace easypbr::io {

/// Rows of `width` values each; a row begins every `in_stride` bytes and is written every `out_stride`
/// values, as value * scale + shift where the target is of real numbers.
struct ValueBlock {
    const char* in;
    size_t in_stride, rows, width, out_stride;
    double scale = 1, shift = 0;
};

/// Copies the block; `swap`: its numbers are in the other byte order than this machine's. To is float, double
/// or int32_t, where what is no integer of 32 bits becomes -1.
template <class To>
void copy_values(const ValueBlock& block, ScalarType type, bool swap, To* out);

/// Copies the bits of numbers of 4 bytes, whatever they stand for.
void copy_bits(const ValueBlock& block, bool swap, uint32_t* out);

}  // namespace easypbr::io
