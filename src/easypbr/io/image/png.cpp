#include <fmt/format.h>
#include <spng.h>

#include <cstdlib>
#include <memory>

#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"

namespace easypbr::io {
namespace {

/// Deflate makes at most 1032 bytes of one; the rest is room for 1-bit pixels becoming bytes.
constexpr size_t most_png_bytes_per_byte = 1032 * 32;

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

struct Layout {
    int format;
    int channels;
    PixelType type;
};

/// What the pixels are decoded to: the file's own channels, palette and bit depths below 8 expanded, a
/// transparent colour turned into alpha.
Layout layout_of(const spng_ihdr& header, bool transparent_color) {
    const bool deep = header.bit_depth == 16;
    const PixelType type = deep ? PixelType::u16 : PixelType::u8;
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_GRAYSCALE:
            if (transparent_color) return {deep ? SPNG_FMT_GA16 : SPNG_FMT_GA8, 2, type};
            return {deep ? SPNG_FMT_PNG : SPNG_FMT_G8, 1, type};
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return {SPNG_FMT_PNG, 2, type};
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return {SPNG_FMT_PNG, 4, type};
        default:
            if (transparent_color) return {deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, 4, type};
            return {deep ? SPNG_FMT_PNG : SPNG_FMT_RGB8, 3, type};
    }
}

void check(int error, const std::string& name) {
    if (error) fail_image(name, fmt::format("damaged PNG: {}", spng_strerror(error)));
}

void check_png_encode(int error) {
    if (error) throw ArgumentError(fmt::format("cannot encode PNG: {}", spng_strerror(error)));
}

}  // namespace

Image decode_png(Bytes bytes, const std::string& name) {
    const Context context(spng_ctx_new(0), spng_ctx_free);
    check(spng_set_image_limits(context.get(), max_image_side, max_image_side), name);
    check(spng_set_chunk_limits(context.get(), size_t(1) << 26, size_t(1) << 27), name);
    check(spng_set_png_buffer(context.get(), bytes.data(), bytes.size()), name);
    spng_ihdr header{};
    check(spng_get_ihdr(context.get(), &header), name);
    check_image_size(header.width, header.height, name);

    spng_trns transparency{};
    const bool transparent_color = spng_get_trns(context.get(), &transparency) == 0;
    const Layout layout = layout_of(header, transparent_color);
    check_plausible(size_t(header.width) * header.height * layout.channels * size_of(layout.type),
                    bytes.size(), most_png_bytes_per_byte, name);
    Image image = make_image(int(header.width), int(header.height), layout.channels, layout.type, name);
    size_t expected = 0;
    check(spng_decoded_image_size(context.get(), layout.format, &expected), name);
    if (expected != image.bytes().size())
        fail_image(name, "damaged PNG: unexpected size of the decoded image");
    check(spng_decode_image(context.get(), image.bytes().data(), expected, layout.format,
                            transparent_color ? SPNG_DECODE_TRNS : 0),
          name);
    return image;
}

std::vector<std::byte> encode_png(const Image& image) {
    if (image.empty()) throw ArgumentError("cannot encode PNG: the image is empty");
    if (image.type() == PixelType::f32)
        throw ArgumentError("cannot encode PNG: expected u8 or u16 pixels, got f32");
    constexpr spng_color_type color_types[] = {SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA,
                                               SPNG_COLOR_TYPE_TRUECOLOR, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    const Context context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
    check_png_encode(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1));
    // Rendered pictures are smooth: one cheap filter and the fastest level give nearly the size of the slow
    // ones.
    check_png_encode(spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, 1));
    check_png_encode(spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_UP));
    spng_ihdr header{};
    header.width = uint32_t(image.width());
    header.height = uint32_t(image.height());
    header.color_type = color_types[image.channels() - 1];
    header.bit_depth = uint8_t(8 * size_of(image.type()));
    check_png_encode(spng_set_ihdr(context.get(), &header));
    check_png_encode(spng_encode_image(context.get(), image.bytes().data(), image.bytes().size(),
                                       SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE));
    size_t size = 0;
    int error = 0;
    const std::unique_ptr<void, decltype(&std::free)> data(spng_get_png_buffer(context.get(), &size, &error),
                                                           std::free);
    check_png_encode(error);
    const auto* begin = static_cast<const std::byte*>(data.get());
    return {begin, begin + size};
}

}  // namespace easypbr::io
