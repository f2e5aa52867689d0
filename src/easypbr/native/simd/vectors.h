// GLSL's vectors of lanes.
#pragma once

#include "easypbr/native/simd/lanes.h"
#include "easypbr/native/views.h"

namespace easypbr::native::EASYPBR_ISA {

struct ivec2;
struct uvec3;
struct vec3;

struct bvec2 {
    vbool x, y;
};
struct bvec3 {
    vbool x, y, z;
};
struct bvec4 {
    vbool x, y, z, w;
};

struct vec2 {
    vfloat x, y;
    vec2() = default;
    INLINE vec2(vfloat a, vfloat b) : x(a), y(b) {}
    INLINE explicit vec2(vfloat a) : x(a), y(a) {}
    INLINE explicit vec2(const ivec2& v);
    INLINE vec2(const uni::vec2& v) : x(v.x), y(v.y) {}
    INLINE vfloat operator[](int i) const { return i == 0 ? x : y; }
    INLINE vec2 xy() const { return *this; }
    INLINE vec2 yx() const { return {y, x}; }
    INLINE void set_xy(const vec2& v) { *this = v; }
};

struct vec3 {
    vfloat x, y, z;
    vec3() = default;
    INLINE vec3(vfloat a, vfloat b, vfloat c) : x(a), y(b), z(c) {}
    INLINE vec3(const vec2& v, vfloat c) : x(v.x), y(v.y), z(c) {}
    INLINE vec3(vfloat a, const vec2& v) : x(a), y(v.x), z(v.y) {}
    INLINE explicit vec3(vfloat a) : x(a), y(a), z(a) {}
    INLINE explicit vec3(const bvec3& v);
    INLINE explicit vec3(const uvec3& v);
    INLINE vec3(const uni::vec3& v) : x(v.x), y(v.y), z(v.z) {}
    INLINE vfloat operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    INLINE vec2 xy() const { return {x, y}; }
    INLINE vec2 yx() const { return {y, x}; }
    INLINE vec2 yz() const { return {y, z}; }
    INLINE vec2 xz() const { return {x, z}; }
    INLINE vec3 xyz() const { return *this; }
    INLINE vec3 yzx() const { return {y, z, x}; }
    INLINE vec3 zxy() const { return {z, x, y}; }
    INLINE void set_xy(const vec2& v) {
        x = v.x;
        y = v.y;
    }
};

struct vec4 {
    vfloat x, y, z, w;
    vec4() = default;
    INLINE vec4(vfloat a, vfloat b, vfloat c, vfloat d) : x(a), y(b), z(c), w(d) {}
    INLINE vec4(const vec3& v, vfloat d) : x(v.x), y(v.y), z(v.z), w(d) {}
    INLINE vec4(const vec2& v, vfloat c, vfloat d) : x(v.x), y(v.y), z(c), w(d) {}
    INLINE vec4(const vec2& a, const vec2& b) : x(a.x), y(a.y), z(b.x), w(b.y) {}
    INLINE vec4(vfloat a, const vec2& v, vfloat d) : x(a), y(v.x), z(v.y), w(d) {}
    INLINE explicit vec4(vfloat a) : x(a), y(a), z(a), w(a) {}
    INLINE explicit vec4(const bvec4& v);
    INLINE vec4(const uni::vec4& v) : x(v.x), y(v.y), z(v.z), w(v.w) {}
    INLINE vec2 xy() const { return {x, y}; }
    INLINE vec2 yz() const { return {y, z}; }
    INLINE vec2 zw() const { return {z, w}; }
    INLINE vec2 wx() const { return {w, x}; }
    INLINE vec2 zy() const { return {z, y}; }
    INLINE vec3 xyz() const { return {x, y, z}; }
    INLINE void set_xyz(const vec3& v) {
        x = v.x;
        y = v.y;
        z = v.z;
    }
};

/// As a pixel of four channels.
INLINE vec4 channels_of(const vec4& v) {
    return v;
}
INLINE vec4 channels_of(const vec3& v) {
    return {v, 1.0f};
}
INLINE vec4 channels_of(const vec2& v) {
    return {v, 0.0f, 1.0f};
}
INLINE vec4 channels_of(vfloat v) {
    return {v, 0.0f, 0.0f, 1.0f};
}

struct ivec2 {
    vint x, y;
    INLINE ivec2(vint a, vint b) : x(a), y(b) {}
    INLINE explicit ivec2(vint a) : x(a), y(a) {}
    INLINE explicit ivec2(const vec2& v) : x(to_int(v.x)), y(to_int(v.y)) {}
};

struct ivec3 {
    vint x, y, z;
    INLINE ivec3(const ivec2& v, vint c) : x(v.x), y(v.y), z(c) {}
};

struct uvec3 {
    vuint x, y, z;
    INLINE uvec3(vuint a, vuint b, vuint c) : x(a), y(b), z(c) {}
    INLINE explicit uvec3(const vec3& v) : x(vuint(v.x)), y(vuint(v.y)), z(vuint(v.z)) {}
};
struct uvec4 {
    vuint x, y, z, w;
};

INLINE vec2::vec2(const ivec2& v) : x(to_float(v.x)), y(to_float(v.y)) {}
INLINE vec3::vec3(const uvec3& v) : x(to_float(v.x)), y(to_float(v.y)), z(to_float(v.z)) {}
INLINE vec3::vec3(const bvec3& v)
    : x(select(v.x, 1.0f, 0.0f)), y(select(v.y, 1.0f, 0.0f)), z(select(v.z, 1.0f, 0.0f)) {}
INLINE vec4::vec4(const bvec4& v)
    : x(select(v.x, 1.0f, 0.0f)),
      y(select(v.y, 1.0f, 0.0f)),
      z(select(v.z, 1.0f, 0.0f)),
      w(select(v.w, 1.0f, 0.0f)) {}

INLINE ivec2 operator+(const ivec2& a, const ivec2& b) {
    return {a.x + b.x, a.y + b.y};
}
INLINE ivec2 operator-(const ivec2& a, const ivec2& b) {
    return {a.x - b.x, a.y - b.y};
}
INLINE ivec2 operator+(const ivec2& a, vint b) {
    return {a.x + b, a.y + b};
}
INLINE ivec2 operator-(const ivec2& a, vint b) {
    return {a.x - b, a.y - b};
}
INLINE ivec2 operator-(vint a, const ivec2& b) {
    return {a - b.x, a - b.y};
}
INLINE ivec2 operator*(vint a, const ivec2& b) {
    return {a * b.x, a * b.y};
}
INLINE ivec2 operator&(const ivec2& a, vint b) {
    return {a.x & b, a.y & b};
}
INLINE ivec2 min(const ivec2& a, const ivec2& b) {
    return {min(a.x, b.x), min(a.y, b.y)};
}
INLINE ivec2 max(const ivec2& a, const ivec2& b) {
    return {max(a.x, b.x), max(a.y, b.y)};
}
INLINE ivec2 clamp(const ivec2& v, const ivec2& low, const ivec2& high) {
    return {clamp(v.x, low.x, high.x), clamp(v.y, low.y, high.y)};
}
INLINE uvec3 operator&(const uvec3& a, unsigned b) {
    return {a.x & b, a.y & b, a.z & b};
}
INLINE uvec3 floatBitsToUint(const vec3& a) {
    return {floatBitsToUint(a.x), floatBitsToUint(a.y), floatBitsToUint(a.z)};
}

// Component by component. EACH(f) lists f(x), f(y) ...
#define EACH2(f) f(x), f(y)
#define EACH3(f) f(x), f(y), f(z)
#define EACH4(f) f(x), f(y), f(z), f(w)
#define PLUS(c) a.c + b.c
#define MINUS(c) a.c - b.c
#define TIMES(c) a.c* b.c
#define OVER(c) a.c / b.c
#define NEGATIVE(c) -a.c
#define OPERATOR(V, EACH, op, TERM)                \
    INLINE V operator op(const V& a, const V& b) { \
        return {EACH(TERM)};                       \
    }                                              \
    INLINE V operator op(const V& a, vfloat b) {   \
        return a op V(b);                          \
    }                                              \
    INLINE V operator op(vfloat a, const V& b) {   \
        return V(a) op b;                          \
    }                                              \
    INLINE V& operator op##=(V& a, const V& b) {   \
        return a = a op b;                         \
    }                                              \
    INLINE V& operator op##=(V& a, vfloat b) {     \
        return a = a op V(b);                      \
    }
