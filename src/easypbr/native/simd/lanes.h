// Numbers of several pixels at once, and GLSL's functions of them. Compiled once for each instruction set,
// which EASYPBR_ISA names, into a namespace of its own. No operation mixes lanes, none is contracted, and
// approximations are the same everywhere: all instruction sets compute the same bits.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define INLINE inline __attribute__((always_inline))
/// Of functions that are long, rarely needed and called at several places: compiled once.
#define APART __attribute__((noinline))

namespace easypbr::native::EASYPBR_ISA {

#if defined(__AVX512F__)
inline constexpr int lanes = 16;
#elif defined(__AVX2__)
inline constexpr int lanes = 8;
#else
inline constexpr int lanes = 4;
#endif

using Floats = float __attribute__((vector_size(4 * lanes)));
using Ints = int32_t __attribute__((vector_size(4 * lanes)));
using Uints = uint32_t __attribute__((vector_size(4 * lanes)));

INLINE Floats splat(float a) {
    return a - Floats{};
}
INLINE Ints splat(int a) {
    return a - Ints{};
}

/// Towards zero. What is no number or lies beyond all whole numbers becomes the least one, as x86 has it.
INLINE Ints truncated(Floats a) {
    const Ints whole = __builtin_convertvector(a, Ints);
#if defined(__x86_64__)
    return whole;
#else
    return a < 2147483648.0f ? whole : splat(-2147483647 - 1);
#endif
}

struct vint;
struct vuint;

struct vbool {
    Ints v;  ///< 0 or -1
    vbool() = default;
    INLINE vbool(Ints mask) : v(mask) {}
    INLINE vbool(bool b) : v(splat(b ? -1 : 0)) {}
};

struct vfloat {
    Floats v;
    vfloat() = default;
    INLINE vfloat(Floats a) : v(a) {}
    INLINE vfloat(float a) : v(splat(a)) {}
    INLINE vfloat(int a) : v(splat(float(a))) {}
};

struct vint {
    Ints v;
    vint() = default;
    INLINE vint(Ints a) : v(a) {}
    INLINE vint(int a) : v(splat(a)) {}
};

struct vuint {
    Uints v;
    vuint() = default;
    INLINE vuint(Uints a) : v(a) {}
    INLINE vuint(unsigned a) : v(Uints(splat(int(a)))) {}
    INLINE explicit vuint(vint a) : v(Uints(a.v)) {}
    /// Of numbers below 2^31.
    INLINE explicit vuint(vfloat a) : v(Uints(truncated(a.v))) {}
};

INLINE vbool operator&&(vbool a, vbool b) {
    return a.v & b.v;
}
INLINE vbool operator||(vbool a, vbool b) {
    return a.v | b.v;
}
INLINE vbool operator!(vbool a) {
    return ~a.v;
}

INLINE bool any_lane(bool a) {
    return a;
}
INLINE bool any_lane(vbool a) {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(__m512i(a.v), __m512i(a.v)) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_ps(__m256(a.v)) != 0;
#elif defined(__SSE2__)
    return _mm_movemask_ps(__m128(a.v)) != 0;
#else
    int any = 0;
    for (int k = 0; k < lanes; ++k) any |= a.v[k];
    return any != 0;
#endif
}

#define ARITHMETIC(T, op)                 \
    INLINE T operator op(T a, T b) {      \
        return a.v op b.v;                \
    }                                     \
    INLINE T& operator op##=(T& a, T b) { \
        a.v = a.v op b.v;                 \
        return a;                         \
    }
/// As in GLSL whole numbers wrap around: what idle lanes hold may be any number.
#define WRAPPING(T, op)                        \
    INLINE T operator op(T a, T b) {           \
        return Ints(Uints(a.v) op Uints(b.v)); \
    }                                          \
    INLINE T& operator op##=(T& a, T b) {      \
        return a = a op b;                     \
    }
#define COMPARISON(T, op)                \
    INLINE vbool operator op(T a, T b) { \
        return Ints(a.v op b.v);         \
    }
#define COMPARISONS(T) \
    COMPARISON(T, <) COMPARISON(T, >) COMPARISON(T, <=) COMPARISON(T, >=) COMPARISON(T, ==) COMPARISON(T, !=)
#define NUMBER(T)    \
    ARITHMETIC(T, +) \
    ARITHMETIC(T, -) \
    ARITHMETIC(T, *) \
    COMPARISONS(T)
