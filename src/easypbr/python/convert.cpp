#include "easypbr/python/convert.h"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/python/text.h"
#include "easypbr/scene/color_range.h"

namespace easypbr::python {
namespace {

constexpr size_t copy_grain = 1 << 15;

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string dtype_text(const AnyArray& array) {
    const nb::dlpack::dtype type = array.dtype();
    const char* kind = type.code == uint8_t(nb::dlpack::dtype_code::Float) ? "float"
                       : type.code == uint8_t(nb::dlpack::dtype_code::Int) ? "int"
                                                                           : "uint";
    return fmt::format("{}{}", kind, int(type.bits));
}

/// Calls visit(pointer to const T) with the array's own element type.
template <class Visit>
void visit_elements(const AnyArray& array, Visit&& visit) {
    const void* data = array.data();
    const nb::dlpack::dtype type = array.dtype();
    if (type == nb::dtype<float>()) return visit(static_cast<const float*>(data));
    if (type == nb::dtype<double>()) return visit(static_cast<const double*>(data));
    if (type == nb::dtype<int8_t>()) return visit(static_cast<const int8_t*>(data));
    if (type == nb::dtype<int16_t>()) return visit(static_cast<const int16_t*>(data));
    if (type == nb::dtype<int32_t>()) return visit(static_cast<const int32_t*>(data));
    if (type == nb::dtype<int64_t>()) return visit(static_cast<const int64_t*>(data));
    if (type == nb::dtype<uint8_t>()) return visit(static_cast<const uint8_t*>(data));
    if (type == nb::dtype<uint16_t>()) return visit(static_cast<const uint16_t*>(data));
    if (type == nb::dtype<uint32_t>()) return visit(static_cast<const uint32_t*>(data));
    visit(static_cast<const uint64_t*>(data));
}

/// Rows, columns and strides (in elements) of an array of one or two dimensions.
struct Layout {
    Eigen::Index rows, cols;
    int64_t row_stride, col_stride;
};

[[noreturn]] void reject_shape(const AnyArray& array, const ArrayShape& shape) {
    std::string expected = shape.columns == 1 ? "n numbers" : fmt::format("n x {}", shape.columns);
    if (shape.more_columns != shape.columns) expected += fmt::format(" or n x {}", shape.more_columns);
    throw ArgumentError(
        fmt::format("{} {}: expected {}, got {}", shape.kind, shape.name, expected, shape_text(array)));
}

Layout layout_of(const AnyArray& array, const ArrayShape& shape) {
    if (array.size() == 0) return {0, shape.columns, 0, 0};
    if (array.ndim() == 1 && shape.columns == 1) return {Eigen::Index(array.shape(0)), 1, array.stride(0), 1};
    const bool fits = array.ndim() == 2 && (int64_t(array.shape(1)) == shape.columns ||
                                            int64_t(array.shape(1)) == shape.more_columns);
    if (!fits) reject_shape(array, shape);
    return {Eigen::Index(array.shape(0)), Eigen::Index(array.shape(1)), array.stride(0), array.stride(1)};
}

template <class Element>
Vec3d offset_for(const Element* data, const Layout& layout, double near) {
    const auto position = [&](size_t row) {
        const Element* first = data + int64_t(row) * layout.row_stride;
        return Vec3d(double(first[0]), double(first[layout.col_stride]),
                     double(first[2 * layout.col_stride]));
    };
    return choose_offset(size_t(layout.rows), position, near);
}

/// result(row, col) = convert(element, col), in parallel.
template <class Dense, class Element, class Convert>
void copy_rows(Dense& result, const Element* data, const Layout& layout, const Convert& convert) {
    parallel_chunks(size_t(layout.rows), copy_grain, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row)
            for (Eigen::Index col = 0; col < layout.cols; ++col)
                result(Eigen::Index(row), col) =
                    convert(data[int64_t(row) * layout.row_stride + col * layout.col_stride], col);
    });
}

template <class Element>
bool fits_int32(Element value) {
    if constexpr (std::is_floating_point_v<Element>)
        return std::floor(value) == value && value >= -2147483648.0 && value <= 2147483647.0;
    else
        return std::in_range<int32_t>(value);
}

