// Points of few emissive triangles, for many places at once: see render::Emitters.
#pragma once

#include "easypbr/native/simd/texels.h"

namespace easypbr::native::EASYPBR_ISA {

/// What triangle k sends to places, about and relative to the others; 0 where it is hidden by the mesh that
/// it belongs to.
INLINE vfloat emitter_share(const FewEmitters& e, int k, const vfloat (&from)[3]) {
    // For what is seen of a triangle beside its centre.
    constexpr float least_cosine = 0.05f;
    vfloat apart = 0.0f, facing = 0.0f;
    vbool inside = true;
    for (int c = 0; c < 3; ++c) {
        const vfloat offset = e.centre[c][k] - from[c];
        apart += offset * offset;
        facing += -e.normal[c][k] * offset;
        inside = inside && from[c] >= e.least[c][k] && from[c] <= e.most[c][k];
    }
    const vfloat cosine = abs(facing) * inversesqrt(max(apart, 1e-30f));
    const vfloat share = e.light[k] * (least_cosine + cosine) / max(apart, e.area[k]);
    return select(facing < 0.0f && !inside, vfloat(0.0f), share);
}

INLINE vfloat sum_of_shares(const FewEmitters& e, const vfloat (&from)[3]) {
    vfloat sum = 0.0f;
    for (int k = 0; k < e.count; ++k) sum += emitter_share(e, k, from);
    return sum;
}

INLINE vfloat gather_emitters(const float* values, vint chosen) {
    return as_float(gather(reinterpret_cast<const int32_t*>(values), chosen).v);
}

inline void sample_emitters(const FewEmitters& e, const EmitterPlaces& places, int count,
                            const EmitterPoints& to) {
    for (int first = 0; first < count; first += lanes) {
        vfloat from[3];
        for (int c = 0; c < 3; ++c) from[c] = load<Floats>(places.from[c] + first);
        const vfloat sum = sum_of_shares(e, from), at = vfloat(load<Floats>(places.u + first)) * sum;
        vfloat end = 0.0f, begin = 0.0f, share = 0.0f;
        vint chosen = 0;
        for (int k = 0; k < e.count; ++k) {
            const vfloat own = emitter_share(e, k, from);
            // Of what is left by rounding the last one that sends anything gets all.
            const vbool is_next = own > 0.0f && (end <= at || share <= 0.0f);
            begin = select(is_next, end, begin);
            share = select(is_next, own, share);
            chosen = select(is_next, vint(k), chosen);
            end += own;
        }
        const vfloat u = clamp((at - begin) / max(share, 1e-20f), 0.0f, 1.0f), root = sqrt(u),
                     v = load<Floats>(places.v + first);
        const vfloat weight1 = root * (1.0f - v), weight2 = root * v;
        vfloat step[3], normal[3], apart = 0.0f;
        for (int c = 0; c < 3; ++c) {
            step[c] = gather_emitters(e.corner[c], chosen) + weight1 * gather_emitters(e.edge1[c], chosen) +
                      weight2 * gather_emitters(e.edge2[c], chosen) - from[c];
            normal[c] = gather_emitters(e.normal[c], chosen);
            apart += step[c] * step[c];
        }
        const vfloat distance = sqrt(apart), scale = vfloat(1.0f) / max(distance, 1e-30f);
        vfloat cosine = 0.0f;
        for (int c = 0; c < 3; ++c) {
            const vfloat direction = step[c] * scale;
            store_lanes(to.direction[c], size_t(first), direction);
            cosine += -normal[c] * direction;
        }
        const vfloat per_area = share / max(sum * gather_emitters(e.area, chosen), 1e-30f);
        const vfloat density = per_area * distance * distance / max(abs(cosine), 1e-30f);
        std::memcpy(to.chosen + first, &chosen.v, sizeof chosen.v);
        store_lanes(to.u, size_t(first), weight1);
        store_lanes(to.v, size_t(first), weight2);
        store_lanes(to.distance, size_t(first), distance);
        store_lanes(to.cosine, size_t(first), cosine);
        store_lanes(to.density, size_t(first),
                    select(abs(cosine) > 1e-6f && sum > 0.0f, density, vfloat(0.0f)));
    }
}

/// The chance that triangle `chosen` is chosen for each place, per area.
inline void chances_of_emitters(const FewEmitters& e, const float* const (&places)[3], const int32_t* chosen,
                                int count, float* chances) {
    for (int first = 0; first < count; first += lanes) {
        vfloat from[3], own = 0.0f, sum = 0.0f;
        for (int c = 0; c < 3; ++c) from[c] = load<Floats>(places[c] + first);
        const vint which = load<Ints>(chosen + first);
        for (int k = 0; k < e.count; ++k) {
            const vfloat share = emitter_share(e, k, from);
            own = select(which == k, share, own);
            sum += share;
        }
        const vfloat per_area = own / max(sum * gather_emitters(e.area, which), 1e-30f);
        store_lanes(chances, size_t(first), select(sum > 0.0f, per_area, vfloat(0.0f)));
    }
}

}  // namespace easypbr::native::EASYPBR_ISA
