// The surfaces of visible triangles by the shader mesh_resolve, and their shadows. Included after the
// shaders.
#pragma once

#include "easypbr/native/simd/resolve_triangles.h"

namespace easypbr::native::EASYPBR_ISA {

/// What the corners' weights change by, times `scale`, when the pixel moves by one of its coordinates: `from`
/// are the corners' other coordinates.
INLINE void weight_changes(const PixelOnTriangle& hit, const vfloat (&from)[3], float step,
                           vfloat (&changes)[3]) {
    const vfloat(&w)[3] = hit.w;
    const vfloat b[3] = {w[2] * from[1] - w[1] * from[2], w[0] * from[2] - w[2] * from[0],
                         w[1] * from[0] - w[0] * from[1]};
    const vfloat sum = b[0] + b[1] + b[2], scale = hit.scale * step;
    for (int k = 0; k < 3; ++k) changes[k] = (b[k] - hit.weight[k] * sum) * scale;
}

template <class Shader>
INLINE void set_uv(Shader& s, const VisibleTriangles& t, const VisiblePixel* pixels,
                   const VisibleLanes& seen) {
    CornerValues<2> uv;
    seen.each_corner(
        t, pixels, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
            uv.set(c, k, t.attributes.uvs + 2 * vertex);
        });
    const PixelOnTriangle& hit = seen.hit;
    s.v_uv = vec2(hit.mean(uv, 0), hit.mean(uv, 1));
    const auto change = [&](const vfloat(&weights)[3]) __attribute__((always_inline)) {
        const auto of = [&](int i) __attribute__((always_inline)) {
            return weights[0] * uv.at(0, i) + weights[1] * uv.at(1, i) + weights[2] * uv.at(2, i);
        };
        return vec2(of(0), of(1));
    };
    vfloat weights[3];
    weight_changes(hit, hit.y, float(t.pixel_width), weights);
    s.v_uv_dx = change(weights);
    weight_changes(hit, hit.x, float(t.pixel_height), weights);
    s.v_uv_dy = change(weights);
}

/// `places` is what the lanes stand for: pixels, or hits of rays.
template <class Shader, class Place, class Lanes>
INLINE void set_color(Shader& s, const VisibleTriangles& t, const Place* places, const Lanes& seen) {
    CornerValues<4> color;
    seen.each_corner(
        t, places, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
            color.set(c, k, t.attributes.colors + 4 * vertex);
        });
    s.v_color = vec4(seen.hit.mean(color, 0), seen.hit.mean(color, 1), seen.hit.mean(color, 2),
                     seen.hit.mean(color, 3));
}

template <class Shader, class Place, class Lanes>
INLINE void set_tangent(Shader& s, const VisibleTriangles& t, const Place* places, const Lanes& seen) {
    CornerValues<4> tangent;
    seen.each_corner(
        t, places, [&](int k, int c, size_t corner, size_t) __attribute__((always_inline)) {
            for (int i = 0; i < 4; ++i)
                tangent.value[c][i][k] =
                    float(t.attributes.tangents[4 * corner + size_t(i)]) * (1.0f / 32767.0f);
        });
    const vec3 mean(seen.hit.mean(tangent, 0), seen.hit.mean(tangent, 1), seen.hit.mean(tangent, 2));
    // A mirrored mesh has mirrored textures.
    const float handedness = t.mirrored ? -1.0f : 1.0f;
    s.v_tangent =
        vec4(transformed(t.attributes.tangent_from_mesh, mean), handedness * seen.hit.mean(tangent, 3));
}

/// Everything that the shader interpolates.
template <class Shader>
INLINE void set_inputs(Shader& s, const VisibleTriangles& t, const VisiblePixel* pixels,
                       const VisibleLanes& seen) {
    s.gl_FrontFacing = t.mirrored ? !seen.hit.front : seen.hit.front;
    if (s.sees_by_faces) {
        const vec3 face = normalize(transformed(t.normal_from_mesh, cross(seen.edge1, seen.edge2)));
        s.v_face = select(s.gl_FrontFacing, face, -face);
    }
    if (!s.is_flat) s.v_normal = transformed(t.normal_from_mesh, seen.mean_normal(t, pixels));
    if (s.has_uv) set_uv(s, t, pixels, seen);
    if (s.has_vertex_colors) set_color(s, t, pixels, seen);
    if (s.has_tangents) set_tangent(s, t, pixels, seen);
}

INLINE vint rounded_bits(vfloat c, float most) {
    return to_int(clamp(c, 0.0f, 1.0f) * most + 0.5f);
}

/// What a pixel holds in the formats of the targets, by its shader.
struct ShadedLanes {
    vint normal, red_green, blue_alpha, material;
    vec3 emission;

    INLINE void set(const vec4& color, const vec2& encoded_normal, const vec4& surface) {
        normal = rounded_bits(encoded_normal.x, 65535) | rounded_bits(encoded_normal.y, 65535) << 16;
        red_green = rounded_bits(color.x, 65535) | rounded_bits(color.y, 65535) << 16;
        blue_alpha = rounded_bits(color.z, 65535) | rounded_bits(color.w, 65535) << 16;
        material = rounded_bits(surface.x, 255) | rounded_bits(surface.y, 255) << 8 |
                   rounded_bits(surface.z, 255) << 16 | rounded_bits(surface.w, 255) << 24;
    }
};

