// Ellipses in space on the screen: one, or one in each lane of a vector. All functions are inlined, so that
// no instruction set's copy stands for the others.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#if defined(__GNUC__)
#define EASYPBR_INLINE inline __attribute__((always_inline))
#else
#define EASYPBR_INLINE inline
#endif

namespace easypbr::native {

/// No splat gets smaller than a pixel-sized square, which holds exactly one pixel's centre: the screen-space
/// filter of EWA splatting as Botsch et al. 2005 approximate it, made no larger than it has to be.
inline constexpr float least_ellipse_radius = 0.5f;

/// How ellipses in space are looked at.
struct EllipseView {
    float clip_from_mesh[4][4] = {};  ///< [column][row]
    float axial[4] = {};              ///< times a place of the mesh, and 1: the axial distance
    float eye[3] = {};                ///< in the mesh's frame
    float towards_viewer[3] = {};     ///< orthographic, in the mesh's frame
    bool orthographic = false;
    float width = 0, height = 0;  ///< of the picture, pixels
    float near = 0;
    float world_scale = 1;                                          ///< world units in one of the mesh
    float normal_from_mesh[3][3] = {}, world_from_mesh[3][3] = {};  ///< [column][row]
};

/// An ellipse at p with semi-axes t and b covers the points p + u t + v b with u^2 + v^2 <= 1. Homogeneous
/// pixel coordinates relative to the centre's are linear in (u, v, 1), so that the inverse of a 3 x 3 matrix
/// takes a pixel back to (u, v), right under perspective (Sigg et al. 2006, "GPU-Based Ray-Casting of
/// Quadratic Surfaces").
template <class Number>
struct ProjectedEllipse {
    static constexpr size_t members = 22;

    Number centre_x, centre_y;  ///< pixels
    Number tx, ty, bx, by, wc;  ///< columns of the matrix; that of the centre is (0, 0, wc)
    Number qx, qy, qz;          ///< t x b
    Number z_t, z_b, z_c;       ///< axial distance is z_c + u z_t + v z_b
    Number x0, x1, y0, y1;      ///< box, pixels, relative to nothing
    Number per_least;           ///< one over half the side of the smallest square it covers, pixels
    Number band;                ///< others that deep behind the nearest are blended with it
    Number normal[3];           ///< in world space, towards the viewer, of any length

