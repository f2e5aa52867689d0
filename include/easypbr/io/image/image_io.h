// Image files to values and back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/core/image.h"

namespace easypbr::io {

/// Reads PNG (u8 or u16), JPEG (u8), WebP (u8, one picture), Radiance HDR (f32) and EXR (f32; channels R, G,
/// B, A or Y), told apart by their first bytes. Throws FileError or FormatError (a damaged or truncated file,
/// or an unknown kind).
Image load_image(const std::filesystem::path& path);

/// The same, turned as the orientation that cameras write into JPEG files (EXIF) asks for; load_image() gives
/// the pixels as they are stored.
Image load_upright_image(const std::filesystem::path& path);

/// load_image() from memory; `name` stands in messages.
Image decode_image(std::span<const std::byte> bytes, const std::string& name);

/// Writes by the extension: PNG (u8, u16), JPEG (quality 95), HDR, EXR (float32). Types are converted where
/// the format asks for it: f32 is clamped and sRGB-encoded for PNG and JPEG, u8 and u16 are decoded for HDR
/// and EXR. f32 colour is premultiplied by alpha, that of u8 and u16 is straight. Throws FileError, or
/// ArgumentError for an unknown extension, or transparent pixels for JPEG or HDR. Never leaves half a file.
void save_image(const Image& image, const std::filesystem::path& path);

/// The bytes of a PNG file (u8 or u16 image).
std::vector<std::byte> encode_png(const Image& image);

/// Most pixels a side that save_image() writes into a file with this extension.
int largest_image_side(std::string_view extension);

/// That files with this extension have no alpha, as messages say it; empty where they have.
std::string_view lack_of_alpha(std::string_view extension);

/// Extensions that save_image() writes.
std::vector<std::string> writable_image_extensions();

}  // namespace easypbr::io
