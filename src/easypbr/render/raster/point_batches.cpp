#include "easypbr/render/raster/point_batches.h"

#include <algorithm>
#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/render/raster/curve_order.h"

namespace easypbr::render {

PointBatches::Sphere sphere_around(const float* points, int count) {
    Box3 box;
    for (int i = 0; i < count; ++i) {
        const Vec3 p(points[i], points[count + i], points[2 * count + i]);
        if (!p.allFinite()) return {Vec3::Zero(), std::numeric_limits<float>::infinity()};
        box.extend(p);
    }
    return {box.center(), box.diagonal().norm() / 2};
}

PointBatches::PointBatches(const Array3f& V)
    : ids_(curve_order(V, size_t(V.rows()), [](size_t i) { return i; })) {
    const auto all = size_t(V.rows());
    points_.resize(3 * all + most);
    spheres_.resize((all + most - 1) / most);
    parallel_for(spheres_.size(), 64, [&](size_t batch) {
        const int own = size_of(batch);
        float* const to = &points_[3 * most * batch];
        for (int i = 0; i < own; ++i)
            for (int k = 0; k < 3; ++k) to[k * own + i] = V(ids_[most * batch + size_t(i)], k);
        spheres_[batch] = sphere_around(to, own);
    });
}

int PointBatches::size_of(size_t batch) const {
    return int(std::min(most, ids_.size() - most * batch));
}

}  // namespace easypbr::render
