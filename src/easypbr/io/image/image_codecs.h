// One pair of functions per image format; load_image() and save_image() choose among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/core/math.h"

namespace easypbr::io {

using Bytes = std::span<const std::byte>;

/// Each throws FormatError, with `name` in the message, for content that is damaged, truncated or not
/// supported.
Image decode_png(Bytes bytes, const std::string& name);
Image decode_jpeg(Bytes bytes, const std::string& name);
Image decode_webp(Bytes bytes, const std::string& name);
Image decode_hdr(Bytes bytes, const std::string& name);
Image decode_exr(Bytes bytes, const std::string& name);

bool starts_with(Bytes bytes, std::string_view magic);

/// Whether the first bytes are those of a WebP file.
bool is_webp(Bytes bytes);

/// How the picture of a JPEG file is to be turned, by its EXIF tag: 1 to 8, see upright(). 1 where there is
/// none, or it is damaged.
int jpeg_orientation(Bytes bytes);

/// A picture that is stored with an orientation as EXIF numbers them, the way up it is to be seen. The number
/// tells where its first row and first column are then: 1 top, left; 2 top, right; 3 bottom, right; 4 bottom,
/// left; 5 left, top; 6 right, top; 7 right, bottom; 8 left, bottom.
Image upright(Image image, int orientation);

/// Pixels that JPEG holds a side.
inline constexpr int max_jpeg_side = 65500;
/// Of files that save_image() writes.
inline constexpr int jpeg_quality = 95;
/// Quality 1 to 100, no chroma subsampling; alpha is dropped. u8 only.
std::vector<std::byte> encode_jpeg(const Image& image, int quality = jpeg_quality);
/// Of pictures that are seen for a moment: half the chroma in each direction, quicker transforms. RGBA u8.
std::vector<std::byte> encode_jpeg_quickly(const Image& image, int quality);
/// Quality 0 to 100, with alpha where the image has it. u8 with 3 or 4 channels, at most 16383 pixels a side.
std::vector<std::byte> encode_webp(const Image& image, int quality);
/// Run-length encoded RGBE; alpha is dropped, negative and NaN become 0. f32 only.
std::vector<std::byte> encode_hdr(const Image& image);
/// float32 channels, ZIP-compressed scanlines. f32 only.
std::vector<std::byte> encode_exr(const Image& image);
/// Whole numbers, one to a pixel, row 0 on top: one channel Y of EXR's only integer type, UINT of 32 bits. A
/// negative one is stored as its two's complement, -1 as 4294967295.
std::vector<std::byte> encode_exr(std::vector<int32_t> values, Vec2i size);
/// What save_image() writes into a file with one of writable_image_extensions().
std::vector<std::byte> encode_image(const Image& image, const std::filesystem::path& path);

/// Throws FormatError: "cannot read NAME: WHAT".
[[noreturn]] void fail_image(const std::string& name, std::string_view what);

/// Throws FormatError unless 1 <= width, height <= max_image_side.
void check_image_size(long long width, long long height, const std::string& name);

/// A zero-filled image. Throws FormatError when it is more than reading may take (core/memory_budget.h).
Image make_image(int width, int height, int channels, PixelType type, const std::string& name);

/// Throws FormatError when `pixel_bytes` are more than `bytes_per_byte` for each byte of the file: a header
/// that promises more than the rest can hold.
void check_plausible(size_t pixel_bytes, size_t file_bytes, size_t bytes_per_byte, const std::string& name);

}  // namespace easypbr::io