#define SIGNED(T) WRAPPING(T, +) WRAPPING(T, -) WRAPPING(T, *) COMPARISONS(T)
#define BITS(T) ARITHMETIC(T, &) ARITHMETIC(T, |) ARITHMETIC(T, ^)
NUMBER(vfloat)
SIGNED(vint)
NUMBER(vuint)
ARITHMETIC(vfloat, /)
BITS(vint)
BITS(vuint)
#undef BITS
#undef SIGNED
#undef NUMBER
#undef COMPARISONS
#undef COMPARISON
#undef WRAPPING
#undef ARITHMETIC

INLINE vint operator>>(vint a, int n) {
    return a.v >> n;
}
INLINE vint operator>>(vint a, vint n) {
    return a.v >> n.v;
}
INLINE vint operator<<(vint a, int n) {
    return Ints(Uints(a.v) << n);
}
INLINE vuint operator>>(vuint a, int n) {
    return a.v >> n;
}
INLINE vuint operator<<(vuint a, vuint n) {
    return a.v << n.v;
}
INLINE vuint operator~(vuint a) {
    return ~a.v;
}
INLINE vfloat& operator++(vfloat& a) {
    a.v += splat(1.0f);
    return a;
}
INLINE vfloat operator-(vfloat a) {
    return -a.v;
}
INLINE vint operator-(vint a) {
    return Ints(-Uints(a.v));
}

INLINE float to_float(float a) {
    return a;
}
INLINE float to_float(int a) {
    return float(a);
}
INLINE vfloat to_float(vfloat a) {
    return a;
}
INLINE vfloat to_float(vint a) {
    return __builtin_convertvector(a.v, Floats);
}
/// Of numbers below 2^31.
INLINE vfloat to_float(vuint a) {
    return __builtin_convertvector(Ints(a.v), Floats);
}
INLINE int to_int(float a) {
    return int(a);
}
INLINE int to_int(int a) {
    return a;
}
INLINE vint to_int(vfloat a) {
    return truncated(a.v);
}
INLINE vint to_int(vint a) {
    return a;
}
INLINE vint to_int(vuint a) {
    return Ints(a.v);
}
INLINE vfloat as_float(Ints bits) {
    return Floats(bits);
}
INLINE vuint floatBitsToUint(vfloat a) {
    return Uints(a.v);
}
INLINE vfloat uintBitsToFloat(vuint a) {
    return Floats(a.v);
}

INLINE vfloat select(vbool c, vfloat a, vfloat b) {
    return c.v ? a.v : b.v;
}
INLINE vint select(vbool c, vint a, vint b) {
    return c.v ? a.v : b.v;
}
INLINE vuint select(vbool c, vuint a, vuint b) {
    return c.v ? a.v : b.v;
}
INLINE vbool select(vbool c, vbool a, vbool b) {
    return c.v ? a.v : b.v;
}
INLINE vfloat select(vbool c, float a, float b) {
    return c.v ? splat(a) : splat(b);
}
INLINE vint select(vbool c, int a, int b) {
    return c.v ? splat(a) : splat(b);
}
INLINE vfloat select(bool c, vfloat a, vfloat b) {
    return c ? a : b;
}
INLINE float select(bool c, float a, float b) {
    return c ? a : b;
}
INLINE int select(bool c, int a, int b) {
    return c ? a : b;
}

