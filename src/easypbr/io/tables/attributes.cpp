#include "easypbr/io/tables/attributes.h"

#include <algorithm>
#include <cmath>

#include "easypbr/core/parallel.h"

namespace easypbr::io {
namespace {

constexpr size_t attribute_grain = 1 << 16;

}  // namespace

void tidy_normals(Array3f::Dense& N) {
    parallel_for(size_t(N.rows()), attribute_grain, [&](size_t i) {
        auto normal = N.row(Eigen::Index(i));
        const float squared = normal.squaredNorm();
        if (std::abs(squared - 1) < 2e-3f) return;
        const Vec3d direction = normal.cast<double>().transpose();
        const double length = direction.norm();
        if (std::isfinite(length) && length > 0) {
            normal = (direction / length).cast<float>().transpose();
        } else {
            normal << 0, 0, 1;
        }
    });
}

void tidy_colors(ArrayXf::Dense& C) {
    parallel_for(size_t(C.size()), attribute_grain, [&](size_t i) {
        float& value = C.data()[i];
        value = value > 0 ? std::min(value, 1.0f) : 0.0f;
    });
}

void tidy_uv(Array2f::Dense& UV) {
    parallel_for(size_t(UV.size()), attribute_grain, [&](size_t i) {
        if (!std::isfinite(UV.data()[i])) UV.data()[i] = 0;
    });
}

}  // namespace easypbr::io