template <class Dense, class Element>
void copy_floats(Dense& result, const Element* data, const Layout& layout, float scale = 1) {
    using Scalar = typename Dense::Scalar;
    copy_rows(result, data, layout,
              [scale](Element value, Eigen::Index) { return Scalar(value) * Scalar(scale); });
}

/// Colours of a type that does not tell their range become 0 to 1.
void normalize_given_colors(ArrayXf::Dense& C, bool integers, const ArrayShape& shape) {
    constexpr float rounding = 1e-3f;
    const ColorRange range = range_of_colors(C);
    const float white = white_of(range);
    const bool known =
        range.low >= -rounding && range.high <= 255 && (white > 1 || range.high <= 1 + rounding);
    if (!known)
        throw ArgumentError(fmt::format("{} {}, colours: expected 0 to 1 or 0 to 255, got {:g} to {:g}",
                                        shape.kind, shape.name, range.low, range.high));
    if (!integers && white > 1 && C.cols() == 4 && range_of_colors(C.leftCols(3)).high < 2)
        throw ArgumentError(
            fmt::format("{} {}, colours: expected 0 to 1 or 0 to 255 in all columns, got "
                        "an alpha of up to {:g}",
                        shape.kind, shape.name, range.high));
    parallel_for(size_t(C.size()), copy_grain, [&](size_t i) {
        float& value = C.data()[i];
        value = std::clamp(value / white, 0.0f, 1.0f);
    });
}

template <class Element>
Array3f copy_local(const Element* data, const Layout& layout, const Vec3d& offset) {
    Array3f::Dense rows(layout.rows, layout.cols);
    if (offset.isZero(0))
        copy_floats(rows, data, layout);
    else
        copy_rows(rows, data, layout,
                  [&](Element value, Eigen::Index col) { return float(double(value) - offset[col]); });
    return rows;
}

template <class Dense, class Element>
void copy_integers(Dense& result, const Element* data, const Layout& layout, const AnyArray& array,
                   const ArrayShape& shape) {
    std::atomic<bool> all_fit{true};
    copy_rows(result, data, layout, [&](Element value, Eigen::Index) {
        if (fits_int32(value)) return int32_t(value);
        all_fit = false;
        return int32_t(0);
    });
    if (!all_fit)
        throw ArgumentError(
            fmt::format("{} {}: expected whole numbers from -2147483648 to 2147483647, got others in {}",
                        shape.kind, shape.name, shape_text(array)));
}

/// Calls visit(pointer to the object's numbers, layout), without the GIL.
template <class Visit>
void visit_rows(nb::handle object, const ArrayShape& shape, const Visit& visit) {
    const AnyArray array = numeric_array(object, fmt::format("{} {}", shape.kind, shape.name).c_str());
    const Layout layout = layout_of(array, shape);
    released([&] { visit_elements(array, [&](const auto* data) { visit(data, layout); }); });
}

/// Numbers of an object that must have exactly `rows` x `cols` of them (a vector when rows is 1).
Eigen::MatrixXd exact_matrix(nb::handle object, int rows, int cols, const char* what) {
    const AnyArray array = numeric_array(object, what);
    const bool fits = rows == 1
                          ? array.ndim() == 1 && int(array.shape(0)) == cols
                          : array.ndim() == 2 && int(array.shape(0)) == rows && int(array.shape(1)) == cols;
    if (!fits)
        throw ArgumentError(fmt::format(
            "{}: expected {}, got {}", what,
            rows == 1 ? fmt::format("{} numbers", cols) : fmt::format("a {} x {} matrix", rows, cols),
            shape_text(array)));
    Eigen::MatrixXd result(rows, cols);
    const int64_t row_stride = rows == 1 ? 0 : array.stride(0), col_stride = array.stride(array.ndim() - 1);
    visit_elements(array, [&](const auto* data) {
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col)
                result(row, col) = double(data[row * row_stride + col * col_stride]);
    });
    if (!result.allFinite()) throw ArgumentError(fmt::format("{}: expected finite numbers", what));
    return result;
}

