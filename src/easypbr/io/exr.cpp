#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyexr.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "easypbr/io/image_codecs.h"

namespace easypbr::io {
namespace {

/// ZIP makes at most 1032 bytes of one, then halves become floats.
constexpr size_t most_bytes_per_byte = 1032 * 2;
/// The decoder counts bytes of a plane in 32 bits.
constexpr size_t most_pixels = size_t(1) << 28;

struct HeaderOwner {
    HeaderOwner() { InitEXRHeader(&value); }
    ~HeaderOwner() { FreeEXRHeader(&value); }
    HeaderOwner(const HeaderOwner&) = delete;
    EXRHeader value;
};

struct ImageOwner {
    ImageOwner() { InitEXRImage(&value); }
    ~ImageOwner() { FreeEXRImage(&value); }
    ImageOwner(const ImageOwner&) = delete;
    EXRImage value;
};

void check(int result, const char* message, const std::string& name) {
    if (result == TINYEXR_SUCCESS) return;
    const std::string what = message ? message : fmt::format("code {}", result);
    FreeEXRErrorMessage(message);
    fail_image(name, fmt::format("damaged or unsupported EXR: {}", what));
}

const unsigned char* data_of(Bytes bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

void read_header(Bytes bytes, const std::string& name, EXRHeader& header) {
    EXRVersion version{};
    check(ParseEXRVersionFromMemory(&version, data_of(bytes), bytes.size()), nullptr, name);
    if (version.multipart || version.non_image)
        fail_image(name, "EXR with several parts or deep pixels: only single-part flat pictures are read");
    const char* message = nullptr;
    check(ParseEXRHeaderFromMemory(&header, &version, data_of(bytes), bytes.size(), &message), message, name);
    for (int c = 0; c < header.num_channels; ++c) {
        if (header.channels[c].x_sampling != 1 || header.channels[c].y_sampling != 1)
            fail_image(name, fmt::format("EXR with subsampled channel '{}': not supported",
                                         header.channels[c].name));
        if (header.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
            header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
    }
}

void check_header(Bytes bytes, const std::string& name, const EXRHeader& header) {
    const long long width = (long long)header.data_window.max_x - header.data_window.min_x + 1;
    const long long height = (long long)header.data_window.max_y - header.data_window.min_y + 1;
    check_image_size(width, height, name);
    const size_t pixels = size_t(width) * size_t(height);
    if (pixels > most_pixels)
        fail_image(name, fmt::format("EXR of {}x{} pixels: at most {} are read", width, height, most_pixels));
    check_plausible(pixels * 4 * size_t(std::max(header.num_channels, 1)), bytes.size(), most_bytes_per_byte,
                    name);
    if (header.tiled && (header.tile_size_x < 1 || header.tile_size_y < 1 ||
                         header.tile_size_x > max_image_side || header.tile_size_y > max_image_side))
        fail_image(name,
                   fmt::format("damaged EXR: tiles of {}x{} pixels", header.tile_size_x, header.tile_size_y));
    if (header.tiled)
        check_plausible(size_t(header.tile_size_x) * header.tile_size_y * 4, bytes.size(),
                        most_bytes_per_byte, name);
}

int channel_named(const EXRHeader& header, const char* wanted) {
    for (int c = 0; c < header.num_channels; ++c)
        if (std::strcmp(header.channels[c].name, wanted) == 0) return c;
    return -1;
}

/// Indices of the channels that make the picture: RGB or Y, and A where there is one; else the only channel.
std::vector<int> picture_channels(const EXRHeader& header, const std::string& name) {
    std::vector<int> chosen;
    for (const char* wanted : {"R", "G", "B"}) chosen.push_back(channel_named(header, wanted));
    if (std::count(chosen.begin(), chosen.end(), -1) > 0) chosen = {channel_named(header, "Y")};
    if (chosen[0] >= 0) {
        if (const int alpha = channel_named(header, "A"); alpha >= 0) chosen.push_back(alpha);
        return chosen;
    }
    if (header.num_channels == 1) return {0};
    std::vector<std::string> names;
    for (int c = 0; c < header.num_channels; ++c) names.emplace_back(header.channels[c].name);
    fail_image(name, fmt::format("EXR without channels R, G, B or Y (it has {})", fmt::join(names, ", ")));
}

float value_at(const unsigned char* plane, size_t index, bool integer) {
    float value;
    uint32_t bits;
    std::memcpy(&bits, plane + 4 * index, 4);
    std::memcpy(&value, &bits, 4);
    return integer ? float(bits) : value;
}

/// Copies the part of a block of `stride` x `rows` pixels that lies inside the picture, its corner at (x0,
/// y0).
void copy_block(unsigned char* const* planes, const EXRHeader& header, const std::vector<int>& chosen,
                int stride, int rows, long long x0, long long y0, Image& image) {
    if (!planes || x0 < 0 || y0 < 0) return;
    const int width = int(std::min<long long>(stride, image.width() - x0));
    const int height = int(std::min<long long>(rows, image.height() - y0));
    for (size_t c = 0; c < chosen.size(); ++c) {
        const unsigned char* plane = planes[chosen[c]];
        if (!plane) continue;
        const bool integer = header.pixel_types[chosen[c]] == TINYEXR_PIXELTYPE_UINT;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image.at<float>(int(x0) + x, int(y0) + y)[c] =
                    value_at(plane, size_t(y) * size_t(stride) + size_t(x), integer);
    }
}

void check_encode(bool good, const char* message) {
    if (good) return;
    const std::string what = message ? message : "unknown reason";
    FreeEXRErrorMessage(message);
    throw ArgumentError(fmt::format("cannot encode EXR: {}", what));
}

/// One plane of floats for each channel of the picture, in the order of `channels`.
std::vector<std::vector<float>> planes_of(const Image& image, const std::vector<int>& channels) {
    std::vector<std::vector<float>> planes;
    const float* pixels = image.pixels<float>().data();
    for (const int channel : channels) {
        std::vector<float>& plane = planes.emplace_back(image.pixel_count());
        for (size_t i = 0; i < plane.size(); ++i)
            plane[i] = pixels[i * size_t(image.channels()) + size_t(channel)];
    }
    return planes;
}

}  // namespace

Image decode_exr(Bytes bytes, const std::string& name) {
    HeaderOwner header;
    read_header(bytes, name, header.value);
    check_header(bytes, name, header.value);
    const std::vector<int> chosen = picture_channels(header.value, name);
    ImageOwner decoded;
    const char* message = nullptr;
    check(LoadEXRImageFromMemory(&decoded.value, &header.value, data_of(bytes), bytes.size(), &message),
          message, name);

    check_image_size(decoded.value.width, decoded.value.height, name);
    Image image(decoded.value.width, decoded.value.height, int(chosen.size()), PixelType::f32);
    if (!header.value.tiled) {
        copy_block(decoded.value.images, header.value, chosen, image.width(), image.height(), 0, 0, image);
        return image;
    }
    const int tile_width = header.value.tile_size_x, tile_height = header.value.tile_size_y;
    for (int t = 0; t < decoded.value.num_tiles; ++t) {
        const EXRTile& tile = decoded.value.tiles[t];
        copy_block(tile.images, header.value, chosen, tile_width, tile_height,
                   (long long)tile.offset_x * tile_width, (long long)tile.offset_y * tile_height, image);
    }
    return image;
}

std::vector<std::byte> encode_exr(const Image& image) {
    // The format sorts channels by name.
    struct Channels {
        std::vector<const char*> names;
        std::vector<int> indices;
    };
    static const Channels layouts[] = {{{"Y"}, {0}},
                                       {{"A", "Y"}, {1, 0}},
                                       {{"B", "G", "R"}, {2, 1, 0}},
                                       {{"A", "B", "G", "R"}, {3, 2, 1, 0}}};
    const Channels& channels = layouts[image.channels() - 1];
    std::vector<std::vector<float>> planes = planes_of(image, channels.indices);
    std::vector<unsigned char*> pointers;
    for (std::vector<float>& plane : planes)
        pointers.push_back(reinterpret_cast<unsigned char*>(plane.data()));
    std::vector<EXRChannelInfo> infos(planes.size());
    for (size_t c = 0; c < infos.size(); ++c) std::strcpy(infos[c].name, channels.names[c]);
    std::vector<int> types(planes.size(), TINYEXR_PIXELTYPE_FLOAT);

    EXRHeader header;
    InitEXRHeader(&header);
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    header.num_channels = image.channels();
    header.channels = infos.data();
    header.pixel_types = header.requested_pixel_types = types.data();
    EXRImage picture;
    InitEXRImage(&picture);
    picture.images = pointers.data();
    picture.width = image.width();
    picture.height = image.height();
    picture.num_channels = image.channels();

    unsigned char* buffer = nullptr;
    const char* message = nullptr;
    const size_t size = SaveEXRImageToMemory(&picture, &header, &buffer, &message);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(buffer, std::free);
    check_encode(size > 0, message);
    const auto* begin = reinterpret_cast<const std::byte*>(buffer);
    return {begin, begin + size};
}

}  // namespace easypbr::io
