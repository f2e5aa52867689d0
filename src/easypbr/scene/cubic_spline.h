// A cubic spline through given points: position, velocity and acceleration are continuous (C2).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace easypbr {

/// What holds at the ends of a spline.
enum class SplineEnds {
    natural,      ///< no acceleration at both ends
    periodic,     ///< after the last point comes the first again, and so on around
    antiperiodic  ///< after the last point comes the first with the opposite sign: quaternions after one turn
};

class CubicSpline {
  public:
    using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    CubicSpline() = default;
    /// Through the rows of `points` at rising `times`: one time for each point, and one more, the end, unless
    /// the ends are natural. At least two points.
    CubicSpline(std::vector<double> times, Points points, SplineEnds ends);

    /// The point at a time within [first time, last time]. At a given time it is the given point to the bit.
    Eigen::VectorXd at(double time) const;

  private:
    std::vector<double> times_;
    Points points_;         ///< one row for each time
    Points accelerations_;  ///< second derivatives at the times
};

}  // namespace easypbr
