// Math aliases. World space is right-handed, +Y up by default; cameras look along their -Z.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <type_traits>

#include "easypbr/core/error.h"

// How matrices and vectors of fixed size are aligned, and so the layout of all that has them, would depend on
// the compiler's flags: -mavx, -march, EIGEN_DONT_VECTORIZE. The CMake target and easypbr.pc define it.
#if EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error "EasyPBR: compile all of the program with -DEIGEN_MAX_STATIC_ALIGN_BYTES=16, as the library is"
#endif

// Mat3, Mat4 and poses of the library are by columns; arrays name their order. Another default would
// transpose those that cross over.
#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
#error "EasyPBR: compile without EIGEN_DEFAULT_TO_ROW_MAJOR; types may name Eigen::RowMajor"
#endif

// Arrays hold their sizes in it.
static_assert(std::is_same_v<Eigen::Index, std::ptrdiff_t>,
              "EasyPBR: compile without EIGEN_DEFAULT_DENSE_INDEX_TYPE, as the library is");

namespace easypbr {

using Vec2 = Eigen::Vector2f;
using Vec3 = Eigen::Vector3f;
using Vec4 = Eigen::Vector4f;
using Vec2d = Eigen::Vector2d;
using Vec2i = Eigen::Vector2i;
using Vec3d = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3f;
using Mat4 = Eigen::Matrix4f;
using Mat3d = Eigen::Matrix3d;
using Mat4d = Eigen::Matrix4d;
using Box3 = Eigen::AlignedBox3f;
using Box3d = Eigen::AlignedBox3d;

inline constexpr double pi = 3.14159265358979323846;

constexpr double radians(double degrees) {
    return degrees * (pi / 180.0);
}
constexpr double degrees(double radians) {
    return radians * (180.0 / pi);
}

}  // namespace easypbr