#define MIN(c) min(a.c, b.c)
#define MAX(c) max(a.c, b.c)
#define POW(c) pow(a.c, b.c)
#define STEP(c) step(a.c, b.c)
#define ABS(c) abs(a.c)
#define FLOOR(c) floor(a.c)
#define FRACT(c) fract(a.c)
#define ROUND(c) round(a.c)
#define SQRT(c) sqrt(a.c)
#define LOG2(c) log2(a.c)
#define EXP2(c) exp2(a.c)
#define EXP(c) exp(a.c)
#define LOG(c) log(a.c)
#define COS(c) cos(a.c)
#define ROOT(c) root_2_4(a.c)
#define MIX(c) mix(a.c, b.c, t.c)
#define SELECT(c) select(condition, a.c, b.c)
#define UNARY(V, EACH, name, TERM) \
    INLINE V name(const V& a) {    \
        return {EACH(TERM)};       \
    }
#define BINARY(V, EACH, name, TERM)         \
    INLINE V name(const V& a, const V& b) { \
        return {EACH(TERM)};                \
    }                                       \
    INLINE V name(const V& a, vfloat b) {   \
        return name(a, V(b));               \
    }
#define VECTOR(V, EACH)                                        \
    OPERATOR(V, EACH, +, PLUS)                                 \
    OPERATOR(V, EACH, -, MINUS)                                \
    OPERATOR(V, EACH, *, TIMES)                                \
    OPERATOR(V, EACH, /, OVER)                                 \
    UNARY(V, EACH, operator-, NEGATIVE)                        \
    UNARY(V, EACH, abs, ABS)                                   \
    UNARY(V, EACH, floor, FLOOR)                               \
    UNARY(V, EACH, fract, FRACT)                               \
    UNARY(V, EACH, round, ROUND)                               \
    UNARY(V, EACH, sqrt, SQRT)                                 \
    UNARY(V, EACH, log2, LOG2)                                 \
    UNARY(V, EACH, exp2, EXP2)                                 \
    UNARY(V, EACH, exp, EXP)                                   \
    UNARY(V, EACH, log, LOG)                                   \
    UNARY(V, EACH, root_2_4, ROOT)                             \
    UNARY(V, EACH, cos, COS)                                   \
    BINARY(V, EACH, min, MIN)                                  \
    BINARY(V, EACH, max, MAX)                                  \
    BINARY(V, EACH, pow, POW)                                  \
    BINARY(V, EACH, step, STEP)                                \
    INLINE V clamp(const V& a, vfloat low, vfloat high) {      \
        return min(max(a, low), high);                         \
    }                                                          \
    INLINE V clamp(const V& a, const V& low, const V& high) {  \
        return min(max(a, low), high);                         \
    }                                                          \
    INLINE V mix(const V& a, const V& b, const V& t) {         \
        return {EACH(MIX)};                                    \
    }                                                          \
    INLINE V mix(const V& a, const V& b, vfloat t) {           \
        return mix(a, b, V(t));                                \
    }                                                          \
    INLINE V mix(vfloat a, const V& b, const V& t) {           \
        return mix(V(a), b, t);                                \
    }                                                          \
    INLINE V step(vfloat edge, const V& b) {                   \
        return step(V(edge), b);                               \
    }                                                          \
    INLINE V select(vbool condition, const V& a, const V& b) { \
        return {EACH(SELECT)};                                 \
    }                                                          \
    INLINE V select(bool condition, const V& a, const V& b) {  \
        return condition ? a : b;                              \
    }
