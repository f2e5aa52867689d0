// Pictures as numpy arrays.
#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/vector.h>

#include "easypbr/app/output.h"
#include "easypbr/core/error.h"
#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/python/convert.h"
#include "easypbr/python/text.h"

namespace easypbr::python {
namespace {

nb::bytes to_bytes(const std::vector<std::byte>& bytes) {
    return nb::bytes(bytes.data(), bytes.size());
}

nb::bytes png_bytes(const ArrayLike& array, bool deep) {
    const Image image = to_image(array, "image");
    return to_bytes(released([&] { return io::encode_png(deep ? image : picture_to_u8(image)); }));
}

nb::bytes jpeg_bytes(const ArrayLike& array, int quality) {
    if (quality < 1 || quality > 100)
        throw ArgumentError(fmt::format("quality: expected 1 to 100, got {}", quality));
    const Image image = to_u8(to_image(array, "image"));
    return to_bytes(released([&] { return io::encode_jpeg(image, quality); }));
}

nb::bytes exr_bytes(const ArrayLike& array) {
    const Image image = to_image(array, "image");
    if (image.type() != PixelType::f32) throw ArgumentError("image: expected float32 or float64 values");
    return to_bytes(released([&] { return io::encode_exr(image); }));
}

nb::object decoded(const nb::bytes& bytes) {
    const std::span data(static_cast<const std::byte*>(bytes.data()), bytes.size());
    return to_numpy(released([&] { return io::decode_image(data, "picture"); }));
}

nb::dict compare_images(const ArrayLike& a, const ArrayLike& b) {
    const ImageDifference difference = compare(to_image(a, "first image"), to_image(b, "second image"));
    nb::dict result;
    result["max"] = difference.max;
    result["mean"] = difference.mean;
    result["rmse"] = difference.rmse;
    result["psnr"] = difference.psnr;
    result["different"] = difference.different;
    return result;
}

/// An array of its own that keeps the given one alive: numpy's older ones know DLPack before 1.0 only.
nb::object dlpack_of(const nb::object& given) {
    const AnyArray array = nb::cast<AnyArray>(given);
    std::vector<size_t> shape;
    std::vector<int64_t> strides;
    for (size_t i = 0; i < array.ndim(); ++i) {
        shape.push_back(array.shape(i));
        strides.push_back(array.stride(i));
    }
    using Exported = nb::ndarray<nb::array_api, nb::ro, nb::device::cpu>;
    return nb::cast(Exported(array.data(), array.ndim(), shape.data(), given, strides.data(), array.dtype()));
}

}  // namespace

void bind_image(nb::module_& module) {
    module.def(
        "load_image",
        [](const fs::path& path) { return to_numpy(released([&] { return io::load_image(path); })); },
        nb::arg("path"), nb::sig("def load_image(path: str | os.PathLike) -> numpy.ndarray"),
        "Reads PNG, JPEG, WebP, HDR or EXR: height x width x channels, row 0 on top; uint8 or uint16 (sRGB), "
        "or float32 (linear). Pixels are as they are stored, whatever orientation EXIF notes.");
    module.def(
        "save_image",
        [](const ArrayLike& array, const fs::path& path) {
            const Image image = to_image(array, "image");
            released([&] { io::save_image(image, path); });
        },
        nb::arg("image"), nb::arg("path"),
        "Writes PNG, JPEG, HDR or EXR by the extension. Floating-point images are linear and premultiplied "
        "by alpha, others are sRGB with straight alpha; JPEG and HDR hold no alpha but 1.");
    module.def("encode_png", png_bytes, nb::arg("image"), nb::arg("deep") = false,
               "The bytes of a PNG file of 8 bits; with `deep`, of 16 bits if the image is uint16.");
    module.def("encode_jpeg", jpeg_bytes, nb::arg("image"), nb::arg("quality") = io::jpeg_quality,
               "The bytes of a JPEG file.");
    module.def("encode_exr", exr_bytes, nb::arg("image"), "The bytes of an EXR file of float32.");
    module.def("decode_image", decoded, nb::arg("bytes"),
               nb::sig("def decode_image(bytes: bytes) -> numpy.ndarray"),
               "Like load_image(), from the bytes of a file.");
    module.def(
        "compare_images", compare_images, nb::arg("a"), nb::arg("b"),
        "Differences of two images of the same size and type: max, mean, rmse, psnr, different (pixels).");
    module.def("_dlpack_of", dlpack_of, nb::arg("array"),
               nb::sig("def _dlpack_of(array: numpy.ndarray) -> typing.Any"),
               "The array as an object with DLPack 1.0, whose flag says that it is read-only.");
    module.def(
        "check_picture_path",
        [](const fs::path& path, const nb::object& size, bool transparent) {
            const bool linear = app::encoding_for(path) == app::Encoding::scene_linear;
            if (transparent) app::check_holds_alpha(path);
            if (!size.is_none()) app::check_picture_fits(path, to_size(size, "size"));
            check_writable(path);
            return linear;
        },
        nb::arg("path"), nb::arg("size") = nb::none(), nb::arg("transparent") = false,
        "Raises if an image (of this size, transparent) cannot be written there; returns whether it will "
        "hold linear values.");
}

}  // namespace easypbr::python
