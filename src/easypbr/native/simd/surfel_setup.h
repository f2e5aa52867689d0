// The setup of a batch of surfels: their ellipses on the screen, and which of them are seen.
#pragma once

#include "easypbr/native/simd/cluster_setup.h"
#include "easypbr/native/surfel_ellipse.h"

namespace easypbr::native::EASYPBR_ISA {

inline int set_up_surfels(const SurfelBatch& batch, SurfelScreen& screen) {
    int count = 0;
    for (int first = 0; first < batch.count; first += lanes) {
        SurfelVectors<vfloat> vectors;
        vfloat* const of_place[4] = {vectors.p, vectors.t, vectors.b, vectors.n};
        for (int i = 0; i < SurfelBatch::components; ++i)
            of_place[i / 3][i % 3] = load<Floats>(batch.vectors + i * batch.count + first);
        SurfelEllipse<vfloat> ellipse;
        const vbool seen = project_surfel(*batch.view, vectors, ellipse);
        const auto members = ellipse.all();
        for (size_t i = 0; i < members.size(); ++i)
            std::memcpy(screen.ellipses[i] + first, &members[i]->v, sizeof members[i]->v);
        const unsigned kept = lane_bits(seen && lane_numbers() + first < batch.count);
        for (unsigned waiting = kept; waiting != 0; waiting &= waiting - 1)
            screen.kept[count++] = uint16_t(first + __builtin_ctz(waiting));
    }
    return count;
}

}  // namespace easypbr::native::EASYPBR_ISA
