// The setup of a batch of ellipses in space: where they are on the screen, and which of them are seen.
#pragma once

#include "easypbr/native/ellipse_projection.h"
#include "easypbr/native/simd/cluster_setup.h"

namespace easypbr::native::EASYPBR_ISA {

inline int set_up_ellipses(const EllipseBatch& batch, EllipseScreen& screen) {
    int count = 0;
    for (int first = 0; first < batch.count; first += lanes) {
        EllipseVectors<vfloat> vectors;
        vfloat* const of_place[4] = {vectors.p, vectors.t, vectors.b, vectors.n};
        for (int i = 0; i < EllipseBatch::components; ++i)
            of_place[i / 3][i % 3] = load<Floats>(batch.vectors + i * batch.count + first);
        ProjectedEllipse<vfloat> ellipse;
        const vbool seen = project_ellipse(*batch.view, vectors, ellipse);
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
