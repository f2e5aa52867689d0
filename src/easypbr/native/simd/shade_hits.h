// The surfaces of triangles where rays have met them, by the shader mesh_resolve. Included after the shaders.
#pragma once

#include "easypbr/native/simd/shade_triangles.h"

namespace easypbr::native::EASYPBR_ISA {

/// Weights of the corners.
struct PlaceOnTriangle {
    vfloat weight[3];

    template <int components>
    INLINE vfloat mean(const CornerValues<components>& v, int i) const {
        return weight[0] * v.at(0, i) + weight[1] * v.at(1, i) + weight[2] * v.at(2, i);
    }
};

/// Hits of the lanes on their triangles.
struct HitLanes {
    int used;  ///< lanes beyond repeat the last hit
    PlaceOnTriangle hit;
    vec3 edge1, edge2, face;
    vfloat footprint;

    INLINE HitLanes(const VisibleTriangles& t, const ElementHit* hits, int left)
        : used(left < lanes ? left : lanes) {
        for (int k = 0; k < lanes; ++k) {
            const ElementHit& one = hits[k < used ? k : used - 1];
            hit.weight[0].v[k] = 1 - one.u - one.v;
            hit.weight[1].v[k] = one.u;
            hit.weight[2].v[k] = one.v;
            face.x.v[k] = one.normal[0];
            face.y.v[k] = one.normal[1];
            face.z.v[k] = one.normal[2];
            footprint.v[k] = one.footprint;
        }
        Corners position;
        each_corner(
            t, hits, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
                position.set(c, k, t.V + 3 * vertex);
            });
        edge1 = position.corner(1) - position.corner(0);
        edge2 = position.corner(2) - position.corner(0);
    }

    /// See VisibleLanes.
    template <class Visit>
    INLINE void each_corner(const VisibleTriangles& t, const ElementHit* hits, Visit&& visit) const {
        for (int k = 0; k < lanes; ++k) {
            const size_t corner = 3 * size_t(hits[k < used ? k : used - 1].element);
            for (int c = 0; c < 3; ++c) visit(k, c, corner + size_t(c), size_t(t.F[corner + size_t(c)]));
        }
    }
};

/// Texture coordinates, which change over the footprint alike in all directions.
template <class Shader>
INLINE void set_uv(Shader& s, const VisibleTriangles& t, const ElementHit* hits, const HitLanes& seen) {
    CornerValues<2> uv;
    seen.each_corner(
        t, hits, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
            uv.set(c, k, t.attributes.uvs + 2 * vertex);
        });
    s.v_uv = vec2(seen.hit.mean(uv, 0), seen.hit.mean(uv, 1));
    const vec2 d1(uv.at(1, 0) - uv.at(0, 0), uv.at(1, 1) - uv.at(0, 1)),
        d2(uv.at(2, 0) - uv.at(0, 0), uv.at(2, 1) - uv.at(0, 1));
    const vec3 e1 = transformed(t.attributes.tangent_from_mesh, seen.edge1),
               e2 = transformed(t.attributes.tangent_from_mesh, seen.edge2);
    const vfloat area = abs(d1.x * d2.y - d1.y * d2.x) / max(length(cross(e1, e2)), 1e-30f);
    const vfloat change = sqrt(area) * seen.footprint;
    s.v_uv_dx = vec2(change, 0.0f);
    s.v_uv_dy = vec2(0.0f, change);
}

INLINE vec3 unit_or(const vec3& v, const vec3& other) {
    const vfloat d2 = dot(v, v);
    return select(d2 > 1e-30f, v * inversesqrt(max(d2, 1e-30f)), other);
}

INLINE void store_components(float* const (&to)[3], int at, const vec3& v) {
    store_lanes(to[0], size_t(at), v.x);
    store_lanes(to[1], size_t(at), v.y);
    store_lanes(to[2], size_t(at), v.z);
}

