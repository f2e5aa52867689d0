#include "easypbr/scene/array.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/mesh.h"
#include "refusal.h"

namespace easypbr::array_test {
namespace {

/// Rows of 0, 1, 2, ...
Eigen::MatrixXd counted(int rows, int cols) {
    return Eigen::VectorXd::LinSpaced(rows * cols, 0, rows * cols - 1).reshaped<Eigen::RowMajor>(rows, cols);
}

TEST(Array, TakesDynamicMatricesOfItsShape) {
    const Eigen::MatrixXd given = counted(4, 3);
    const Array3f array = given;
    ASSERT_EQ(array.rows(), 4);
    for (int i = 0; i < 12; ++i) EXPECT_EQ(array(i / 3, i % 3), float(i));
    const Array3i of_expression = given.topRows(2) * 10;
    EXPECT_EQ(of_expression.rows(), 2);
    EXPECT_EQ(of_expression(1, 2), 50);
    EXPECT_EQ(Array3f(given.array() + 1)(0, 0), 1) << "coefficient-wise expressions too";
    EXPECT_EQ(Array2i(given.leftCols(2))(3, 1), 10);
    EXPECT_EQ(ArrayXf(counted(2, 5)).cols(), 5);
}

TEST(Array, RefusesOtherNumbersOfColumns) {
    EXPECT_EQ(refusal([] { Array3f(counted(40'000, 2)); }), "array: expected n x 3, got 40000 x 2");
    EXPECT_EQ(refusal([] { Array3f(counted(3, 400)); }), "array: expected n x 3, got 3 x 400");
    EXPECT_EQ(refusal([] { Array3f(Eigen::MatrixXf(5, 0)); }), "array: expected n x 3, got 5 x 0");
    EXPECT_EQ(refusal([] { Array2f(counted(4, 3).array() * 2); }), "array: expected n x 2, got 4 x 3");
    EXPECT_EQ(refusal([] { Array1f(counted(4, 3)); }), "array: expected n x 1, got 4 x 3");
    EXPECT_EQ(refusal([] { Array3f(ArrayXf(counted(4, 2))); }), "array: expected n x 3, got 4 x 2");
}

TEST(Array, WithoutRowsAnyNumberOfColumnsFits) {
    EXPECT_TRUE(Array3f(Eigen::MatrixXd()).empty());
    EXPECT_EQ(Array3f(Eigen::MatrixXd()).cols(), 3);
    EXPECT_TRUE(Array1i(Eigen::MatrixXi(0, 4)).empty());
}

TEST(Array, OfOneColumnTakesVectorsOfBothKinds) {
    const Eigen::VectorXd column = Eigen::VectorXd::LinSpaced(5, 0, 4);
    const Eigen::RowVectorXd row = column.transpose();
    for (const Array1f& array : {Array1f(column), Array1f(row), Array1f(Eigen::MatrixXd(column)),
                                 Array1f(Eigen::MatrixXd(row)), Array1f(row.array() * 1)}) {
        ASSERT_EQ(array.rows(), 5);
        for (int i = 0; i < 5; ++i) EXPECT_EQ(array[i], float(i));
    }
    EXPECT_EQ(Array1i(Eigen::Vector3i(7, 8, 9))[2], 9);
    EXPECT_TRUE(Array1f(Eigen::RowVectorXd()).empty());
}

TEST(Array, OfIntegersRefusesWhatInt32DoesNotHold) {
    const std::string expected = "array: expected whole numbers from -2147483648 to 2147483647, got ";
    using Wide = Eigen::Matrix<int64_t, Eigen::Dynamic, Eigen::Dynamic>;
    EXPECT_EQ(refusal([] { Array3i(Wide{{4294967296, 1, 2}}); }), expected + "4294967296");
    EXPECT_EQ(refusal([] { Array1i(Wide{{1, -2147483649, 2}}); }), expected + "-2147483649") << "of a row";
    EXPECT_EQ(refusal([] { Array2i(Eigen::Matrix<uint32_t, 1, 2>(0, 2147483648u)); }),
              expected + "2147483648");
    EXPECT_EQ(refusal([] { Array2i(Eigen::MatrixXd{{0.5, 1}}); }), expected + "0.5");
    EXPECT_EQ(refusal([] { Array1i(Eigen::VectorXf::Constant(3, 1e10f)); }), expected + "10000000000");
    EXPECT_EQ(
        refusal([] { Array1i(Eigen::VectorXd::Constant(3, std::numeric_limits<double>::quiet_NaN())); }),
        expected + "nan");
    const Array2i ends = Wide{{-2147483648LL, 2147483647}};
    EXPECT_EQ(ends(0, 0), std::numeric_limits<int32_t>::min());
    EXPECT_EQ(ends(0, 1), std::numeric_limits<int32_t>::max());
    EXPECT_EQ(Array1i(Eigen::Matrix<uint8_t, 2, 1>(0, 255))[1], 255);
    EXPECT_EQ(Array1i(Eigen::Array<bool, 2, 1>(false, true))[1], 1);
}

TEST(Array, MeshesKeepWhatTheyHadWhenAnArrayIsRefused) {
    Mesh mesh = make_box();
    const Array3f before = mesh.V();
    EXPECT_EQ(refusal([&] { mesh.set_V(counted(3, 400)); }), "array: expected n x 3, got 3 x 400");
    EXPECT_EQ(refusal([&] { mesh.set_UV(counted(3, 24)); }), "array: expected n x 2, got 3 x 24");
    EXPECT_EQ(refusal([&] { mesh.set_positions(counted(24, 2)); }), "array: expected n x 3, got 24 x 2");
    EXPECT_EQ(refusal([&] { mesh.set_positions(counted(24, 2).array() + 1); }),
              "array: expected n x 3, got 24 x 2");
    EXPECT_EQ(mesh.V().data(), before.data());
    mesh.set_positions(counted(24, 3));
    EXPECT_EQ(mesh.V()(23, 2), 71);
}

}  // namespace
}  // namespace easypbr::array_test
