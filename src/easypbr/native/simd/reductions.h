// One number of all lanes.
#pragma once

#include "easypbr/native/simd/lanes.h"

namespace easypbr::native::EASYPBR_ISA {

// Lanes that many apart change places.
#if defined(__AVX512F__)
#define APART_8 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7
#define APART_4 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11
#define APART_2 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13
#define APART_1 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14
#elif defined(__AVX2__)
#define APART_4 4, 5, 6, 7, 0, 1, 2, 3
#define APART_2 2, 3, 0, 1, 6, 7, 4, 5
#define APART_1 1, 0, 3, 2, 5, 4, 7, 6
#else
#define APART_2 2, 3, 0, 1
#define APART_1 1, 0, 3, 2
#endif
/// One of all lanes, of two by `choose` each.
template <class Choose>
INLINE int folded(Ints a, Choose&& choose) {
#if defined(APART_8)
    a = choose(a, __builtin_shufflevector(a, a, APART_8));
#endif
#if defined(APART_4)
    a = choose(a, __builtin_shufflevector(a, a, APART_4));
#endif
    a = choose(a, __builtin_shufflevector(a, a, APART_2));
    return choose(a, __builtin_shufflevector(a, a, APART_1))[0];
}
#undef APART_8
#undef APART_4
#undef APART_2
#undef APART_1
INLINE int least_of(vint a) {
    return folded(
        a.v, [](Ints b, Ints c) __attribute__((always_inline)) { return b < c ? b : c; });
}
INLINE int largest_of(vint a) {
    return folded(
        a.v, [](Ints b, Ints c) __attribute__((always_inline)) { return b > c ? b : c; });
}

INLINE float largest_of(vfloat a) {
    float largest = a.v[0];
    for (int k = 1; k < lanes; ++k) largest = a.v[k] > largest ? a.v[k] : largest;
    return largest;
}

}  // namespace easypbr::native::EASYPBR_ISA
