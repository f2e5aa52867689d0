#include <webp/decode.h>
#include <webp/encode.h>

#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "easypbr/io/image/image_codecs.h"

namespace easypbr::io {
namespace {

const uint8_t* webp_data_of(Bytes bytes) {
    return reinterpret_cast<const uint8_t*>(bytes.data());
}

std::string_view status_of(VP8StatusCode code) {
    return code == VP8_STATUS_NOT_ENOUGH_DATA       ? "it ends before its pixels do"
           : code == VP8_STATUS_UNSUPPORTED_FEATURE ? "it uses a feature that is not supported"
           : code == VP8_STATUS_OUT_OF_MEMORY       ? "out of memory"
                                                    : "its data are damaged";
}

}  // namespace

bool is_webp(Bytes bytes) {
    return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
           std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

/// No bytes of the file bear its size out, for a picture of one colour takes a few: the limit on memory does.
Image decode_webp(Bytes bytes, const std::string& name) {
    WebPBitstreamFeatures features;
    const VP8StatusCode read = WebPGetFeatures(webp_data_of(bytes), bytes.size(), &features);
    if (read != VP8_STATUS_OK) fail_image(name, fmt::format("damaged WebP: {}", status_of(read)));
    if (features.has_animation) fail_image(name, "an animated WebP: expected a single picture");
    check_image_size(features.width, features.height, name);
    const int channels = features.has_alpha ? 4 : 3;
    const size_t size = size_t(features.width) * size_t(features.height) * size_t(channels);
    Image image = make_image(features.width, features.height, channels, PixelType::u8, name);
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) fail_image(name, "libwebp is of another version");
    config.output.colorspace = features.has_alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {image.pixels<uint8_t>().data(), features.width * channels, size};
    const VP8StatusCode decoded = WebPDecode(webp_data_of(bytes), bytes.size(), &config);
    if (decoded != VP8_STATUS_OK) fail_image(name, fmt::format("damaged WebP: {}", status_of(decoded)));
    return image;
}

std::vector<std::byte> encode_webp(const Image& image, int quality) {
    if (image.width() > WEBP_MAX_DIMENSION || image.height() > WEBP_MAX_DIMENSION)
        throw ArgumentError(fmt::format("cannot encode WebP: {}x{} pixels, the format holds at most {}",
                                        image.width(), image.height(), WEBP_MAX_DIMENSION));
    if (image.channels() < 3) throw ArgumentError("cannot encode WebP: expected 3 or 4 channels");
    const auto encode = image.channels() == 4 ? WebPEncodeRGBA : WebPEncodeRGB;
    uint8_t* out = nullptr;
    const size_t size = encode(image.pixels<uint8_t>().data(), image.width(), image.height(),
                               int(image.row_bytes()), float(quality), &out);
    const std::unique_ptr<uint8_t, decltype(&WebPFree)> owner(out, WebPFree);
    if (size == 0) throw ArgumentError("cannot encode WebP: out of memory");
    const auto* begin = reinterpret_cast<const std::byte*>(out);
    return {begin, begin + size};
}

}  // namespace easypbr::io
