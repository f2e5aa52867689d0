// Values between Python and C++: arrays, vectors, colours, images.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <memory>
#include <utility>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"
#include "easypbr/python/bindings.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/offset.h"
#include "easypbr/scene/rounding.h"

namespace easypbr::python {

inline bool is_anything(nb::handle) {
    return true;
}

/// Anything that numpy.asarray takes. Arguments are checked where they are read, with a message that says
/// what was expected.
class ArrayLike : public nb::object {
    NB_OBJECT_DEFAULT(ArrayLike, nb::object, "numpy.typing.ArrayLike", is_anything)
};

/// '#rrggbb', a name, or three numbers.
class ColorLike : public nb::object {
    NB_OBJECT_DEFAULT(ColorLike, nb::object, "str | numpy.typing.ArrayLike", is_anything)
};

/// A path or an array.
class PathOrArray : public nb::object {
    NB_OBJECT_DEFAULT(PathOrArray, nb::object, "str | os.PathLike | numpy.typing.ArrayLike | None",
                      is_anything)
};

using AnyArray = nb::ndarray<nb::ro, nb::device::cpu>;

/// The object as a numpy array of real numbers in this machine's byte order. `what` names it in messages.
/// Throws ArgumentError for what is not numeric, and what the object raises that says something else.
nb::object numeric_object(nb::handle object, const char* what);
AnyArray numeric_array(nb::handle object, const char* what);

/// The object as a numpy array of any type, in which booleans are 0 and 1. Throws ArgumentError.
nb::object flags_as_numbers(nb::handle object, const char* what);

/// "10 x 3 float64".
std::string shape_text(const AnyArray& array);

/// Throws ArgumentError unless the object holds exactly these many finite numbers.
Vec2i to_size(nb::handle object, const char* what);
Vec3d to_vector3(nb::handle object, const char* what);
Mat3d to_matrix3(nb::handle object, const char* what);
Mat4d to_matrix4(nb::handle object, const char* what);
/// A 4 x 4 matrix with the last row (0, 0, 0, 1).
Eigen::Affine3d to_affine(nb::handle object, const char* what);
/// Linear colour; a text is sRGB, numbers are linear.
Vec3 to_linear_color(nb::handle object, const char* what);

/// A new numpy array that owns its numbers.
nb::object matrix_to_numpy(const Eigen::MatrixXd& matrix);
nb::tuple vector_to_tuple(const Vec3& vector);

/// What a mesh array, or another array of that form, holds.
struct ArrayShape {
    const char* name;
    int columns;                      ///< columns it must have
    int more_columns;                 ///< or these
    const char* kind = "mesh array";  ///< said before the name in messages
};

/// The object's numbers, copied once and in parallel. Integer arrays take whole numbers within int32. Throws
/// ArgumentError that names the array, the expected and the given shape.
template <class Scalar, int Cols>
typename Array<Scalar, Cols>::Dense to_array(nb::handle object, const ArrayShape& shape);

/// What float32 makes of the object's numbers, a column of them. Throws as to_array().
RoundingCounts rounding_of(nb::handle object, const ArrayShape& shape);

/// Colours as 0 to 1. uint8 and uint16 span the range of their type; of others the values tell whether they
/// are 0 to 1 or 0 to 255 (scene/color_range.h). Throws ArgumentError for numbers of neither range.
ArrayXf to_colors(nb::handle object, const ArrayShape& shape);

/// The object's numbers as positions. Those of a type with more than float32 holds are recentred where
/// float32 would lose what matters (scene/offset.h); the offset is what was subtracted. Throws as to_array().
LocalPositions to_positions(nb::handle object, const ArrayShape& shape);

/// The object's numbers, of any type, as points whose distances matter: recentred wherever they are far from
/// zero for their extent. Throws as to_array().
LocalPositions to_points(nb::handle object, const ArrayShape& shape);

/// The object's numbers less an offset, subtracted in double precision. Throws as to_array().
Array3f to_local(nb::handle object, const ArrayShape& shape, const Vec3d& offset);

/// The read-only numpy array as one that other libraries take by DLPack too (easypbr.tensors.SharedArray).
nb::object shareable(const nb::object& array);

/// A read-only numpy view that keeps the data alive; one column gives one dimension.
template <class Scalar, int Cols>
nb::object view_of(const Array<Scalar, Cols>& array) {
    static const Scalar nothing{};
    auto* owner = new std::shared_ptr<const void>(array.owner());
    nb::capsule capsule(owner, [](void* p) noexcept { delete static_cast<std::shared_ptr<const void>*>(p); });
    const size_t shape[2] = {size_t(array.rows()), size_t(array.cols())};
    return shareable(nb::cast(nb::ndarray<nb::numpy, const Scalar>(array.empty() ? &nothing : array.data(),
                                                                   Cols == 1 ? 1 : 2, shape, capsule)));
}

/// A numpy array that owns the numbers moved into it: rows x cols, or one dimension of a vector.
template <class Matrix>
nb::object owning_array(Matrix matrix) {
    auto* held = new Matrix(std::move(matrix));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<Matrix*>(p); });
    const size_t shape[2] = {size_t(held->rows()), size_t(held->cols())};
    return nb::cast(nb::ndarray<nb::numpy, typename Matrix::Scalar>(held->data(), 2, shape, owner));
}

template <class Scalar>
nb::object owning_array(std::vector<Scalar> values) {
    auto* held = new std::vector<Scalar>(std::move(values));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<Scalar>*>(p); });
    const size_t shape[1] = {held->size()};
    return nb::cast(nb::ndarray<nb::numpy, Scalar>(held->data(), 1, shape, owner));
}

/// The picture as H x W x channels (H x W for one channel), without a copy.
nb::object to_numpy(Image image);
/// A read-only view of a shared picture.
nb::object to_numpy(std::shared_ptr<const Image> image);
/// A copy of an array of uint8, uint16 or floating-point numbers. Throws ArgumentError.
Image to_image(nb::handle object, const char* what);

/// str, bytes or os.PathLike.
bool is_path(nb::handle object);

}  // namespace easypbr::python
