// Array: an immutable, reference-counted matrix that Eigen, libigl and numpy see without a copy.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "easypbr/core/error.h"
#include "easypbr/core/math.h"

namespace easypbr {

uint64_t next_revision();

namespace detail {
/// Throws ArgumentError unless a matrix has these columns. Eigen itself checks it in debug builds alone.
inline void require_columns(Eigen::Index rows, Eigen::Index cols, int expected) {
    if (cols != expected)
        throw ArgumentError("array: expected n x " + std::to_string(expected) + ", got " +
                            std::to_string(rows) + " x " + std::to_string(cols));
}

/// A number as int32. Throws ArgumentError for one that int32 does not hold.
inline int32_t int32_of(double value) {
    if (value >= -2147483648.0 && value <= 2147483647.0 && double(int32_t(value)) == value)
        return int32_t(value);
    char text[32];
    std::snprintf(text, sizeof text, "%.15g", value);
    throw ArgumentError(
        std::string("array: expected whole numbers from -2147483648 to 2147483647, got ").append(text));
}

/// How Eigen allocates in a program that is compiled with these flags: 0 by malloc(), else with this
/// alignment.
inline constexpr int allocation = EIGEN_MALLOC_ALREADY_ALIGNED ? 0 : EIGEN_DEFAULT_ALIGN_BYTES;

/// Keeps a matrix. Library and program each make and free their own: those of other flags are other types, so
/// that the linker does not take the functions of one for those of the other.
template <class Dense, int>
struct Kept {
    explicit Kept(Dense given) : values(std::move(given)) {}
    Dense values;
};
}  // namespace detail

/// Row-major matrix with a fixed or dynamic number of columns. Copies share the data; the data never change.
/// It is an Eigen::Map, so it goes wherever an Eigen::MatrixBase goes. Every new array has a new revision.
template <class Scalar, int Cols>
class Array
    : public Eigen::Map<
          const Eigen::Matrix<Scalar, Eigen::Dynamic, Cols, Cols == 1 ? Eigen::ColMajor : Eigen::RowMajor>> {
  public:
    using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Cols, Cols == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
    using Map = Eigen::Map<const Dense>;

    /// No rows; revision 0.
    Array() : Map(nullptr, 0, Cols == Eigen::Dynamic ? 0 : Cols) {}

    /// Takes the matrix over without a copy when it is moved in.
    Array(Dense values) : Array(std::make_shared<const Kept>(std::move(values))) {}

    /// A copy of any Eigen expression of fitting shape: n x Cols, or n x 1 or 1 x n for one column. Without
    /// rows any number of columns fits. Throws ArgumentError for other shapes, and where an array of int32 is
    /// given numbers that int32 does not hold: NaN, fractions, and those out of its range.
    template <class Derived>
    requires(!std::is_base_of_v<Map, Derived> && !std::is_same_v<Dense, Derived>)
        Array(const Eigen::DenseBase<Derived>& values)
        : Array(dense_of(values.derived())) {}

    /// A view of memory that `owner` keeps alive and unchanged.
    Array(std::shared_ptr<const void> owner, const Scalar* data, Eigen::Index rows, Eigen::Index cols)
        : Map(data, rows, cols), owner_(std::move(owner)), revision_(next_revision()) {}

    Array(const Array& other)
        : Map(other.data(), other.rows(), other.cols()), owner_(other.owner_), revision_(other.revision_) {}

    Array& operator=(const Array& other) {
        if (this == &other) return *this;
        owner_ = other.owner_;
        revision_ = other.revision_;
        // Eigen's documented way to let a Map point elsewhere.
        new (static_cast<Map*>(this)) Map(other.data(), other.rows(), other.cols());
        return *this;
    }

    bool empty() const { return this->rows() == 0; }
    const std::shared_ptr<const void>& owner() const { return owner_; }
    uint64_t revision() const { return revision_; }

  private:
    using Kept = detail::Kept<Dense, detail::allocation>;

    template <class Derived>
    static Dense dense_of(const Derived& values) {
        // What Eigen knows when it compiles, it checks then.
        if constexpr (Cols == Eigen::Dynamic || Derived::ColsAtCompileTime != Eigen::Dynamic) {
            return Dense(converted(values));
        } else {
            if (values.rows() == 0) return Dense(0, Cols);
            if constexpr (Cols == 1)
                if (values.rows() == 1) return Dense(converted(values.row(0).transpose()));
            detail::require_columns(values.rows(), values.cols(), Cols);
            return Dense(converted(values));
        }
    }

    /// The expression with numbers of this array's type.
    template <class Derived>
    static auto converted(const Derived& values) {
        using Given = typename Derived::Scalar;
        using Limits = std::numeric_limits<Given>;
        if constexpr (std::is_same_v<Scalar, int32_t> && !(Limits::is_integer && Limits::digits <= 31))
            return values.unaryExpr([](const Given& value) { return detail::int32_of(double(value)); });
        else
            return values.template cast<Scalar>();
    }

    explicit Array(std::shared_ptr<const Kept> kept)
        : Map(kept->values.data(), kept->values.rows(), kept->values.cols()), revision_(next_revision()) {
        owner_ = std::move(kept);
    }

    std::shared_ptr<const void> owner_;
    uint64_t revision_ = 0;
};

using Array1f = Array<float, 1>;
using Array2f = Array<float, 2>;
using Array3f = Array<float, 3>;
using Array4f = Array<float, 4>;
using ArrayXf = Array<float, Eigen::Dynamic>;
using Array1d = Array<double, 1>;
using Array3d = Array<double, 3>;
using Array1i = Array<int32_t, 1>;
using Array2i = Array<int32_t, 2>;
using Array3i = Array<int32_t, 3>;

}  // namespace easypbr
