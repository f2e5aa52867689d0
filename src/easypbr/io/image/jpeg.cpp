#include <fmt/format.h>
#include <turbojpeg.h>

#include <cstring>
#include <memory>
#include <string_view>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_codecs.h"

namespace easypbr::io {
namespace {

/// At least one bit for a block of 64 samples (512 per byte), doubled to be safe, times the 4 channels of
/// CMYK.
constexpr size_t most_jpeg_bytes_per_byte = 1024 * 4;
/// The format's own limit.

struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Destroy>;

const unsigned char* jpeg_data_of(Bytes bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

/// The first segment of a kind that begins with a text, without marker and length; empty where none stands
/// before the first scan. Ends at what is damaged.
Bytes segment_of(Bytes bytes, uint8_t kind, std::string_view magic) {
    const unsigned char* data = jpeg_data_of(bytes);
    for (size_t at = 2; at + 4 <= bytes.size() && data[at] == 0xff;) {
        const unsigned char marker = data[at + 1];
        if (marker == 0xff) {  // padding
            ++at;
            continue;
        }
        const size_t length = size_t(data[at + 2]) << 8 | data[at + 3];
        if (marker == 0xda || length < 2 || length > bytes.size() - at - 2) break;
        const Bytes content = bytes.subspan(at + 4, length - 2);
        if (marker == kind && starts_with(content, magic)) return content;
        at += 2 + length;
    }
    return {};
}

/// An Adobe segment (APP14) means that CMYK is stored inverted.
bool has_adobe_marker(Bytes bytes) {
    return !segment_of(bytes, 0xee, "Adobe").empty();
}

/// Numbers of a TIFF file, by the order of bytes that its header names; 0 beyond its end.
class TiffNumbers {
  public:
    explicit TiffNumbers(Bytes tiff) : tiff_(tiff), is_little_(starts_with(tiff, "II")) {}

    uint32_t read(size_t at, int bytes) const {
        if (at > tiff_.size() || tiff_.size() - at < size_t(bytes)) return 0;
        uint32_t number = 0;
        for (int i = 0; i < bytes; ++i) {
            const int place = is_little_ ? bytes - 1 - i : i;
            number = number << 8 | uint32_t(tiff_[at + size_t(place)]);
        }
        return number;
    }

  private:
    Bytes tiff_;
    bool is_little_;
};

Image rgb_from_cmyk(const Image& cmyk, bool inverted) {
    Image out(cmyk.width(), cmyk.height(), 3, PixelType::u8);
    const uint8_t* in = cmyk.pixels<uint8_t>().data();
    uint8_t* to = out.pixels<uint8_t>().data();
    const unsigned flip = inverted ? 0 : 255;
    parallel_for(cmyk.pixel_count(), 1 << 14, [&](size_t i) {
        const unsigned key = in[4 * i + 3] ^ flip;
        for (int c = 0; c < 3; ++c) to[3 * i + c] = uint8_t(((in[4 * i + c] ^ flip) * key + 127) / 255);
    });
    return out;
}

/// Padding between segments is harmless; every other complaint of the decoder means that pixels are missing
/// or wrong.
void check_decoded(int result, const Handle& handle, const std::string& name) {
    if (result == 0) return;
    const std::string_view message = tjGetErrorStr2(handle.get());
    const bool harmless = tjGetErrorCode(handle.get()) == TJERR_WARNING &&
                          message.find("extraneous bytes") != std::string_view::npos;
    if (!harmless) fail_image(name, fmt::format("damaged JPEG: {}", message));
}

struct JpegForm {
    int pixels, subsampling, flags;
};

std::vector<std::byte> compress(const Image& image, const JpegForm& form, int quality) {
    if (image.width() > max_jpeg_side || image.height() > max_jpeg_side)
        throw ArgumentError(fmt::format("cannot encode JPEG: {}x{} pixels, the format holds at most {}",
                                        image.width(), image.height(), max_jpeg_side));
    const Handle handle(tjInitCompress());
    unsigned char* buffer = nullptr;
    unsigned long size = 0;
    const int result =
        tjCompress2(handle.get(), image.pixels<uint8_t>().data(), image.width(), 0, image.height(),
                    form.pixels, &buffer, &size, form.subsampling, quality, form.flags);
    const std::unique_ptr<unsigned char, decltype(&tjFree)> owner(buffer, tjFree);
    if (result) throw ArgumentError(fmt::format("cannot encode JPEG: {}", tjGetErrorStr2(handle.get())));
    const auto* begin = reinterpret_cast<const std::byte*>(buffer);
    return {begin, begin + size};
}

}  // namespace

Image decode_jpeg(Bytes bytes, const std::string& name) {
    const Handle handle(tjInitDecompress());
    int width = 0, height = 0, subsampling = 0, colorspace = 0;
    if (tjDecompressHeader3(handle.get(), jpeg_data_of(bytes), bytes.size(), &width, &height, &subsampling,
                            &colorspace))
        fail_image(name, fmt::format("damaged JPEG: {}", tjGetErrorStr2(handle.get())));
    check_image_size(width, height, name);
    const bool cmyk = colorspace == TJCS_CMYK || colorspace == TJCS_YCCK;
    const bool grey = colorspace == TJCS_GRAY;
    const int channels = cmyk ? 4 : grey ? 1 : 3;
    const int format = cmyk ? TJPF_CMYK : grey ? TJPF_GRAY : TJPF_RGB;
    check_plausible(size_t(width) * height * channels, bytes.size(), most_jpeg_bytes_per_byte, name);
    Image image = make_image(width, height, channels, PixelType::u8, name);
    // A progressive file may hold thousands of empty scans, each of which costs time for the whole picture.
    check_decoded(
        tjDecompress2(handle.get(), jpeg_data_of(bytes), bytes.size(), image.pixels<uint8_t>().data(), width,
                      0, height, format, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS),
        handle, name);
    if (cmyk) return rgb_from_cmyk(image, has_adobe_marker(bytes));
    return image;
}

int jpeg_orientation(Bytes bytes) {
    constexpr std::string_view magic("Exif\0\0", 6);
    constexpr size_t entry_bytes = 12;
    constexpr uint32_t orientation_tag = 0x112, of_16_bits = 3;
    const Bytes segment = segment_of(bytes, 0xe1, magic);
    if (segment.empty()) return 1;
    const Bytes tiff = segment.subspan(magic.size());
    if (!starts_with(tiff, "II") && !starts_with(tiff, "MM")) return 1;
    const TiffNumbers numbers(tiff);
    if (numbers.read(2, 2) != 42) return 1;
    const size_t directory = numbers.read(4, 4);
    const size_t count = numbers.read(directory, 2);
    for (size_t i = 0; i < count; ++i) {
        const size_t entry = directory + 2 + entry_bytes * i;
        if (numbers.read(entry, 2) != orientation_tag) continue;
        const uint32_t value = numbers.read(entry + 2, 2) == of_16_bits ? numbers.read(entry + 8, 2) : 1;
        return value >= 1 && value <= 8 ? int(value) : 1;
    }
    return 1;
}

std::vector<std::byte> encode_jpeg(const Image& image, int quality) {
    const bool grey = image.channels() <= 2;
    const Image plain = with_channels(image, grey ? 1 : 3);
    return compress(plain, {grey ? TJPF_GRAY : TJPF_RGB, grey ? TJSAMP_GRAY : TJSAMP_444, TJFLAG_ACCURATEDCT},
                    quality);
}

std::vector<std::byte> encode_jpeg_quickly(const Image& image, int quality) {
    if (image.channels() != 4) throw ArgumentError("cannot encode JPEG quickly: expected RGBA");
    return compress(image, {TJPF_RGBA, TJSAMP_420, TJFLAG_FASTDCT}, quality);
}

}  // namespace easypbr::io