INLINE void store_components(float* const (&to)[4], int at, const vec4& v) {
    store_lanes(to[0], size_t(at), v.x);
    store_lanes(to[1], size_t(at), v.y);
    store_lanes(to[2], size_t(at), v.z);
    store_lanes(to[3], size_t(at), v.w);
}

/// Everything that the shader interpolates.
template <class Shader>
INLINE void set_inputs(Shader& s, const VisibleTriangles& t, const ElementHit* hits, const HitLanes& seen) {
    s.gl_FrontFacing = dot(transformed(t.normal_from_mesh, cross(seen.edge1, seen.edge2)), seen.face) > 0.0f;
    if (s.sees_by_faces) s.v_face = seen.face;
    if (!s.is_flat) {
        Corners normal;
        seen.each_corner(
            t, hits, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
                normal.set(c, k, t.N + 3 * vertex);
            });
        const vec3 mean(seen.hit.mean(normal, 0), seen.hit.mean(normal, 1), seen.hit.mean(normal, 2));
        s.v_normal = unit_or(transformed(t.normal_from_mesh, mean), seen.face);
    }
    if (s.has_uv) set_uv(s, t, hits, seen);
    if (s.has_vertex_colors) set_color(s, t, hits, seen);
    if (s.has_tangents) set_tangent(s, t, hits, seen);
}

INLINE void store_surface(mesh_resolve& s, const vec3& face, const HitSurfaces& to, int at) {
    const vec3 color = s.base_color().xyz(), parameters = s.read_parameters();
    const vec3 normal = s.read_normals().shading;
    store_components(to.normal, at, select(dot(normal, face) < 0.0f, -normal, normal));
    store_components(to.face, at, face);
    store_components(to.albedo, at, color);
    store_components(to.emission, at, s.emission_of(color));
    store_lanes(to.parameters[0], size_t(at), parameters.x);
    store_lanes(to.parameters[1], size_t(at), parameters.y);
    store_lanes(to.kind, size_t(at), vfloat(s.u_emissive.w));
}

INLINE void store_surface(mesh_extended& s, const vec3& face, const HitSurfaces& to, int at) {
    s.main();
    const auto towards = [&](const vec3& n) __attribute__((always_inline)) {
        return select(dot(n, face) < 0.0f, -n, n);
    };
    store_components(to.normal, at, towards(s.o_normal));
    store_components(to.face, at, face);
    store_components(to.albedo, at, s.o_albedo.xyz());
    store_components(to.emission, at, s.o_emission);
    store_lanes(to.parameters[0], size_t(at), s.o_parameters.x);
    store_lanes(to.parameters[1], size_t(at), s.o_parameters.y);
    store_lanes(to.kind, size_t(at), vfloat(s.u_emissive.w));
    const HitExtensions& e = to.extensions;
    store_components(e.dielectric, at, s.o_dielectric);
    store_components(e.coat, at, vec4(towards(s.o_coat.xyz()), s.o_coat.w));
    store_components(e.sheen, at, s.o_sheen);
    store_components(e.film, at, s.o_film);
    store_components(e.tangent, at, s.o_tangent);
    store_components(e.volume, at, s.o_volume);
    store_components(e.absorption, at, s.o_absorption);
}

template <class Shader, class Uniforms>
INLINE void shade_hits_by(const VisibleTriangles& t, const ElementHit* hits, int count,
                          const HitSurfaces& to) {
    Shader s;
    static_cast<Uniforms&>(s) = *static_cast<const Uniforms*>(t.shader);
    for (int first = 0; first < count; first += lanes, hits += lanes) {
        const HitLanes seen(t, hits, count - first);
        set_inputs(s, t, hits, seen);
        store_surface(s, seen.face, to, first);
    }
}

inline void shade_hits(const VisibleTriangles& t, const ElementHit* hits, int count, const HitSurfaces& to) {
    if (t.extended)
        shade_hits_by<mesh_extended, mesh_extended_uniforms>(t, hits, count, to);
    else
        shade_hits_by<mesh_resolve, mesh_resolve_uniforms>(t, hits, count, to);
}

}  // namespace easypbr::native::EASYPBR_ISA
