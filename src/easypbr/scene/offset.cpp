#include "easypbr/scene/offset.h"

#include <cmath>

#include "easypbr/core/parallel.h"

namespace easypbr {
namespace {

constexpr double far_in_extents = 4;

/// The interval of the middle 90 %; all of it for up to 20 values.
struct Interval {
    double low, high;
};

Interval middle_of(std::vector<double>& values) {
    const size_t last = values.size() - 1, cut = last / 20;
    const auto at = [&](size_t rank) {
        std::nth_element(values.begin(), values.begin() + long(rank), values.end());
        return values[rank];
    };
    return {at(cut), at(last - cut)};
}

/// The value rounded to so many decimals; a negative number rounds to tens, hundreds...
double rounded(double value, int decimals) {
    const double power = std::pow(10.0, std::abs(decimals));
    return decimals < 0 ? std::round(value / power) * power : std::round(value * power) / power;
}

}  // namespace

Vec3d offset_of_samples(std::vector<Vec3d> samples, double near) {
    std::erase_if(samples, [](const Vec3d& p) { return !p.cast<float>().allFinite(); });
    if (samples.empty()) return Vec3d::Zero();
    Vec3d centre;
    double extent = 0, farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (const Vec3d& p : samples) values.push_back(p[axis]);
        const Interval middle = middle_of(values);
        centre[axis] = middle.low + (middle.high - middle.low) / 2;
        extent = std::max(extent, middle.high - middle.low);
        farthest = std::max({farthest, std::abs(middle.low), std::abs(middle.high)});
    }
    if (farthest <= near || farthest <= far_in_extents * extent) return Vec3d::Zero();
    const int decimals = extent > 0 ? -int(std::floor(std::log10(extent / 4))) : 0;
    return centre.unaryExpr([&](double value) { return rounded(value, std::clamp(decimals, -30, 12)); });
}

LocalPositions local_positions(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& positions) {
    constexpr size_t grain = 1 << 15;
    LocalPositions result;
    result.offset = choose_offset(size_t(positions.rows()), [&](size_t i) {
        return Vec3d(positions.row(Eigen::Index(i)).transpose());
    });
    Array3f::Dense V(positions.rows(), 3);
    parallel_for(size_t(positions.rows()), grain, [&](size_t i) {
        const auto row = Eigen::Index(i);
        V.row(row) = (positions.row(row) - result.offset.transpose()).cast<float>();
    });
    result.V = std::move(V);
    return result;
}

}  // namespace easypbr
