// Values of animation channels between their keys.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/scene/animation_keys.h"

namespace easypbr {
namespace {

/// Values of a key; 0: any number above 0.
int columns_of(AnimatedProperty property) {
    switch (property) {
        case AnimatedProperty::translation:
        case AnimatedProperty::scale:
            return 3;
        case AnimatedProperty::rotation:
            return 4;
        case AnimatedProperty::visibility:
            return 1;
        default:
            return 0;
    }
}

/// `place` begins the messages.
void require_shape(const AnimationChannel& channel, const char* place) {
    if (channel.times.empty()) throw ArgumentError(fmt::format("{}expected times, got none", place));
    const int of_time = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const auto rows = Eigen::Index(channel.times.size()) * of_time;
    const Eigen::Index columns = columns_of(channel.property);
    const bool fits = columns > 0 ? channel.values.cols() == columns : channel.values.cols() > 0;
    if (channel.values.rows() != rows || !fits)
        throw ArgumentError(fmt::format(
            "{}expected values of {} rows, {} for each of {} times, and {} columns, got {} x {}", place, rows,
            of_time, channel.times.size(), columns > 0 ? fmt::format("{}", columns) : "one or more",
            channel.values.rows(), channel.values.cols()));
}

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
    // So that a key is on either side of it also where times are no numbers.
    if (!(time_s > double(times.front()))) return value(0);
    if (!(time_s < double(times.back()))) return value(Eigen::Index(times.size()) - 1);
    const auto after = std::upper_bound(times.begin(), times.end(), time_s,
                                        [](double time, float key) { return time < double(key); });
    const auto i = size_t(after - times.begin()) - 1;
    const double length = double(times[i + 1]) - double(times[i]);
    return between_keys(channel, Eigen::Index(i), (time_s - double(times[i])) / length, length);
}

}  // namespace

void require_keys(const AnimationChannel& channel) {
    require_shape(channel, "");
    const std::vector<float>& times = channel.times;
    for (size_t i = 0; i < times.size(); ++i)
        if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1])))
            throw ArgumentError(fmt::format("expected finite times that rise, got {} as time {} of {}{}",
                                            times[i], i, times.size(),
                                            i > 0 ? fmt::format(", after {}", times[i - 1]) : ""));
    for (Eigen::Index i = 0; i < channel.values.rows(); ++i)
        if (!channel.values.row(i).allFinite())
            throw ArgumentError(
                fmt::format("expected finite values, got others in row {} of {}", i, channel.values.rows()));
}

Array1d sample(const AnimationChannel& channel, double time_s) {
    require_shape(channel, "animation channel: ");
    if (std::isnan(time_s)) throw ArgumentError("animation: expected a time, got nan");
    Eigen::VectorXd value = sample_raw(channel, time_s);
    if (channel.property != AnimatedProperty::rotation) return value;
    const double length = value.norm();
    return length > 0 ? Eigen::VectorXd(value / length) : Eigen::VectorXd(Eigen::Vector4d(0, 0, 0, 1));
}

}  // namespace easypbr
