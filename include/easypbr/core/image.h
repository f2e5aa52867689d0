// Image: a value of width x height pixels with 1 to 4 interleaved channels; row 0 is the top.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "easypbr/core/error.h"

namespace easypbr {

/// What tells whether the file that an image was read from has changed since.
struct FileState {
    std::uintmax_t size = 0;               ///< in bytes
    std::filesystem::file_time_type time;  ///< when it was changed last

    bool operator==(const FileState&) const = default;
};

/// Type of one channel. u8 and u16 colour is sRGB-encoded, f32 colour is linear.
enum class PixelType { u8, u16, f32 };

constexpr size_t size_of(PixelType type) {
    return type == PixelType::u8 ? 1 : type == PixelType::u16 ? 2 : 4;
}

/// Largest width or height that any function of the library accepts.
inline constexpr int max_image_side = 65536;

class Image {
  public:
    Image() = default;

    /// A zero-filled image. Throws ArgumentError unless 1 <= width, height <= max_image_side and 1 <=
    /// channels <= 4.
    Image(int width, int height, int channels, PixelType type);

    Image(const Image& other) = default;
    Image& operator=(const Image& other) = default;
    /// The image that was moved from is empty: 0 x 0 without channels.
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        Image(std::move(other)).swap(*this);
        return *this;
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    PixelType type() const { return type_; }
    bool empty() const { return data_.empty(); }
    size_t pixel_count() const { return size_t(width_) * size_t(height_); }
    size_t row_bytes() const { return size_t(width_) * size_t(channels_) * size_of(type_); }

    std::span<const std::byte> bytes() const { return data_; }
    std::span<std::byte> bytes() { return data_; }

    /// All channels of all pixels, row by row. Throws ArgumentError when T is not the image's pixel type:
    /// uint8_t or std::byte, uint16_t, or float.
    template <class T>
    std::span<const T> pixels() const {
        require<T>();
        return {reinterpret_cast<const T*>(data_.data()), data_.size() / sizeof(T)};
    }
    template <class T>
    std::span<T> pixels() {
        require<T>();
        return {reinterpret_cast<T*>(data_.data()), data_.size() / sizeof(T)};
    }

    /// First channel of pixel (x, y), unchecked.
    template <class T>
    const T* at(int x, int y) const {
        return reinterpret_cast<const T*>(data_.data()) + place_of(x, y);
    }
    template <class T>
    T* at(int x, int y) {
        return reinterpret_cast<T*>(data_.data()) + place_of(x, y);
    }

  private:
    size_t place_of(int x, int y) const {
        return (size_t(y) * size_t(width_) + size_t(x)) * size_t(channels_);
    }

    void swap(Image& other) noexcept {
        std::swap(width_, other.width_);
        std::swap(height_, other.height_);
        std::swap(channels_, other.channels_);
        std::swap(type_, other.type_);
        data_.swap(other.data_);
    }

    template <class T>
    void require() const {
        constexpr bool is_u8 = std::is_same_v<T, uint8_t> || std::is_same_v<T, std::byte>;
        const bool is_held = type_ == PixelType::u8    ? is_u8
                             : type_ == PixelType::u16 ? std::is_same_v<T, uint16_t>
                                                       : std::is_same_v<T, float>;
        if (!is_held) throw ArgumentError("image: pixels read as a type that it does not hold");
    }

    int width_ = 0, height_ = 0, channels_ = 0;
    PixelType type_ = PixelType::u8;
    std::vector<std::byte> data_;
};

/// Whether the last channel is alpha: of 2 channels, or 4.
inline bool has_alpha(const Image& image) {
    return image.channels() > 0 && image.channels() % 2 == 0;
}

/// The same picture with another number of channels: grey is repeated, missing alpha is opaque, extra
/// channels dropped.
Image with_channels(const Image& image, int channels);

/// The same picture as u8 (sRGB) when it is f32 (linear, clamped to [0, 1]) or u16; u8 is returned as it is.
Image to_u8(const Image& image);

/// The same numbers as u8, for images of data in place of colours, such as roughness and normals: f32 is
/// clamped to [0, 1] and has no sRGB curve; u8 and u16 are as in to_u8().
Image data_to_u8(const Image& image);

/// Texels of a texture as u8: to_u8() of colours, data_to_u8() of data.
Image texels_to_u8(const Image& image, bool is_color);

/// The same picture as linear f32; u8 and u16 colour is decoded from sRGB, alpha (2nd or 4th channel) is
/// scaled only.
Image to_linear_f32(const Image& image);

/// Whether nothing shines through: there is no alpha, or it is 1 everywhere (f32: rounds to it in 8 bits).
bool is_fully_opaque(const Image& image);

/// f32 colour that is premultiplied by alpha (2nd or 4th channel), as pictures hold it, divided by alpha; 0
/// where alpha is 0. Throws ArgumentError unless the pixels are f32.
Image unpremultiplied(const Image& image);
/// The reverse.
Image premultiplied(const Image& image);

/// to_u8() of a picture: f32 pictures hold premultiplied colour, u8 and u16 ones straight colour. Textures
/// hold straight colour whatever their type: to_u8().
Image picture_to_u8(const Image& picture);
/// to_linear_f32() of a picture, premultiplied.
Image picture_to_linear_f32(const Image& picture);

/// The largest value of a channel other than alpha that is a number; at least 0. Throws ArgumentError unless
/// the pixels are f32.
float largest_color(const Image& image);

/// Puts 0 where a value of an f32 image is NaN or infinite; returns how many there were.
size_t replace_non_finite(Image& image);

/// Every second row and column averaged in 2x2 boxes, as for mip levels (at least 1x1). Throws ArgumentError
/// unless the pixels are f32.
Image half_size(const Image& image);

struct ImageDifference {
    double max = 0;        ///< largest absolute difference of a channel, in units of the type (0..255 for u8)
    double mean = 0;       ///< mean absolute difference over all channels
    double rmse = 0;       ///< root of the mean squared difference
    double psnr = 0;       ///< in dB with peak 255, 65535 or 1 (infinity for equal images)
    size_t different = 0;  ///< pixels with any difference
};

/// Throws ArgumentError when size, channels or type differ. Alpha counts as any channel.
ImageDifference compare(const Image& a, const Image& b);

}  // namespace easypbr
