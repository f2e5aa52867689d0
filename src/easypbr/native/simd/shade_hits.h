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
INLINE void set_uv(mesh_resolve& s, const VisibleTriangles& t, const ElementHit* hits, const HitLanes& seen) {
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

inline void shade_hits(const VisibleTriangles& t, const ElementHit* hits, int count, const HitSurfaces& to) {
    mesh_resolve s;
    static_cast<mesh_resolve_uniforms&>(s) = *static_cast<const mesh_resolve_uniforms*>(t.shader);
    for (int first = 0; first < count; first += lanes, hits += lanes) {
        const HitLanes seen(t, hits, count - first);
        const vec3& face = seen.face;
        s.gl_FrontFacing = dot(transformed(t.normal_from_mesh, cross(seen.edge1, seen.edge2)), face) > 0.0f;
        if (s.sees_by_faces) s.v_face = face;
        if (!s.is_flat) {
            Corners normal;
            seen.each_corner(
                t, hits, [&](int k, int c, size_t, size_t vertex) __attribute__((always_inline)) {
                    normal.set(c, k, t.N + 3 * vertex);
                });
            const vec3 mean(seen.hit.mean(normal, 0), seen.hit.mean(normal, 1), seen.hit.mean(normal, 2));
            s.v_normal = unit_or(transformed(t.normal_from_mesh, mean), face);
        }
        if (s.has_uv) set_uv(s, t, hits, seen);
        if (s.has_vertex_colors) set_color(s, t, hits, seen);
        if (s.has_tangents) set_tangent(s, t, hits, seen);
        const vec3 color = s.base_color().xyz(), parameters = s.read_parameters();
        const vec3 normal = s.read_normals().shading;
        store_components(to.normal, first, select(dot(normal, face) < 0.0f, -normal, normal));
        store_components(to.face, first, face);
        store_components(to.albedo, first, color);
        store_components(to.emission, first, s.emission_of(color));
        store_lanes(to.parameters[0], size_t(first), parameters.x);
        store_lanes(to.parameters[1], size_t(first), parameters.y);
        store_lanes(to.kind, size_t(first), vfloat(s.u_emissive.w));
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
