// The random numbers of many paths.
#pragma once

#include "easypbr/native/kernels.h"
#include "easypbr/native/sample_points.h"
#include "easypbr/native/simd/lanes.h"
#include "easypbr/native/simd/texels.h"

namespace easypbr::native::EASYPBR_ISA {

/// In [0, 1), of 24 bits.
INLINE Floats unit_numbers(Uints bits) {
    return __builtin_convertvector(Ints(bits >> 8), Floats) * 0x1p-24f;
}

/// Points of a dimension of paths; see SamplePaths.
inline void sample_paths(const uint32_t* seeds, const uint32_t* reversed_samples, uint32_t dimension,
                         int count, float* xs, float* ys) {
    for (int i = 0; i < count; i += lanes) {
        const auto seed = seed_of_dimension(load<Uints>(seeds + i), dimension);
        Uints x, y;
        sample_point(seed, load<Uints>(reversed_samples + i), x, y);
        const Floats numbers[2] = {unit_numbers(x), unit_numbers(y)};
        std::memcpy(xs + i, &numbers[0], sizeof numbers[0]);
        std::memcpy(ys + i, &numbers[1], sizeof numbers[1]);
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