    std::array<Number*, members> all() {
        return {&centre_x, &centre_y,  &tx,   &ty,        &bx,        &by,       &wc, &qx,
                &qy,       &qz,        &z_t,  &z_b,       &z_c,       &x0,       &x1, &y0,
                &y1,       &per_least, &band, &normal[0], &normal[1], &normal[2]};
    }
};

/// Of an ellipse in the mesh's frame.
template <class Number>
struct EllipseVectors {
    Number p[3], t[3], b[3], n[3];  ///< place, semi-axes, normal
};

namespace ellipse_math {

EASYPBR_INLINE float select(bool condition, float a, float b) {
    return condition ? a : b;
}
EASYPBR_INLINE float sqrt(float a) {
    return std::sqrt(a);
}

template <class Number>
EASYPBR_INLINE Number larger(Number a, Number b) {
    return select(a < b, b, a);
}
template <class Number>
EASYPBR_INLINE Number smaller(Number a, Number b) {
    return select(b < a, b, a);
}
template <class Number>
EASYPBR_INLINE Number dot(const Number (&a)[3], const Number (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
EASYPBR_INLINE Number length(const Number (&a)[3]) {
    return sqrt(dot(a, a));
}

/// Half the side of the smallest square of an ellipse whose normal has the cosine `facing` to the direction
/// towards the viewer. Those that turn away lie just behind the rim of closed surfaces, which they would make
/// ragged: seen edge-on they need no pixel of their own.
template <class Number>
EASYPBR_INLINE Number least_radius(Number facing) {
    const Number turned = larger(Number(1e-3f), (Number(0.0f) - facing) * Number(least_ellipse_radius));
    return select(facing < Number(0.0f), turned, Number(least_ellipse_radius));
}

}  // namespace ellipse_math

/// The ellipse; false for one before the near plane or outside of the picture.
template <class Number>
EASYPBR_INLINE auto project_ellipse(const EllipseView& view, const EllipseVectors<Number>& s,
                                    ProjectedEllipse<Number>& to) {
    using namespace ellipse_math;
    const auto& m = view.clip_from_mesh;
    const Number zero = 0.0f, one = 1.0f, half = 0.5f;
    const auto clip = [&](int row, const Number(&v)[3]) __attribute__((always_inline)) {
        return Number(m[0][row]) * v[0] + Number(m[1][row]) * v[1] + Number(m[2][row]) * v[2];
    };
    const auto axial = [&](const Number(&v)[3]) __attribute__((always_inline)) {
        return Number(view.axial[0]) * v[0] + Number(view.axial[1]) * v[1] + Number(view.axial[2]) * v[2];
    };
    Number to_viewer[3];
    for (int k = 0; k < 3; ++k)
        to_viewer[k] = view.orthographic ? Number(view.towards_viewer[k]) : Number(view.eye[k]) - s.p[k];
    const Number lengths = length(s.n) * length(to_viewer), towards = dot(s.n, to_viewer);
    const Number least = least_radius(select(lengths > zero, towards / lengths, one));
    to.per_least = one / least;
    // What has no normal faces the viewer.
    const auto has_normal = dot(s.n, s.n) > zero;
    Number facing[3];
    for (int k = 0; k < 3; ++k)
        facing[k] = select(has_normal, select(towards < zero, zero - s.n[k], s.n[k]), to_viewer[k]);
    for (int k = 0; k < 3; ++k) {
        const auto turned = [&](const float(&matrix)[3][3]) __attribute__((always_inline)) {
            return Number(matrix[0][k]) * facing[0] + Number(matrix[1][k]) * facing[1] +
                   Number(matrix[2][k]) * facing[2];
        };
        to.normal[k] = select(has_normal, turned(view.normal_from_mesh), turned(view.world_from_mesh));
    }
    to.wc = clip(3, s.p) + Number(m[3][3]);
    const Number wt = clip(3, s.t), wb = clip(3, s.b);
    to.z_c = axial(s.p) + Number(view.axial[3]);
    to.z_t = axial(s.t);
    to.z_b = axial(s.b);
    const Number q_ww = wt * wt + wb * wb - to.wc * to.wc;
    // All of it must lie beyond the near plane.
    const auto is_beyond = to.wc > zero && q_ww < zero &&
                           to.z_c - sqrt(to.z_t * to.z_t + to.z_b * to.z_b) > Number(view.near * 0.999f);
    const Number width = view.width, height = view.height;
    to.centre_x = ((clip(0, s.p) + Number(m[3][0])) / to.wc + one) * half * width;
    to.centre_y = (one - (clip(1, s.p) + Number(m[3][1])) / to.wc) * half * height;
    const auto pixel_x = [&](const Number(&v)[3], Number w) __attribute__((always_inline)) {
        return half * width * (clip(0, v) + w) - to.centre_x * w;
    };
    const auto pixel_y = [&](const Number(&v)[3], Number w) __attribute__((always_inline)) {
        return half * height * (w - clip(1, v)) - to.centre_y * w;
    };
    to.tx = pixel_x(s.t, wt);
    to.ty = pixel_y(s.t, wt);
    to.bx = pixel_x(s.b, wb);
    to.by = pixel_y(s.b, wb);
    to.qx = to.ty * wb - wt * to.by;
    to.qy = wt * to.bx - to.tx * wb;
    to.qz = to.tx * to.by - to.ty * to.bx;
    // Extent of the ellipse by its dual conic.
    const auto extent = [&](Number tk, Number bk, Number centre, Number & low, Number & high)
        __attribute__((always_inline)) {
        const Number q_kw = tk * wt + bk * wb, q_kk = tk * tk + bk * bk;
        const Number root = sqrt(larger(zero, q_kw * q_kw - q_ww * q_kk));
        low = centre + smaller((q_kw + root) / q_ww, zero - least);
        high = centre + larger((q_kw - root) / q_ww, least);
    };
    extent(to.tx, to.bx, to.centre_x, to.x0, to.x1);
    extent(to.ty, to.by, to.centre_y, to.y0, to.y1);
    to.band = larger(length(s.t), length(s.b)) * Number(view.world_scale);
    return is_beyond && to.x1 > zero && to.x0 < width && to.y1 > zero && to.y0 < height;
}

}  // namespace easypbr::native

#undef EASYPBR_INLINE