// The second where one is not a number, as x86 has it.
INLINE vfloat min(vfloat a, vfloat b) {
#if defined(__AVX512F__)
    return Floats(_mm512_min_ps(a.v, b.v));
#elif defined(__AVX2__)
    return Floats(_mm256_min_ps(a.v, b.v));
#elif defined(__SSE2__)
    return Floats(_mm_min_ps(a.v, b.v));
#else
    return a.v < b.v ? a.v : b.v;
#endif
}
INLINE vfloat max(vfloat a, vfloat b) {
#if defined(__AVX512F__)
    return Floats(_mm512_max_ps(a.v, b.v));
#elif defined(__AVX2__)
    return Floats(_mm256_max_ps(a.v, b.v));
#elif defined(__SSE2__)
    return Floats(_mm_max_ps(a.v, b.v));
#else
    return a.v > b.v ? a.v : b.v;
#endif
}
INLINE float min(float a, float b) {
    return a < b ? a : b;
}
INLINE float max(float a, float b) {
    return a > b ? a : b;
}
INLINE vint min(vint a, vint b) {
    return a.v < b.v ? a.v : b.v;
}
INLINE vint max(vint a, vint b) {
    return a.v > b.v ? a.v : b.v;
}
INLINE vfloat clamp(vfloat x, vfloat low, vfloat high) {
    return min(max(x, low), high);
}
INLINE vint clamp(vint x, vint low, vint high) {
    return min(max(x, low), high);
}
INLINE vfloat sqrt(vfloat a) {
#if defined(__AVX512F__)
    return Floats(_mm512_sqrt_ps(a.v));
#elif defined(__AVX2__)
    return Floats(_mm256_sqrt_ps(a.v));
#elif defined(__SSE2__)
    return Floats(_mm_sqrt_ps(a.v));
#else
    for (int k = 0; k < lanes; ++k) a.v[k] = __builtin_sqrtf(a.v[k]);
    return a;
#endif
}
INLINE vfloat inversesqrt(vfloat a) {
    return vfloat(1.0f) / sqrt(a);
}
INLINE vfloat floor(vfloat a) {
#if defined(__AVX512F__)
    return Floats(_mm512_roundscale_ps(a.v, 1));
#elif defined(__AVX2__)
    return Floats(_mm256_floor_ps(a.v));
#elif defined(__SSE4_1__)
    return Floats(_mm_floor_ps(a.v));
#else
    for (int k = 0; k < lanes; ++k) a.v[k] = __builtin_floorf(a.v[k]);
    return a;
#endif
}
INLINE vfloat abs(vfloat a) {
    return as_float(Ints(a.v) & 0x7fffffff);
}
INLINE int abs(int a) {
    return a < 0 ? -a : a;
}
INLINE vfloat ceil(vfloat a) {
    return -floor(-a);
}
INLINE vfloat mod(vfloat a, vfloat b) {
    return a - b * floor(a / b);
}
INLINE int clamp(int x, int low, int high) {
    return x < low ? low : x > high ? high : x;
}
/// The number of bits that are 1.
INLINE vint bitCount(vuint a) {
    Uints x = a.v;
    x = x - ((x >> 1) & 0x55555555u);
    x = (x & 0x33333333u) + ((x >> 2) & 0x33333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0fu;
    return Ints((x * 0x01010101u) >> 24);
}
/// Halves away from minus infinity.
INLINE vfloat round(vfloat a) {
    return floor(a + 0.5f);
}
INLINE vfloat fract(vfloat a) {
    return a - floor(a);
}
INLINE vfloat mix(vfloat a, vfloat b, vfloat t) {
    return a + (b - a) * t;
}
INLINE vfloat mix(float a, vfloat b, float t) {
    return mix(vfloat(a), b, vfloat(t));
}
INLINE vfloat mix(vfloat a, vfloat b, vbool t) {
    return select(t, b, a);
}
INLINE vfloat smoothstep(vfloat low, vfloat high, vfloat x) {
    const vfloat t = clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}
INLINE vfloat step(vfloat edge, vfloat x) {
    return select(x < edge, 0.0f, 1.0f);
}

/// Relative error below 2e-7.
INLINE vfloat exp2(vfloat x) {
    x = clamp(x, -126.0f, 127.9f);
    const vfloat whole = floor(x + 0.5f), f = x - whole;
    // By Estrin's scheme: each of its steps waits for fewer than Horner's rule.
    const vfloat f2 = f * f, low = (0.69314718f * f + 1.0f) + (0.0555041f * f + 0.24022651f) * f2,
                 high = (0.00133336f * f + 0.00961813f) + 0.000154035f * f2;
    const vfloat p = low + high * (f2 * f2);
    return p * as_float((truncated(whole.v) + 127) << 23);
}
INLINE vfloat exp(vfloat x) {
    return exp2(x * 1.44269504f);
}
/// Of positive numbers, from the mantissa in [1/sqrt 2, sqrt 2) by the series of artanh. Absolute error below
/// 1e-6.
INLINE vfloat log2(vfloat x) {
    const Ints bits = Ints(x.v), exponent = (bits - 0x3f3504f3) >> 23;
    const vfloat mantissa = as_float(bits - (exponent << 23));
    const vfloat t = (mantissa - 1.0f) / (mantissa + 1.0f), t2 = t * t;
    vfloat p = 0.41219859f;
    p = p * t2 + 0.57707802f;
    p = p * t2 + 0.96179669f;
    p = p * t2 + 2.88539008f;
    return to_float(vint(exponent)) + p * t;
}
INLINE vfloat log(vfloat x) {
    return log2(x) * 0.693147181f;
}
/// Of a base that is not negative.
INLINE vfloat pow(vfloat base, vfloat exponent) {
    return select(base > 0.0f, exp2(exponent * log2(base)), vfloat(0.0f));
}
/// Of 16 values.
INLINE vfloat table_at(const float (&table)[16], vint index) {
#if defined(__AVX512F__)
    return Floats(_mm512_permutexvar_ps(__m512i(index.v), _mm512_loadu_ps(table)));
#elif defined(__AVX2__)
    const __m256i i = __m256i(index.v);
    const __m256 first = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), i),
                 last = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table + 8), i);
    return Floats(_mm256_blendv_ps(first, last, _mm256_castsi256_ps(_mm256_slli_epi32(i, 28))));