/// Whether an exception says that an object is no array; others are the caller's, as KeyboardInterrupt and
/// MemoryError are.
bool says_no_array(const nb::python_error& error) {
    return error.matches(PyExc_TypeError) || error.matches(PyExc_ValueError) ||
           error.matches(PyExc_OverflowError);
}

nb::object numpy_array(nb::handle object, const char* what) {
    const nb::module_ numpy = nb::module_::import_("numpy");
    try {
        // Tensors of other libraries, with gradients or on another device, and masked arrays; numpy's own
        // scalars and arrays pass.
        if (nb::hasattr(object, "__dlpack__") && !object.type().is(numpy.attr("ndarray")))
            return numpy.attr("asarray")(nb::module_::import_("easypbr.tensors").attr("as_numpy")(object));
        return numpy.attr("asarray")(object);
    } catch (nb::python_error& error) {
        if (!says_no_array(error)) throw;
        const nb::str reason(error.value());
        nb::raise_from(error, nb::module_::import_("easypbr.errors").attr("ArgumentError"),
                       "%s: expected an array of numbers: %U", what, reason.ptr());
    }
}

template <class T>
nb::object image_view(const Image& image, const nb::capsule& owner) {
    const size_t shape[3] = {size_t(image.height()), size_t(image.width()), size_t(image.channels())};
    return nb::cast(
        nb::ndarray<nb::numpy, T>(reinterpret_cast<T*>(const_cast<std::byte*>(image.bytes().data())),
                                  image.channels() == 1 ? 2 : 3, shape, owner));
}

}  // namespace

nb::object numeric_object(nb::handle object, const char* what) {
    nb::object array = numpy_array(object, what);
    const nb::object dtype = array.attr("dtype");
    const std::string kind = nb::cast<std::string>(dtype.attr("kind"));
    if (kind != "f" && kind != "i" && kind != "u")
        throw ArgumentError(fmt::format("{}: expected numbers, got dtype {}", what, nb::str(dtype).c_str()));
    const int bytes = nb::cast<int>(dtype.attr("itemsize"));
    if (kind == "f" && (bytes < 4 || bytes > 8))
        array = array.attr("astype")("float64");
    else if (!nb::cast<bool>(dtype.attr("isnative")))
        array = array.attr("astype")(dtype.attr("newbyteorder")("="));
    // Fields of packed records do not lie at multiples of their size.
    if (!nb::cast<bool>(array.attr("flags").attr("aligned"))) array = array.attr("copy")();
    return array;
}

AnyArray numeric_array(nb::handle object, const char* what) {
    return nb::cast<AnyArray>(numeric_object(object, what));
}

nb::object flags_as_numbers(nb::handle object, const char* what) {
    const nb::object array = numpy_array(object, what);
    const bool flags = nb::cast<std::string>(array.attr("dtype").attr("kind")) == "b";
    return flags ? array.attr("astype")("int32") : array;
}

std::string shape_text(const AnyArray& array) {
    std::string text;
    for (size_t i = 0; i < array.ndim(); ++i) text += fmt::format("{}{}", i ? " x " : "", array.shape(i));
    if (array.ndim() == 0) text = "a single";
    return fmt::format("{} {}", text, dtype_text(array));
}

Vec2i to_size(nb::handle object, const char* what) {
    const Eigen::MatrixXd size = exact_matrix(object, 1, 2, what);
    if (!fits_int32(size(0)) || !fits_int32(size(1)))
        throw ArgumentError(
            fmt::format("{}: expected two whole numbers, got ({}, {})", what, size(0), size(1)));
    return {int(size(0)), int(size(1))};
}

Vec3d to_vector3(nb::handle object, const char* what) {
    return exact_matrix(object, 1, 3, what).transpose();
}

Mat3d to_matrix3(nb::handle object, const char* what) {
    return exact_matrix(object, 3, 3, what);
}

Mat4d to_matrix4(nb::handle object, const char* what) {
    return exact_matrix(object, 4, 4, what);
}