VECTOR(vec2, EACH2)
VECTOR(vec3, EACH3)
VECTOR(vec4, EACH4)
#undef VECTOR
#undef BINARY
#undef UNARY
#undef SELECT
#undef MIX
#undef ROOT
#undef COS
#undef LOG
#undef EXP
#undef EXP2
#undef LOG2
#undef SQRT
#undef ROUND
#undef FRACT
#undef FLOOR
#undef ABS
#undef STEP
#undef POW
#undef MAX
#undef MIN
#undef OPERATOR
#undef NEGATIVE
#undef OVER
#undef TIMES
#undef MINUS
#undef PLUS
#undef EACH4
#undef EACH3
#undef EACH2

INLINE vfloat dot(const vec2& a, const vec2& b) {
    return a.x * b.x + a.y * b.y;
}
INLINE vfloat dot(const vec3& a, const vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
INLINE vfloat dot(const vec4& a, const vec4& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
INLINE vbool operator==(const vec2& a, const vec2& b) {
    return a.x == b.x && a.y == b.y;
}
INLINE vbool operator==(const vec3& a, const vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}
INLINE vfloat length(const vec2& a) {
    return sqrt(dot(a, a));
}
INLINE vfloat distance(const vec2& a, const vec2& b) {
    return length(a - b);
}
INLINE vfloat length(const vec3& a) {
    return sqrt(dot(a, a));
}
INLINE vfloat distance(const vec3& a, const vec3& b) {
    return length(a - b);
}
INLINE vec3 normalize(const vec3& a) {
    return a * inversesqrt(dot(a, a));
}
INLINE vec3 reflect(const vec3& i, const vec3& n) {
    return i - n * (2.0f * dot(n, i));
}
INLINE vec3 cross(const vec3& a, const vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Zero where all is reflected.
INLINE vec3 refract(const vec3& i, const vec3& n, vfloat eta) {
    const vfloat cosine = dot(n, i), k = 1.0f - eta * eta * (1.0f - cosine * cosine);
    return select(k < 0.0f, vec3(vfloat(0.0f)), eta * i - (eta * cosine + sqrt(k)) * n);
}
INLINE bvec2 lessThan(const vec2& a, const vec2& b) {
    return {a.x < b.x, a.y < b.y};
}
INLINE bvec2 greaterThanEqual(const vec2& a, const vec2& b) {
    return {a.x >= b.x, a.y >= b.y};
}
INLINE bvec3 lessThan(const vec3& a, const vec3& b) {
    return {a.x < b.x, a.y < b.y, a.z < b.z};
}
INLINE bvec3 lessThanEqual(const vec3& a, const vec3& b) {
    return {a.x <= b.x, a.y <= b.y, a.z <= b.z};
}
INLINE bvec4 lessThanEqual(const vec4& a, const vec4& b) {
    return {a.x <= b.x, a.y <= b.y, a.z <= b.z, a.w <= b.w};
}
INLINE bvec3 greaterThan(const vec3& a, const vec3& b) {
    return {a.x > b.x, a.y > b.y, a.z > b.z};
}
INLINE bvec4 greaterThan(const vec4& a, const vec4& b) {
    return {a.x > b.x, a.y > b.y, a.z > b.z, a.w > b.w};
}
INLINE vbool all(const bvec2& a) {
    return a.x && a.y;
}
INLINE vbool any(const bvec3& a) {
    return a.x || a.y || a.z;
}
INLINE vec3 mix(const vec3& a, const vec3& b, const bvec3& t) {
    return {select(t.x, b.x, a.x), select(t.y, b.y, a.y), select(t.z, b.z, a.z)};
}
INLINE vec3 operator*(const mat3& m, const vec3& v) {
    return {m.m[0] * v.x + m.m[3] * v.y + m.m[6] * v.z, m.m[1] * v.x + m.m[4] * v.y + m.m[7] * v.z,
            m.m[2] * v.x + m.m[5] * v.y + m.m[8] * v.z};
}
INLINE vec3 operator*(const vec3& v, const mat3& m) {
    return {m.m[0] * v.x + m.m[1] * v.y + m.m[2] * v.z, m.m[3] * v.x + m.m[4] * v.y + m.m[5] * v.z,
            m.m[6] * v.x + m.m[7] * v.y + m.m[8] * v.z};
}

}  // namespace easypbr::native::EASYPBR_ISA
