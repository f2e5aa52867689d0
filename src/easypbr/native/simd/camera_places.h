// The places that pixels show, and their surfaces.
#pragma once

#include "easypbr/native/simd/packing.h"

namespace easypbr::native::EASYPBR_ISA {

// Half of the lanes: as many as doubles fill a register.
inline constexpr int half_lanes = lanes / 2;
using HalfFloats = float __attribute__((vector_size(4 * half_lanes)));
using HalfInts = int32_t __attribute__((vector_size(4 * half_lanes)));
using HalfDoubles = double __attribute__((vector_size(8 * half_lanes)));

INLINE void store_half(float* to, HalfDoubles values) {
    const HalfFloats rounded = __builtin_convertvector(values, HalfFloats);
    std::memcpy(to, &rounded, sizeof rounded);
}

/// `position`, `footprint`, and in `away` the way from the eye to the position.
INLINE void half_of_places(const CameraRays& rays, const PixelSurfaces& pixels, int first,
                           const CameraPlaces& to, float* const (&away)[3]) {
    const HalfDoubles x = __builtin_convertvector(load<HalfInts>(pixels.x + first), HalfDoubles),
                      y = __builtin_convertvector(load<HalfInts>(pixels.y + first), HalfDoubles),
                      depth = __builtin_convertvector(load<HalfFloats>(pixels.depth + first), HalfDoubles);
    const HalfDoubles z =
        rays.orthographic ? rays.far + (rays.near - rays.far) * depth : rays.near / depth;
    for (int c = 0; c < 3; ++c) {
        const HalfDoubles across = rays.first[c] + x * rays.column[c] + y * rays.row[c];
        const HalfDoubles way = rays.orthographic ? across - z * rays.back[c] : z * (across - rays.back[c]);
        store_half(to.position[c] + first, way + rays.eye[c]);
        store_half(away[c], way);
    }
    store_half(to.footprint + first, rays.orthographic ? HalfDoubles{} + rays.width : z * rays.width);
}

/// As oct_decode(), of two numbers of 16 bits; unit.
INLINE vec3 decoded_normal(vuint bits) {
    vfloat x = to_float(bits & 0xffffu) / 32767.5f - 1.0f, y = to_float(bits >> 16) / 32767.5f - 1.0f;
    const vfloat z = 1.0f - abs(x) - abs(y), fold = max(-z, 0.0f);
    x = select(x >= 0.0f, x - fold, x + fold);
    y = select(y >= 0.0f, y - fold, y + fold);
    const vfloat length = sqrt(x * x + (y * y + z * z));
    return {x / length, y / length, z / length};
}

inline void find_places(const CameraRays& rays, const PixelSurfaces& pixels, int count,
                        const CameraPlaces& to) {
    for (int first = 0; first < count; first += lanes) {
        float away[3][lanes];
        for (int half = 0; half < lanes; half += half_lanes)
            half_of_places(rays, pixels, first + half, to, {away[0] + half, away[1] + half, away[2] + half});
        const vfloat x = load<Floats>(away[0]), y = load<Floats>(away[1]), z = load<Floats>(away[2]),
                     length = sqrt(x * x + (y * y + z * z));
        for (int c = 0; c < 3; ++c) {
            const vfloat view =
                rays.orthographic ? vfloat(rays.towards[c]) : -(vfloat(load<Floats>(away[c])) / length);
            store_lanes(to.view[c], size_t(first), view);
        }
        const vec3 normal = decoded_normal(load<Uints>(pixels.normal + first));
        for (int c = 0; c < 3; ++c) store_lanes(to.normal[c], size_t(first), normal[c]);
        const vuint red_green = load<Uints>(pixels.red_green + first),
                    blue = load<Uints>(pixels.blue + first), material = load<Uints>(pixels.material + first);
        store_lanes(to.albedo[0], size_t(first), to_float(red_green & 0xffffu) / 65535.0f);
        store_lanes(to.albedo[1], size_t(first), to_float(red_green >> 16) / 65535.0f);
        store_lanes(to.albedo[2], size_t(first), to_float(blue & 0xffffu) / 65535.0f);
        store_lanes(to.parameters[0], size_t(first), to_float(material & 0xffu) / 255.0f);
        store_lanes(to.parameters[1], size_t(first), to_float((material >> 8) & 0xffu) / 255.0f);
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
