#include "easypbr/io/tables/value_copy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "easypbr/io/tables/misfits.h"

namespace easypbr::io {
namespace {

/// IEEE 754 half precision, as it lies in memory.
struct Half {
    uint16_t bits;

    operator float() const {
        const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
        const float magnitude = exponent == 31  ? (mantissa ? NAN : INFINITY)
                                : exponent == 0 ? std::ldexp(float(mantissa), -24)
                                                : std::ldexp(float(mantissa + 1024), exponent - 25);
        return bits >> 15 ? -magnitude : magnitude;
    }
};

template <class T, bool swap>
T load_value(const char* p) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), p, sizeof(T));
    if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

/// Conversion to an index or label; what is no integer of 32 bits becomes -1.
template <class To, class From>
To convert(From value) {
    if constexpr (std::is_floating_point_v<To>) {
        return To(value);
    } else if constexpr (std::is_integral_v<From>) {
        return std::in_range<To>(value) ? To(value) : To(-1);
    } else {
        return is_int32(double(value)) ? To(double(value)) : To(-1);
    }
}

template <class From, bool swap, class To, class Convert>
void copy_each(const ValueBlock& block, To* out, Convert&& convert_value) {
    for (size_t row = 0; row < block.rows; ++row) {
        const char* in = block.in + row * block.in_stride;
        To* target = out + row * block.out_stride;
        for (size_t k = 0; k < block.width; ++k)
            target[k] = convert_value(load_value<From, swap>(in + k * sizeof(From)));
    }
}

template <class From, bool swap, class To>
void copy_block(const ValueBlock& block, To* out) {
    if (std::is_floating_point_v<To> && (block.scale != 1 || block.shift != 0))
        return copy_each<From, swap>(block, out, [scale = block.scale, shift = block.shift](From value) {
            return To(double(value) * scale + shift);
        });
    copy_each<From, swap>(block, out, [](From value) { return convert<To>(value); });
}

/// The triangle's case of copy_block with its loop unrolled.
template <class To>
void copy_triples(const ValueBlock& block, To* out) {
    for (size_t row = 0; row < block.rows; ++row)
        std::memcpy(out + row * block.out_stride, block.in + row * block.in_stride, 3 * sizeof(To));
}

template <class From, class To>
void copy_block_swapped(const ValueBlock& block, bool swap, To* out) {
    const bool same = std::is_same_v<From, To> && block.scale == 1 && block.shift == 0;
    if (same && !swap && block.width == 3) return copy_triples(block, out);
    swap ? copy_block<From, true>(block, out) : copy_block<From, false>(block, out);
}

}  // namespace

template <class To>
void copy_values(const ValueBlock& block, ScalarType type, bool swap, To* out) {
    switch (type) {
        case ScalarType::int8:
            return copy_block_swapped<int8_t>(block, swap, out);
        case ScalarType::uint8:
            return copy_block_swapped<uint8_t>(block, swap, out);
        case ScalarType::int16:
            return copy_block_swapped<int16_t>(block, swap, out);
        case ScalarType::uint16:
            return copy_block_swapped<uint16_t>(block, swap, out);
        case ScalarType::int32:
            return copy_block_swapped<int32_t>(block, swap, out);
        case ScalarType::uint32:
            return copy_block_swapped<uint32_t>(block, swap, out);
        case ScalarType::int64:
            return copy_block_swapped<int64_t>(block, swap, out);
        case ScalarType::uint64:
            return copy_block_swapped<uint64_t>(block, swap, out);
        case ScalarType::float16:
            return copy_block_swapped<Half>(block, swap, out);
        case ScalarType::float32:
            return copy_block_swapped<float>(block, swap, out);
        case ScalarType::float64:
            return copy_block_swapped<double>(block, swap, out);
    }
}

void copy_bits(const ValueBlock& block, bool swap, uint32_t* out) {
    const auto same = [](uint32_t bits) { return bits; };
    swap ? copy_each<uint32_t, true>(block, out, same) : copy_each<uint32_t, false>(block, out, same);
}

template void copy_values<float>(const ValueBlock&, ScalarType, bool, float*);
template void copy_values<double>(const ValueBlock&, ScalarType, bool, double*);
template void copy_values<int32_t>(const ValueBlock&, ScalarType, bool, int32_t*);

}  // namespace easypbr::io