#else
    Floats values;
    for (int k = 0; k < lanes; ++k) values[k] = table[index.v[k]];
    return values;
#endif
}
/// x^(1 / 2.4) for x from 2^-9 to 100; nearest to it beyond. A minimax polynomial of the mantissa, times the
/// power of the exponent: relative error below 2e-6.
INLINE vfloat root_2_4(vfloat x) {
    static constexpr float powers[16] = {0.0743254423f, 0.0992125645f, 0.132432893f, 0.176776692f,
                                         0.235968575f,  0.314980268f,  0.420448214f, 0.561231017f,
                                         0.749153554f,  1.0f,          1.33483982f,  1.78179741f,
                                         2.37841415f,   3.174802065f,  4.23785257f,  5.656854153f};
    const Ints bits = Ints(clamp(x, 0.001953125f, 100.0f).v);
    const vfloat t = as_float((bits & 0x007fffff) | 0x3f800000) - 1.5f;
    vfloat p = 0.005435364320874214f;
    p = p * t - 0.010651716962456703f;
    p = p * t + 0.022361593320965767f;
    p = p * t - 0.06386099010705948f;
    p = p * t + 0.32891014218330383f;
    p = p * t + 1.1840523481369019f;
    return p * table_at(powers, (bits >> 23) - 118);
}
/// Abramowitz and Stegun 4.4.46.
INLINE vfloat acos(vfloat v) {
    const vfloat x = abs(v);
    vfloat p = -0.0012624911f;
    p = p * x + 0.0066700901f;
    p = p * x - 0.0170881256f;
    p = p * x + 0.0308918810f;
    p = p * x - 0.0501743046f;
    p = p * x + 0.0889789874f;
    p = p * x - 0.2145988016f;
    p = p * x + 1.5707963050f;
    p = p * sqrt(max(1.0f - x, 0.0f));
    return select(v < 0.0f, 3.14159265f - p, p);
}
/// Absolute error below 1e-5 (a minimax polynomial for [0, 1]).
INLINE vfloat atan(vfloat y, vfloat x) {
    const vfloat ax = abs(x), ay = abs(y), a = min(ax, ay) / max(max(ax, ay), 1e-30f), s = a * a;
    vfloat p = -0.01172120f;
    p = p * s + 0.05265332f;
    p = p * s - 0.11643287f;
    p = p * s + 0.19354346f;
    p = p * s - 0.33262347f;
    p = (p * s + 0.99997726f) * a;
    p = select(ay > ax, 1.57079633f - p, p);
    p = select(x < 0.0f, 3.14159265f - p, p);
    return select(y < 0.0f, -p, p);
}
/// By Taylor's series about the nearest multiple of pi / 2, for |x| below 1000.
INLINE void sin_cos(vfloat x, vfloat& sine, vfloat& cosine) {
    const vfloat turns = floor(x * 0.636619772f + 0.5f);
    const vfloat r = x - turns * 1.5707963f, r2 = r * r;
    const Ints n = truncated(turns.v);
    const vfloat s = ((-1.9515296e-4f * r2 + 8.3321609e-3f) * r2 - 1.6666655e-1f) * r2 * r + r;
    const vfloat c = ((2.4433157e-5f * r2 - 1.3887316e-3f) * r2 + 4.1666646e-2f) * r2 * r2 - 0.5f * r2 + 1.0f;
    const vbool odd = Ints((n & 1) != 0);
    sine = as_float(Ints(select(odd, c, s).v) ^ ((n & 2) << 30));
    cosine = as_float(Ints(select(odd, s, c).v) ^ (((n + 1) & 2) << 30));
}
INLINE vfloat sin(vfloat x) {
    vfloat s, c;
    sin_cos(x, s, c);
    return s;
}
INLINE vfloat cos(vfloat x) {
    vfloat s, c;
    sin_cos(x, s, c);
    return c;
}

/// 0, 1, 2 ...
INLINE vint lane_numbers() {
    Ints numbers;
    for (int k = 0; k < lanes; ++k) numbers[k] = k;
    return numbers;
}

}  // namespace easypbr::native::EASYPBR_ISA
