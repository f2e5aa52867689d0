#include "easypbr/scene/splat_transform.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr {
namespace {

constexpr size_t splat_grain = 1 << 12;
constexpr int most_harmonics = 16;

/// The nearest orthogonal matrix (polar decomposition). Of one that flattens space, any.
Mat3d nearest_rotation(const Mat3d& M) {
    const Eigen::JacobiSVD<Mat3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
}

/// Maps the coefficients of a colour to those of the turned colour: basis(d)^T H c = basis(R^T d)^T c for all
/// directions d. As harmonics of a degree turn into such of the same degree, as many equations as there are
/// harmonics say so exactly; more of them make the solution stable.
Eigen::MatrixXd turned_harmonics(const Mat3d& R, int degree) {
    const int count = (degree + 1) * (degree + 1), directions = 4 * most_harmonics;
    Eigen::MatrixXd before(directions, count), after(directions, count);
    for (int i = 0; i < directions; ++i) {
        // A spiral from pole to pole (Vogel 1979).
        const double z = 1 - (2 * i + 1.0) / directions, angle = i * pi * (3 - std::sqrt(5.0)),
                     r = std::sqrt(1 - z * z);
        const Vec3d d(r * std::cos(angle), r * std::sin(angle), z);
        float basis[most_harmonics];
        spherical_harmonics(Vec3((R.transpose() * d).cast<float>()), degree, basis);
        for (int k = 0; k < count; ++k) before(i, k) = double(basis[k]);
        spherical_harmonics(Vec3(d.cast<float>()), degree, basis);
        for (int k = 0; k < count; ++k) after(i, k) = double(basis[k]);
    }
    return after.colPivHouseholderQr().solve(before);
}

/// Principal axes of a Gaussian and the standard deviations along them.
struct Shape {
    Eigen::Quaterniond axes;
    Vec3d scales;
};

Shape shape_of(const Mat3d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Mat3d> solver(covariance);
    Mat3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1;
    return {Eigen::Quaterniond(axes), solver.eigenvalues().cwiseMax(0.0).cwiseSqrt()};
}

ArrayXf turned_sh(const SplatArrays& splats, const Mat3d& R) {
    const int degree = splats.degree(), count = (degree + 1) * (degree + 1);
    if (degree == 0) return splats.sh;
    const Eigen::MatrixXf H = turned_harmonics(R, degree).cast<float>();
    using Colors = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor, most_harmonics, 3>;
    ArrayXf::Dense sh(splats.sh.rows(), splats.sh.cols());
    parallel_for(size_t(sh.rows()), splat_grain, [&](size_t i) {
        const float* const from = splats.sh.data() + Eigen::Index(i) * sh.cols();
        float* const to = sh.data() + Eigen::Index(i) * sh.cols();
        const Colors colors = Eigen::Map<const Colors>(from, count, 3);
        Eigen::Map<Colors>(to, count, 3) = H * colors;
    });
    return ArrayXf(std::move(sh));
}

}  // namespace

SplatArrays transformed_splats(const SplatArrays& splats, const Mat3d& M) {
    const Mat3d R = nearest_rotation(M);
    // A similarity keeps the axes; mirroring maps a Gaussian's axes to themselves but for their signs.
    const double factor = std::cbrt(std::abs(M.determinant()));
    const bool is_similarity = (M - factor * R).norm() <= 1e-9 * M.norm();
    const Eigen::Quaterniond turn(Mat3d(R.determinant() < 0 ? Mat3d(-R) : R));
    Array3f::Dense scales(splats.scales.rows(), 3);
    Array4f::Dense rotations(splats.rotations.rows(), 4);
    parallel_for(size_t(scales.rows()), splat_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        const auto q = splats.rotations.row(i).cast<double>();
        const Eigen::Quaterniond own = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized();
        const Vec3d lengths = splats.scales.row(i).transpose().cast<double>();
        Shape shape{turn * own, factor * lengths};
        if (!is_similarity) {
            const Mat3d axes = M * own.toRotationMatrix() * lengths.asDiagonal();
            shape = shape_of(axes * axes.transpose());
        }
        scales.row(i) = shape.scales.transpose().cast<float>();
        rotations.row(i) << float(shape.axes.w()), float(shape.axes.x()), float(shape.axes.y()),
            float(shape.axes.z());
    });
    return {std::move(scales), std::move(rotations), splats.opacities, turned_sh(splats, R)};
}

}  // namespace easypbr
