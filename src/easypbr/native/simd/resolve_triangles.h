// The surfaces of pixels whose triangle is known: weights of the corners, depth, normal.
#pragma once

#include "easypbr/native/kernels.h"
#include "easypbr/native/simd/samplers.h"

namespace easypbr::native::EASYPBR_ISA {

using Doubles = double __attribute__((vector_size(8 * lanes)));

/// Values of the corners of all lanes: [corner][component][lane].
template <int components>
struct CornerValues {
    alignas(64) float value[3][components][lanes];

    INLINE vfloat at(int c, int i) const { return vfloat(load<Floats>(value[c][i])); }
    INLINE void set(int c, int lane, const float* from) {
        for (int i = 0; i < components; ++i) value[c][i][lane] = from[i];
    }
};
struct Corners : CornerValues<3> {
    INLINE vec3 corner(int c) const { return {at(c, 0), at(c, 1), at(c, 2)}; }
};

INLINE vec3 transformed(const float (&m)[3][3], const vec3& v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// A row of the clip matrix times a point.
INLINE Doubles clip_of(const double (&row)[4], const vec3& p) {
    return row[0] * __builtin_convertvector(p.x.v, Doubles) +
           row[1] * __builtin_convertvector(p.y.v, Doubles) +
           row[2] * __builtin_convertvector(p.z.v, Doubles) + row[3];
}
INLINE vfloat single(Doubles v) {
    return __builtin_convertvector(v, Floats);
}

/// A pixel on a triangle: weights of the corners, right under perspective, and the depth.
struct PixelOnTriangle {
    vfloat weight[3], depth;
    vbool front;
    vfloat x[3], y[3], w[3];  ///< of the corners, from the pixel, in clip coordinates
    vfloat scale;             ///< of the weights

    template <int components>
    INLINE vfloat mean(const CornerValues<components>& v, int i) const {
        return weight[0] * v.at(0, i) + weight[1] * v.at(1, i) + weight[2] * v.at(2, i);
    }
};

/// Weights solve sum b_i (x_i - X w_i, y_i - Y w_i) = 0 for the pixel (X, Y) (Olano and Greer 1997). In
/// double precision: occlusion on a plane notices depths that err by more than their rounding.
INLINE PixelOnTriangle intersect(const double (&clip)[4][4], const Corners& position, Doubles ndc_x,
                                 Doubles ndc_y) {
    Doubles x[3], y[3], z[3], w[3];
    for (int k = 0; k < 3; ++k) {
        const vec3 p = position.corner(k);
        w[k] = clip_of(clip[3], p);
        x[k] = clip_of(clip[0], p) - ndc_x * w[k];
        y[k] = clip_of(clip[1], p) - ndc_y * w[k];
        z[k] = clip_of(clip[2], p);
    }
    Doubles b[3] = {x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0], x[0] * y[1] - y[0] * x[1]};
    const Doubles sum = b[0] + b[1] + b[2], one = 1.0 - Doubles{};
    const auto flat = sum == 0.0;
    for (Doubles& part : b) part = flat ? one / 3.0 : part;
    const Doubles scale = 1.0 / (flat ? one : sum);
    PixelOnTriangle hit;
    for (int k = 0; k < 3; ++k) {
        hit.weight[k] = single(b[k] * scale);
        hit.x[k] = single(x[k]);
        hit.y[k] = single(y[k]);
        hit.w[k] = single(w[k]);
    }
    hit.scale = single(scale);
    hit.depth = single((b[0] * z[0] + b[1] * z[1] + b[2] * z[2]) / (b[0] * w[0] + b[1] * w[1] + b[2] * w[2]));
    hit.front = single(flat ? one : sum) > 0.0f;
    return hit;
}

/// On the side that is seen, where the surface has two.
INLINE vec3 normal_of(const VisibleTriangles& t, const vec3& mean, const vec3& edge1, const vec3& edge2,
                      vbool front) {
    const vbool back = t.mirrored ? front : !front;
    if (t.flat) {
        const vec3 n = normalize(transformed(t.normal_from_mesh, cross(edge1, edge2)));
        return select(back, -n, n);
    }
    const vec3 world = transformed(t.normal_from_mesh, mean);
    const vec3 n = world * (1.0f / max(length(world), 1e-30f));
    if (!t.two_sided) return n;
    if (t.normals_agree) return select(back, -n, n);
    const vec3 face = transformed(t.normal_from_mesh, cross(edge1, edge2));
    const vfloat side = dot(n, face);
    return select(select(back, -side, side) < 0.0f, -n, n);
}

/// Octahedral, two values of 16 bits: shaders/common_encoding.glsl.
INLINE vint encoded_normal(const vec3& n) {
    const vfloat scale = 1.0f / (abs(n.x) + abs(n.y) + abs(n.z));
    const vfloat x = n.x * scale, y = n.y * scale;
    const vbool above = n.z >= 0.0f;
    const vfloat u = select(above, x, (1.0f - abs(y)) * select(x >= 0.0f, 1.0f, -1.0f)),
                 v = select(above, y, (1.0f - abs(x)) * select(y >= 0.0f, 1.0f, -1.0f));
    const auto rounded = [](vfloat c) __attribute__((always_inline)) {
        return to_int(clamp(c * 0.5f + 0.5f, 0.0f, 1.0f) * 65535.0f + 0.5f);
    };
    return rounded(u) | rounded(v) << 16;
}

INLINE void write_emission(const VisibleTriangles& t, const VisiblePixel* pixels, int used, const vec3& e) {
    for (int k = 0; k < used; ++k) {
        const size_t at = size_t(pixels[k].y - t.y) * size_t(t.width) + size_t(pixels[k].x - t.x);
        const Floats4 pixel = {e.x.v[k], e.y.v[k], e.z.v[k], 1.0f};
        std::memcpy(t.emission + 4 * at, &pixel, sizeof pixel);
    }
}

/// Pixels of the lanes on their triangles.
struct VisibleLanes {
    Corners position;
    int used;  ///< lanes beyond repeat the last pixel
    PixelOnTriangle hit;
    vec3 edge1, edge2;

