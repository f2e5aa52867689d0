// Points of Sobol's sequence, scrambled by hashes: of one sample, or of one in each lane of a vector. All
// functions are inlined, so that no instruction set's copy stands for the others.
#pragma once

#include <cstdint>

#if defined(__GNUC__)
#define EASYPBR_INLINE inline __attribute__((always_inline))
#else
#define EASYPBR_INLINE inline
#endif

namespace easypbr::native {

/// The next state of a permuted congruential generator (Jarzynski and Olano 2020, "Hash Functions for GPU
/// Rendering").
template <class Bits>
EASYPBR_INLINE Bits pcg_advance(Bits state) {
    return state * 747796405u + 2891336453u;
}

/// The number that belongs to a state of the generator.
template <class Bits>
EASYPBR_INLINE Bits pcg_output(Bits state) {
    const Bits word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

template <class Bits>
EASYPBR_INLINE Bits pcg_hash(Bits value) {
    return pcg_output(pcg_advance(value));
}

template <class Bits>
EASYPBR_INLINE Bits reversed_bits(Bits x) {
    x = x << 16 | x >> 16;
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/// Owen's scrambling of a number whose bits are reversed (Burley 2020, "Practical Hash-based Owen
/// Scrambling"; the hash is that of Laine and Karras 2011 with Vegdahl's constants).
template <class Bits>
EASYPBR_INLINE Bits scrambled_reversed(Bits x, Bits seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

/// Second dimension of Sobol's sequence, its bits reversed: a product with Pascal's triangle modulo 2, which
/// is a Kronecker product of five matrices of 2 x 2.
template <class Bits>
EASYPBR_INLINE Bits second_of_sobol(Bits index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0f0f0f0fu;
    index ^= index >> 8 & 0x00ff00ffu;
    return index ^ (index >> 16 & 0x0000ffffu);
}

/// A point as two numbers of 32 bits: sample `reversed_sample`, its bits reversed, of the sequence that
/// `seed` scrambles.
template <class Bits>
EASYPBR_INLINE void sample_point(Bits seed, Bits reversed_sample, Bits& x, Bits& y) {
    const Bits index = reversed_bits(scrambled_reversed(reversed_sample, seed));
    x = reversed_bits(scrambled_reversed(index, pcg_hash(seed + 1u)));
    y = reversed_bits(scrambled_reversed(second_of_sobol(index), pcg_hash(seed + 2u)));
}

/// The seed of a dimension of the sequences of a path.
template <class Bits>
EASYPBR_INLINE Bits seed_of_dimension(Bits seed, uint32_t dimension) {
    return pcg_hash(seed ^ dimension * 0x9e3779b9u);
}

}  // namespace easypbr::native

#undef EASYPBR_INLINE
