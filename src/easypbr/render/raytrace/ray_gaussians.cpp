#include "easypbr/render/raytrace/ray_gaussians.h"

#include <algorithm>
#include <cmath>

namespace easypbr::render {

void RayGaussians::set(size_t i, const RayGaussian& gaussian, const Eigen::Affine3d& T) {
    Gaussian& to = gaussians_[i];
    to.mean = (T * gaussian.mean).cast<float>();
    to.whiten = Mat3d((T.linear() * gaussian.axes).inverse()).cast<float>();
    to.opacity = to.whiten.allFinite() ? gaussian.opacity : 0;
}

RayGaussians::Meeting RayGaussians::meet(size_t i, const Vec3& from, const Vec3& direction) const {
    const Gaussian& g = gaussians_[i];
    const Vec3 o = g.whiten * (from - g.mean), d = g.whiten * direction;
    const float distance = -o.dot(d) / d.squaredNorm();
    // Across, not by a difference of large numbers.
    const float power = 0.5f * o.cross(d).squaredNorm() / d.squaredNorm();
    const float opacity = std::min(g.opacity * std::exp(-power), most_opacity);
    return {distance, opacity >= least_opacity ? opacity : 0};
}

Eigen::AlignedBox3f RayGaussians::bounds(size_t i) const {
    const Gaussian& g = gaussians_[i];
    if (!(g.opacity > least_opacity)) return {};
    const float deviations = std::sqrt(2 * std::log(g.opacity / least_opacity));
    const Vec3 reach = deviations * 1.0001f * g.whiten.inverse().rowwise().norm();
    return {g.mean - reach, g.mean + reach};
}

}  // namespace easypbr::render
