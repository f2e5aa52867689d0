// Principal axes of symmetric 2 x 2 matrices.
#pragma once

#include <Eigen/Jacobi>

#include "easypbr/core/math.h"

namespace easypbr::detail {

/// Eigenvalues, the smaller one first, and their eigenvectors as columns.
struct PrincipalAxes {
    Vec2d values;
    Eigen::Matrix2d directions;
};

/// Of a symmetric matrix: one Jacobi rotation is all that 2 x 2 takes (Golub and Van Loan, Matrix
/// Computations, 8.5.2). Eigen's general solver costs each source that uses it ten seconds of compiling.
inline PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric) {
    const double a = symmetric(0, 0), b = symmetric(1, 0), d = symmetric(1, 1);
    Eigen::JacobiRotation<double> rotation;
    rotation.makeJacobi(a, b, d);
    const double c = rotation.c(), s = rotation.s(), change = rotation.s() / rotation.c() * b;
    PrincipalAxes axes{{a - change, d + change}, (Eigen::Matrix2d() << c, s, -s, c).finished()};
    if (axes.values[0] > axes.values[1]) {
        std::swap(axes.values[0], axes.values[1]);
        axes.directions.col(0).swap(axes.directions.col(1));
    }
    return axes;
}

}  // namespace easypbr::detail
