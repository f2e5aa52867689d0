#include "easypbr/io/image/image_io.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "easypbr/core/file.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_codecs.h"

namespace easypbr::io {

bool starts_with(Bytes bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

void fail_image(const std::string& name, std::string_view what) {
    throw FormatError(fmt::format("cannot read {}: {}", name, what));
}

void check_image_size(long long width, long long height, const std::string& name) {
    if (width < 1 || height < 1 || width > max_image_side || height > max_image_side)
        fail_image(name, fmt::format("image size {}x{}: width and height must be 1 to {}", width, height,
                                     max_image_side));
}

Image make_image(int width, int height, int channels, PixelType type, const std::string& name) {
    charge_memory(uint64_t(width) * uint64_t(height) * uint64_t(channels) * size_of(type),
                  fmt::format("the pixels of {}", name));
    return {width, height, channels, type};
}

void check_plausible(size_t pixel_bytes, size_t file_bytes, size_t bytes_per_byte, const std::string& name) {
    if (pixel_bytes / bytes_per_byte > file_bytes)
        fail_image(
            name, fmt::format("its header promises {} bytes of pixels, more than a file of {} bytes can hold",
                              pixel_bytes, file_bytes));
}

Image decode_image(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.empty()) fail_image(name, "the file is empty");
    if (starts_with(bytes, "\x89PNG")) return decode_png(bytes, name);
    if (starts_with(bytes, "\xff\xd8\xff")) return decode_jpeg(bytes, name);
    if (is_webp(bytes)) return decode_webp(bytes, name);
    if (starts_with(bytes, "\xabKTX "))
        fail_image(name, "a KTX texture, which is not supported: expected PNG, JPEG or WebP");
    if (starts_with(bytes, "#?")) return decode_hdr(bytes, name);
    if (starts_with(bytes, "\x76\x2f\x31\x01")) return decode_exr(bytes, name);
    fail_image(
        name,
        "its first bytes are of no known image format (expected PNG, JPEG, WebP, Radiance HDR or OpenEXR)");
}

Image load_image(const std::filesystem::path& path) {
    const FileBytes file(path);
    Image image = decode_image(file.bytes(), path.string());
    file.check();
    return image;
}

Image upright(Image image, int orientation) {
    if (orientation <= 1 || orientation > 8) return image;
    const int width = image.width(), height = image.height();
    const bool from_right = orientation == 2 || orientation == 3 || orientation >= 7;
    const bool from_bottom = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    const bool turned = orientation >= 5;
    Image out(turned ? height : width, turned ? width : height, image.channels(), image.type());
    const size_t pixel = size_of(image.type()) * size_t(image.channels());
    const std::byte* const from = image.bytes().data();
    std::byte* const to = out.bytes().data();
    parallel_for(size_t(out.height()), 64, [&](size_t row) {
        for (int column = 0; column < out.width(); ++column) {
            const int x = turned ? int(row) : column, y = turned ? column : int(row);
            const int from_y = from_bottom ? height - 1 - y : y, from_x = from_right ? width - 1 - x : x;
            const size_t at = size_t(from_y) * size_t(width) + size_t(from_x);
            std::memcpy(to + (row * size_t(out.width()) + size_t(column)) * pixel, from + at * pixel, pixel);
        }
    });
    return out;
}

Image load_upright_image(const std::filesystem::path& path) {
    const FileBytes file(path);
    Image image = decode_image(file.bytes(), path.string());
    if (starts_with(file.bytes(), "\xff\xd8\xff"))
        image = upright(std::move(image), jpeg_orientation(file.bytes()));
    file.check();
    return image;
}

std::vector<std::byte> encode_image(const Image& image, const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension == "png") return encode_png(image.type() == PixelType::f32 ? picture_to_u8(image) : image);
    if (extension == "exr") return encode_exr(picture_to_linear_f32(image));
    if (!is_fully_opaque(image))
        throw ArgumentError(
            fmt::format("cannot write {}: {}; write a PNG or EXR", path.string(), lack_of_alpha(extension)));
    return extension == "hdr" ? encode_hdr(to_linear_f32(image)) : encode_jpeg(to_u8(image));
}

void save_image(const Image& image, const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    const std::vector<std::string> known = writable_image_extensions();
    if (std::find(known.begin(), known.end(), extension) == known.end())
        throw ArgumentError(fmt::format("cannot write {}: unknown image extension '{}' (expected {})",
                                        path.string(), extension, fmt::join(known, ", ")));
    if (image.empty()) throw ArgumentError(fmt::format("cannot write {}: the image is empty", path.string()));
    write_file(path, encode_image(image, path));
}

std::string_view lack_of_alpha(std::string_view extension) {
    if (extension == "hdr") return "HDR has no transparency";
    return extension == "jpg" || extension == "jpeg" ? "JPEG has no transparency" : "";
}

int largest_image_side(std::string_view extension) {
    return extension == "jpg" || extension == "jpeg" ? max_jpeg_side : max_image_side;
}

std::vector<std::string> writable_image_extensions() {
    return {"png", "jpg", "jpeg", "hdr", "exr"};
}

}  // namespace easypbr::io
