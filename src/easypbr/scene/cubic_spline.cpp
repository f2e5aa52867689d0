#include "easypbr/scene/cubic_spline.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace easypbr {
namespace {

using Points = CubicSpline::Points;

/// The equations of the second derivatives: velocity must be continuous at each inner point. Unknowns are
/// those of the points in `rows`; rows + `sign` times the first ones come after them when the ends wrap.
class Continuity {
  public:
    Continuity(Eigen::Index unknowns, Eigen::Index columns)
        : matrix_(unknowns, unknowns), right_(Points::Zero(unknowns, columns)) {}

    void add(Eigen::Index row, Eigen::Index column, double value) {
        entries_.emplace_back(int(row), int(column), value);
    }
    auto right(Eigen::Index row) { return right_.row(row); }

    /// The matrix is symmetric and diagonally dominant, so there is always a solution.
    Points solve() {
        matrix_.setFromTriplets(entries_.begin(), entries_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix_);
        return solver.solve(Eigen::MatrixXd(right_));
    }

  private:
    Eigen::SparseMatrix<double> matrix_;
    std::vector<Eigen::Triplet<double>> entries_;
    Points right_;
};

Points natural_accelerations(const std::vector<double>& times, const Points& points) {
    Points out = Points::Zero(points.rows(), points.cols());
    const Eigen::Index inner = points.rows() - 2;
    if (inner < 1) return out;
    Continuity equations(inner, points.cols());
    for (Eigen::Index i = 0; i < inner; ++i) {
        const double before = times[size_t(i) + 1] - times[size_t(i)],
                     after = times[size_t(i) + 2] - times[size_t(i) + 1];
        equations.add(i, i, 2 * (before + after));
        if (i > 0) equations.add(i, i - 1, before);
        if (i + 1 < inner) equations.add(i, i + 1, after);
        equations.right(i) = 6 * ((points.row(i + 2) - points.row(i + 1)) / after -
                                  (points.row(i + 1) - points.row(i)) / before);
    }
    out.middleRows(1, inner) = equations.solve();
    return out;
}

/// `points` has the first point, times `sign`, as its last row.
Points periodic_accelerations(const std::vector<double>& times, const Points& points, double sign) {
    const Eigen::Index count = points.rows() - 1;
    Continuity equations(count, points.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
        const Eigen::Index last = i > 0 ? i - 1 : count - 1, next = i + 1 < count ? i + 1 : 0;
        const double before = times[size_t(last) + 1] - times[size_t(last)],
                     after = times[size_t(i) + 1] - times[size_t(i)];
        equations.add(i, i, 2 * (before + after));
        equations.add(i, last, (i > 0 ? 1 : sign) * before);
        equations.add(i, next, (i + 1 < count ? 1 : sign) * after);
        const Eigen::RowVectorXd arriving = i > 0
                                                ? Eigen::RowVectorXd(points.row(i) - points.row(last))
                                                : Eigen::RowVectorXd(points.row(0) - sign * points.row(last));
        equations.right(i) = 6 * ((points.row(i + 1) - points.row(i)) / after - arriving / before);
    }
    Points out(points.rows(), points.cols());
    out.topRows(count) = equations.solve();
    out.row(count) = sign * out.row(0);
    return out;
}

}  // namespace

CubicSpline::CubicSpline(std::vector<double> times, Points points, SplineEnds ends)
    : times_(std::move(times)), points_(std::move(points)) {
    if (ends == SplineEnds::natural) {
        accelerations_ = natural_accelerations(times_, points_);
        return;
    }
    const double sign = ends == SplineEnds::periodic ? 1 : -1;
    points_.conservativeResize(points_.rows() + 1, Eigen::NoChange);
    points_.row(points_.rows() - 1) = sign * points_.row(0);
    accelerations_ = periodic_accelerations(times_, points_, sign);
}

Eigen::VectorXd CubicSpline::at(double time) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const Eigen::Index i = after - times_.begin() - 1;
    const double h = times_[size_t(i) + 1] - times_[size_t(i)];
    const double b = (time - times_[size_t(i)]) / h, a = 1 - b;
    return (a * points_.row(i) + b * points_.row(i + 1) +
            ((a * a * a - a) * accelerations_.row(i) + (b * b * b - b) * accelerations_.row(i + 1)) *
                (h * h / 6))
        .transpose();
}

}  // namespace easypbr
