// Values of animation channels between their keys.
#include <algorithm>

#include "easypbr/scene/animation.h"

namespace easypbr {
namespace {

Eigen::VectorXd key_row(const AnimationChannel& channel, Eigen::Index i) {
    return channel.values.row(i).transpose().cast<double>();
}

Eigen::Quaterniond quaternion_of_row(const Eigen::VectorXd& xyzw) {
    return Eigen::Quaterniond(Eigen::Vector4d(xyzw));
}

/// Between keys i and i + 1, at `part` of the `length` seconds between them.
Eigen::VectorXd between_keys(const AnimationChannel& channel, Eigen::Index i, double part, double length) {
    if (channel.interpolation == Interpolation::step) return key_row(channel, i);
    if (channel.interpolation == Interpolation::linear) {
        const Eigen::VectorXd from = key_row(channel, i), to = key_row(channel, i + 1);
        if (channel.property != AnimatedProperty::rotation) return (1 - part) * from + part * to;
        return quaternion_of_row(from).normalized().slerp(part, quaternion_of_row(to).normalized()).coeffs();
    }
    // Each key: in-tangent, value, out-tangent.
    const double t = part, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * key_row(channel, 3 * i + 1) +
           length * (t3 - 2 * t2 + t) * key_row(channel, 3 * i + 2) +
           (3 * t2 - 2 * t3) * key_row(channel, 3 * i + 4) + length * (t3 - t2) * key_row(channel, 3 * i + 3);
}

Eigen::VectorXd sample_raw(const AnimationChannel& channel, double time_s) {
    const auto& times = channel.times;
    const bool cubic = channel.interpolation == Interpolation::cubic_spline;
    const auto value = [&](Eigen::Index i) { return key_row(channel, cubic ? 3 * i + 1 : i); };
    if (time_s <= double(times.front())) return value(0);
    if (time_s >= double(times.back())) return value(Eigen::Index(times.size()) - 1);
    const auto after = std::upper_bound(times.begin(), times.end(), time_s,
                                        [](double time, float key) { return time < double(key); });
    const auto i = size_t(after - times.begin()) - 1;
    const double length = double(times[i + 1]) - double(times[i]);
    return between_keys(channel, Eigen::Index(i), (time_s - double(times[i])) / length, length);
}

}  // namespace

Array1d sample(const AnimationChannel& channel, double time_s) {
    Eigen::VectorXd value = sample_raw(channel, time_s);
    if (channel.property != AnimatedProperty::rotation) return value;
    const double length = value.norm();
    return length > 0 ? Eigen::VectorXd(value / length) : Eigen::VectorXd(Eigen::Vector4d(0, 0, 0, 1));
}

}  // namespace easypbr
