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

PointBatches::PointBatches(const Array3f& V) : point_count_(size_t(V.rows())) {
    const std::vector<uint32_t> order = curve_order(V, point_count_, [](size_t i) { return i; });
    blocks_.resize((point_count_ + most - 1) / most);
    spheres_.resize(blocks_.size());
    parallel_for(blocks_.size(), 64, [&](size_t batch) {
        const int own = size_of(batch);
        Block& to = blocks_[batch];
        std::copy_n(&order[most * batch], own, to.ids);
        for (int i = 0; i < own; ++i)
            for (int k = 0; k < 3; ++k) to.points[k * own + i] = V(to.ids[i], k);
        spheres_[batch] = sphere_around(to.points, own);
    });
}

int PointBatches::size_of(size_t batch) const {
    return int(std::min(most, point_count_ - most * batch));
}

}  // namespace easypbr::render
