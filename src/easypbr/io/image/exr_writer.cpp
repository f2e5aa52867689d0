#include <fmt/format.h>
#include <tinyexr.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "easypbr/io/image/image_codecs.h"

namespace easypbr::io {
namespace {

void check_exr_encode(bool good, const char* message) {
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

/// Planes of 32-bit samples with the names of their channels, which the format sorts by name.
struct ExrPlanes {
    Vec2i size;
    int type;  ///< of tinyexr
    std::vector<const char*> names;
    std::vector<unsigned char*> samples;
};

std::vector<std::byte> encode_planes(ExrPlanes planes) {
    std::vector<EXRChannelInfo> infos(planes.names.size());
    for (size_t c = 0; c < infos.size(); ++c) std::strcpy(infos[c].name, planes.names[c]);
    std::vector<int> types(infos.size(), planes.type);

    EXRHeader header;
    InitEXRHeader(&header);
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
    header.num_channels = int(infos.size());
    header.channels = infos.data();
    header.pixel_types = header.requested_pixel_types = types.data();
    EXRImage picture;
    InitEXRImage(&picture);
    picture.images = planes.samples.data();
    picture.width = planes.size.x();
    picture.height = planes.size.y();
    picture.num_channels = int(infos.size());

    unsigned char* buffer = nullptr;
    const char* message = nullptr;
    const size_t size = SaveEXRImageToMemory(&picture, &header, &buffer, &message);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(buffer, std::free);
    check_exr_encode(size > 0, message);
    const auto* begin = reinterpret_cast<const std::byte*>(buffer);
    return {begin, begin + size};
}

}  // namespace

std::vector<std::byte> encode_exr(const Image& image) {
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
    std::vector<unsigned char*> samples;
    for (std::vector<float>& plane : planes)
        samples.push_back(reinterpret_cast<unsigned char*>(plane.data()));
    return encode_planes({{image.width(), image.height()}, TINYEXR_PIXELTYPE_FLOAT, channels.names, samples});
}

std::vector<std::byte> encode_exr(std::vector<int32_t> values, Vec2i size) {
    return encode_planes(
        {size, TINYEXR_PIXELTYPE_UINT, {"Y"}, {reinterpret_cast<unsigned char*>(values.data())}});
}

}  // namespace easypbr::io