    INLINE VisibleLanes(const VisibleTriangles& t, const VisiblePixel* pixels, int left)
        : used(left < lanes ? left : lanes) {
        Doubles ndc_x, ndc_y;
        for (int k = 0; k < lanes; ++k) {
            const VisiblePixel& pixel = pixels[k < used ? k : used - 1];
            ndc_x[k] = (pixel.x + 0.5) * t.pixel_width - 1;
            ndc_y[k] = 1 - (pixel.y + 0.5) * t.pixel_height;
        }
        each_corner(
            t, pixels, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
                position.set(c, k, t.V + 3 * vertex);
            });
        const vec3 corner = position.corner(0);
        edge1 = position.corner(1) - corner;
        edge2 = position.corner(2) - corner;
        hit = intersect(t.clip_from_mesh, position, ndc_x, ndc_y);
    }

    /// Calls visit(lane, corner, index of the corner, index of the vertex).
    template <class Visit>
    INLINE void each_corner(const VisibleTriangles& t, const VisiblePixel* pixels, Visit&& visit) const {
        for (int k = 0; k < lanes; ++k) {
            const size_t face = size_t(t.first_face) + pixels[k < used ? k : used - 1].face;
            for (int c = 0; c < 3; ++c) visit(k, c, 3 * face + size_t(c), size_t(t.F[3 * face + size_t(c)]));
        }
    }

    INLINE vec3 mean_normal(const VisibleTriangles& t, const VisiblePixel* pixels) const {
        Corners normal;
        each_corner(
            t, pixels, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
                normal.set(c, k, t.N + 3 * vertex);
            });
        return {hit.mean(normal, 0), hit.mean(normal, 1), hit.mean(normal, 2)};
    }
};

/// What pixels hold whatever their shader.
INLINE void write_geometry(const VisibleTriangles& t, const VisiblePixel* pixels, const VisibleLanes& seen,
                           vint normals) {
    for (int k = 0; k < seen.used; ++k) {
        const VisiblePixel& pixel = pixels[k];
        const size_t at = size_t(pixel.y - t.y) * size_t(t.width) + size_t(pixel.x - t.x);
        t.normals[at] = uint32_t(normals.v[k]);
        t.depths[at] = seen.hit.depth.v[k];
        if (t.ids) t.ids[at] = t.id;
        if (t.ids) t.elements[at] = t.first_face + pixel.face + 1;
    }
}

inline void resolve_plain(const VisibleTriangles& t, const VisiblePixel* pixels, int count) {
    for (int first = 0; first < count; first += lanes, pixels += lanes) {
        const VisibleLanes seen(t, pixels, count - first);
        const vec3 mean = t.flat ? vec3(vfloat(0.0f)) : seen.mean_normal(t, pixels);
        const vec3 normal = normal_of(t, mean, seen.edge1, seen.edge2, seen.hit.front);
        write_geometry(t, pixels, seen, encoded_normal(normal));
        for (int k = 0; k < seen.used; ++k) {
            const size_t at = size_t(pixels[k].y - t.y) * size_t(t.width) + size_t(pixels[k].x - t.x);
            t.albedos[at] = t.albedo;
            t.materials[at] = t.material;
        }
        if (t.emission) write_emission(t, pixels, seen.used, vec3(vfloat(0.0f)));
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
