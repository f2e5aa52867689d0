// Functions with libigl's signatures (2.5: inputs are Eigen::MatrixBase of a type of their own, outputs are
// resized) take a mesh's arrays as they are, without a copy.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "easypbr/geometry/primitives.h"
#include "easypbr/geometry/repair.h"
#include "geometry/measure.h"

namespace easypbr::libigl_test {
namespace {

/// As igl::doublearea.
template <typename DerivedV, typename DerivedF, typename DeriveddblA>
void doublearea(const Eigen::MatrixBase<DerivedV>& V, const Eigen::MatrixBase<DerivedF>& F,
                Eigen::PlainObjectBase<DeriveddblA>& dblA) {
    using Row = Eigen::Matrix<typename DerivedV::Scalar, 1, 3>;
    dblA.resize(F.rows(), 1);
    for (Eigen::Index f = 0; f < F.rows(); ++f) {
        const Row ab = V.row(F(f, 1)) - V.row(F(f, 0)), ac = V.row(F(f, 2)) - V.row(F(f, 0));
        dblA(f) = typename DeriveddblA::Scalar(ab.cross(ac).norm());
    }
}

/// As igl::gaussian_curvature: what the angles at a vertex lack to a full turn.
template <typename DerivedV, typename DerivedF, typename DerivedK>
void gaussian_curvature(const Eigen::MatrixBase<DerivedV>& V, const Eigen::MatrixBase<DerivedF>& F,
                        Eigen::PlainObjectBase<DerivedK>& K) {
    using Row = Eigen::Matrix<double, 1, 3>;
    K.setConstant(V.rows(), 1, 2 * easypbr::pi);
    for (Eigen::Index f = 0; f < F.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Row a = V.row(F(f, k)).template cast<double>(),
                      b = V.row(F(f, (k + 1) % 3)).template cast<double>(),
                      c = V.row(F(f, (k + 2) % 3)).template cast<double>();
            K(F(f, k)) -= std::acos((b - a).normalized().dot((c - a).normalized()));
        }
}

/// As igl::adjacency_list, which takes the faces alone and asks Eigen for their largest.
template <typename DerivedF, typename Index>
void adjacency_list(const Eigen::MatrixBase<DerivedF>& F, std::vector<std::vector<Index>>& A) {
    A.assign(size_t(F.maxCoeff()) + 1, {});
    for (Eigen::Index f = 0; f < F.rows(); ++f)
        for (Eigen::Index k = 0; k < F.cols(); ++k) A[size_t(F(f, k))].push_back(F(f, (k + 1) % F.cols()));
}

/// As igl::centroid and others that want the plain type of their input.
template <typename DerivedV>
typename DerivedV::PlainObject centered_rows(const Eigen::MatrixBase<DerivedV>& V) {
    typename DerivedV::PlainObject result = V.derived();
    return result.rowwise() - V.colwise().mean();
}

TEST(LibiglSignatures, TakeTheArraysOfAMesh) {
    const easypbr::Mesh mesh = easypbr::make_box({1, 2, 3});
    Eigen::VectorXd areas;
    doublearea(mesh.V(), mesh.F(), areas);
    EXPECT_NEAR(areas.sum() / 2, 22, 1e-9);
    EXPECT_NEAR(centered_rows(mesh.V()).norm(), mesh.V().norm(), 1e-6f);
}

TEST(LibiglSignatures, CurvatureOfABallIsAFullOne) {
    const easypbr::Mesh ball = easypbr::make_icosphere(2, 3);
    Eigen::VectorXd K;
    gaussian_curvature(ball.V(), ball.F(), K);
    // Gauss and Bonnet: 2 pi times the Euler characteristic 2.
    EXPECT_NEAR(K.sum(), 4 * easypbr::pi, 1e-6);
    std::vector<std::vector<int>> neighbors;
    adjacency_list(ball.F(), neighbors);
    EXPECT_EQ(neighbors.size(), size_t(ball.V().rows()));
}

TEST(LibiglSignatures, PlainMatricesAreOneAssignmentAway) {
    // Functions that want Eigen::MatrixXd and MatrixXi themselves.
    const easypbr::Mesh mesh = easypbr::make_box();
    const Eigen::MatrixXd V = mesh.V().cast<double>();
    const Eigen::MatrixXi F = mesh.F();
    const easypbr::Mesh back{easypbr::Array3f(V), easypbr::Array3i(F)};
    EXPECT_EQ(back.V(), mesh.V());
    EXPECT_EQ(back.F(), mesh.F());
}

}  // namespace

}  // namespace easypbr::libigl_test