INLINE ShadedLanes shaded(mesh_resolve& s, const VisibleTriangles&, const VisiblePixel*, int) {
    s.main();
    ShadedLanes lanes_of;
    lanes_of.set(s.o_albedo, s.o_normal, s.o_material);
    lanes_of.emission = s.o_emission;
    return lanes_of;
}

INLINE void write_extension(uint32_t* to, const uvec4& v, const VisibleTriangles& t,
                            const VisiblePixel* pixels, int used) {
    for (int k = 0; k < used; ++k) {
        const size_t at = size_t(pixels[k].y - t.y) * size_t(t.width) + size_t(pixels[k].x - t.x);
        const uint32_t pixel[4] = {v.x.v[k], v.y.v[k], v.z.v[k], v.w.v[k]};
        std::memcpy(to + 4 * at, pixel, sizeof pixel);
    }
}

INLINE ShadedLanes shaded(mesh_extended& s, const VisibleTriangles& t, const VisiblePixel* pixels, int used) {
    s.main();
    ShadedLanes lanes_of;
    lanes_of.set(s.o_albedo, s.oct_encode(s.o_normal) * 0.5f + vec2(0.5f),
                 vec4(s.o_parameters, s.u_emissive.w));
    lanes_of.emission = s.o_emission;
    write_extension(t.extensions[0], s.o_first, t, pixels, used);
    write_extension(t.extensions[1], s.o_second, t, pixels, used);
    return lanes_of;
}

template <class Shader, class Uniforms>
inline void resolve_shaded(const VisibleTriangles& t, const VisiblePixel* pixels, int count) {
    Shader s;
    static_cast<Uniforms&>(s) = *static_cast<const Uniforms*>(t.shader);
    for (int first = 0; first < count; first += lanes, pixels += lanes) {
        const VisibleLanes seen(t, pixels, count - first);
        set_inputs(s, t, pixels, seen);
        const ShadedLanes c = shaded(s, t, pixels, seen.used);
        write_geometry(t, pixels, seen, c.normal);
        for (int k = 0; k < seen.used; ++k) {
            const size_t at = size_t(pixels[k].y - t.y) * size_t(t.width) + size_t(pixels[k].x - t.x);
            t.albedos[at] = uint32_t(c.red_green.v[k]) | uint64_t(uint32_t(c.blue_alpha.v[k])) << 32;
            t.materials[at] = uint32_t(c.material.v[k]);
        }
        if (t.emission) write_emission(t, pixels, seen.used, c.emission);
    }
}

inline void resolve_triangles(const VisibleTriangles& t, const VisiblePixel* pixels, int count) {
    if (t.extended)
        resolve_shaded<mesh_extended, mesh_extended_uniforms>(t, pixels, count);
    else if (t.shader)
        resolve_shaded<mesh_resolve, mesh_resolve_uniforms>(t, pixels, count);
    else
        resolve_plain(t, pixels, count);
}

template <class Shader, class Uniforms>
inline void alpha_by(const VisibleTriangles& t, const VisiblePixel* pixels, int count, float* alpha) {
    Shader s;
    static_cast<Uniforms&>(s) = *static_cast<const Uniforms*>(t.shader);
    for (int first = 0; first < count; first += lanes, pixels += lanes) {
        const VisibleLanes seen(t, pixels, count - first);
        if (s.has_uv) set_uv(s, t, pixels, seen);
        // A pixel without extent sees the largest level.
        if (s.u_exact_mask > 0.5f) s.v_uv_dx = s.v_uv_dy = vec2(vfloat(0.0f), vfloat(0.0f));
        if (s.has_vertex_colors) set_color(s, t, pixels, seen);
        const vfloat found = s.base_color().w;
        for (int k = 0; k < seen.used; ++k) alpha[first + k] = found.v[k];
    }
}

inline void alpha_of_triangles(const VisibleTriangles& t, const VisiblePixel* pixels, int count,
                               float* alpha) {
    if (t.extended)
        alpha_by<mesh_extended, mesh_extended_uniforms>(t, pixels, count, alpha);
    else
        alpha_by<mesh_resolve, mesh_resolve_uniforms>(t, pixels, count, alpha);
}

inline void casters_of_triangles(const VisibleTriangles& t, const VisiblePixel* texels, int count,
                                 float* values) {
    shadow_depth s;
    static_cast<shadow_depth_uniforms&>(s) = *static_cast<const shadow_depth_uniforms*>(t.shader);
    for (int first = 0; first < count; first += lanes, texels += lanes) {
        const VisibleLanes seen(t, texels, count - first);
        if (s.has_uv) set_uv(s, t, texels, seen);
        if (s.has_vertex_colors) set_color(s, t, texels, seen);
        const vec4 color = s.caster_color();
        vec3 absorbed(vfloat(0.0f));
        if (s.is_tinting) absorbed = s.absorption_of(s.light_through(color, s.v_uv));
        for (int k = 0; k < seen.used; ++k) {
            const Floats4 value = {absorbed.x.v[k], absorbed.y.v[k], absorbed.z.v[k], color.w.v[k]};
            std::memcpy(values + 4 * size_t(first + k), &value, sizeof value);
        }
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