Eigen::Affine3d to_affine(nb::handle object, const char* what) {
    const Mat4d matrix = to_matrix4(object, what);
    if (const Eigen::RowVector4d last = matrix.row(3); last != Eigen::RowVector4d(0, 0, 0, 1))
        throw ArgumentError(fmt::format("{}: expected a last row of (0, 0, 0, 1), got ({}, {}, {}, {})", what,
                                        last[0], last[1], last[2], last[3]));
    return Eigen::Affine3d(matrix);
}

Vec3 to_linear_color(nb::handle object, const char* what) {
    if (nb::isinstance<nb::str>(object)) {
        try {
            return linear_from_srgb(parse_color(nb::cast<std::string>(object)));
        } catch (const ArgumentError& error) {
            throw ArgumentError(fmt::format("{}: {}", what, error.what()));
        }
    }
    const Vec3d color = to_vector3(object, what);
    if ((color.array() < 0).any())
        throw ArgumentError(fmt::format("{}: expected numbers of at least 0, got ({}, {}, {})", what,
                                        color.x(), color.y(), color.z()));
    return color.cast<float>();
}

nb::object shareable(const nb::object& array) {
    return array.attr("view")(nb::module_::import_("easypbr.tensors").attr("SharedArray"));
}

nb::object matrix_to_numpy(const Eigen::MatrixXd& matrix) {
    auto* rows = new Matrix<double>(matrix);
    nb::capsule owner(rows, [](void* p) noexcept { delete static_cast<Matrix<double>*>(p); });
    const size_t shape[2] = {size_t(rows->rows()), size_t(rows->cols())};
    const bool vector = rows->rows() == 1;
    return nb::cast(
        nb::ndarray<nb::numpy, double>(rows->data(), vector ? 1 : 2, vector ? shape + 1 : shape, owner));
}

nb::tuple vector_to_tuple(const Vec3& vector) {
    return nb::make_tuple(vector.x(), vector.y(), vector.z());
}

template <class Scalar, int Cols>
typename Array<Scalar, Cols>::Dense to_array(nb::handle object, const ArrayShape& shape) {
    const AnyArray array = numeric_array(object, fmt::format("{} {}", shape.kind, shape.name).c_str());
    const Layout layout = layout_of(array, shape);
    typename Array<Scalar, Cols>::Dense result(layout.rows, layout.cols);
    released([&] {
        visit_elements(array, [&](const auto* data) {
            if constexpr (std::is_integral_v<Scalar>)
                copy_integers(result, data, layout, array, shape);
            else
                copy_floats(result, data, layout);
        });
    });
    return result;
}

RoundingCounts rounding_of(nb::handle object, const ArrayShape& shape) {
    Rounding rounding;
    visit_rows(object, shape, [&](const auto* data, const Layout& layout) {
        using Element = std::remove_cvref_t<decltype(*data)>;
        if constexpr (sizeof(Element) >= 4 && !std::is_same_v<Element, float>)
            parallel_chunks(size_t(layout.rows), copy_grain, [&](size_t begin, size_t end) {
                RoundingCounts piece;
                for (size_t row = begin; row < end; ++row) piece.add(data[int64_t(row) * layout.row_stride]);
                rounding.add(piece);
            });
    });
    return rounding.counts();
}

ArrayXf to_colors(nb::handle object, const ArrayShape& shape) {
    ArrayXf::Dense C;
    visit_rows(object, shape, [&](const auto* data, const Layout& layout) {
        using Element = std::remove_cvref_t<decltype(*data)>;
        constexpr bool spans = std::is_same_v<Element, uint8_t> || std::is_same_v<Element, uint16_t>;
        C.resize(layout.rows, layout.cols);
        copy_floats(C, data, layout, spans ? 1.0f / float(std::numeric_limits<Element>::max()) : 1.0f);
        if (!spans) normalize_given_colors(C, std::is_integral_v<Element>, shape);
    });
    return C;
}

LocalPositions to_positions(nb::handle object, const ArrayShape& shape) {
    LocalPositions result;
    visit_rows(object, shape, [&](const auto* data, const Layout& layout) {
        using Element = std::remove_cvref_t<decltype(*data)>;
        if (!std::is_same_v<Element, float>) result.offset = offset_for(data, layout, near_zero);
        result.V = copy_local(data, layout, result.offset);
    });
    return result;
}

LocalPositions to_points(nb::handle object, const ArrayShape& shape) {
    LocalPositions result;
    visit_rows(object, shape, [&](const auto* data, const Layout& layout) {
        result.offset = offset_for(data, layout, 0);
        result.V = copy_local(data, layout, result.offset);
    });
    return result;
}

Array3f to_local(nb::handle object, const ArrayShape& shape, const Vec3d& offset) {
    Array3f result;
    visit_rows(object, shape,
               [&](const auto* data, const Layout& layout) { result = copy_local(data, layout, offset); });
    return result;
}

template Array1f::Dense to_array<float, 1>(nb::handle, const ArrayShape&);
template Array2f::Dense to_array<float, 2>(nb::handle, const ArrayShape&);
template Array3f::Dense to_array<float, 3>(nb::handle, const ArrayShape&);
template Array3d::Dense to_array<double, 3>(nb::handle, const ArrayShape&);
template ArrayXf::Dense to_array<float, Eigen::Dynamic>(nb::handle, const ArrayShape&);
template Array4f::Dense to_array<float, 4>(nb::handle, const ArrayShape&);
template Array1i::Dense to_array<int32_t, 1>(nb::handle, const ArrayShape&);
template Array2i::Dense to_array<int32_t, 2>(nb::handle, const ArrayShape&);
template Array3i::Dense to_array<int32_t, 3>(nb::handle, const ArrayShape&);

nb::object to_numpy(Image image) {
    auto* held = new Image(std::move(image));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<Image*>(p); });
    switch (held->type()) {
        case PixelType::u8:
            return image_view<uint8_t>(*held, owner);
        case PixelType::u16:
            return image_view<uint16_t>(*held, owner);
        case PixelType::f32:
            break;
    }
    return image_view<float>(*held, owner);
}

nb::object to_numpy(std::shared_ptr<const Image> image) {
    auto* held = new std::shared_ptr<const Image>(std::move(image));
    nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::shared_ptr<const Image>*>(p); });
    switch ((*held)->type()) {
        case PixelType::u8:
            return image_view<const uint8_t>(**held, owner);
        case PixelType::u16:
            return image_view<const uint16_t>(**held, owner);
        case PixelType::f32:
            break;
    }
    return image_view<const float>(**held, owner);
}

Image to_image(nb::handle object, const char* what) {
    const nb::object numbers = numeric_object(object, what);
    const AnyArray given = nb::cast<AnyArray>(numbers);
    const bool is_float = given.dtype().code == uint8_t(nb::dlpack::dtype_code::Float);
    const PixelType type = is_float                                 ? PixelType::f32
                           : given.dtype() == nb::dtype<uint16_t>() ? PixelType::u16
                                                                    : PixelType::u8;
    const bool known = is_float || type == PixelType::u16 || given.dtype() == nb::dtype<uint8_t>();
    if (!known || (given.ndim() != 2 && given.ndim() != 3))
        throw ArgumentError(
            fmt::format("{}: expected height x width or height x width x (1 to 4) of uint8, uint16 or "
                        "float, got {}",
                        what, shape_text(given)));
    constexpr size_t too_large = size_t(max_image_side) + 1;
    const auto side = [&](size_t axis) { return int(std::min(given.shape(axis), too_large)); };
    Image image(side(1), side(0), given.ndim() == 3 ? side(2) : 1, type);
    const nb::object rows = nb::module_::import_("numpy").attr("ascontiguousarray")(
        numbers, nb::arg("dtype") = type == PixelType::u8    ? "uint8"
                                    : type == PixelType::u16 ? "uint16"
                                                             : "float32");
    const AnyArray contiguous = nb::cast<AnyArray>(rows);
    std::memcpy(image.bytes().data(), contiguous.data(), image.bytes().size());
    return image;
}

bool is_path(nb::handle object) {
    return nb::isinstance<nb::str>(object) || nb::isinstance<nb::bytes>(object) ||
           nb::hasattr(object, "__fspath__");
}

}  // namespace easypbr::python
