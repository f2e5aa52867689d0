#include <tinyexr.h>

#include <cmath>

#include "easypbr/core/file.h"
#include "easypbr/io/image/image_io.h"
#include "io/fuzz.h"
#include "io/temporary_folder.h"

namespace easypbr::fuzz_image_test {

namespace {

Image picture(PixelType type) {
    Image image(48, 40, 3, type);
    std::mt19937 random(5);
    if (type == PixelType::f32)
        for (float& v : image.pixels<float>()) v = std::ldexp(float(random() % 256), int(random() % 8) - 8);
    else
        for (std::byte& v : image.bytes()) v = std::byte(random() % 16);
    return image;
}

void fuzz_image(const std::string& extension, PixelType type) {
    const TemporaryFolder folder;
    io::save_image(picture(type), folder / ("a." + extension));
    const std::string good(FileBytes(folder / ("a." + extension)).text());
    fuzz(good, [](const std::string& bytes) {
        io::decode_image(std::as_bytes(std::span(bytes.data(), bytes.size())), "mutant");
    });
}

}  // namespace

TEST(FuzzImage, Png) {
    fuzz_image("png", PixelType::u8);
}
TEST(FuzzImage, Jpeg) {
    fuzz_image("jpg", PixelType::u8);
}
TEST(FuzzImage, Hdr) {
    fuzz_image("hdr", PixelType::f32);
}
TEST(FuzzImage, Exr) {
    fuzz_image("exr", PixelType::f32);
}

// save_image() writes ZIP; PIZ comes from another library.
TEST(FuzzImage, ExrPiz) {
    const TemporaryFolder folder;
    const Image noise = picture(PixelType::f32);
    std::vector<float> plane(noise.pixels<float>().begin(), noise.pixels<float>().begin() + 48 * 40);
    unsigned char* pointer = reinterpret_cast<unsigned char*>(plane.data());
    EXRChannelInfo info{};
    info.name[0] = 'Y';
    int given = TINYEXR_PIXELTYPE_FLOAT, stored = TINYEXR_PIXELTYPE_HALF;
    EXRHeader header;
    InitEXRHeader(&header);
    header.compression_type = TINYEXR_COMPRESSIONTYPE_PIZ;
    header.num_channels = 1;
    header.channels = &info;
    header.pixel_types = &given;
    header.requested_pixel_types = &stored;
    EXRImage image;
    InitEXRImage(&image);
    image.images = &pointer;
    image.width = 48;
    image.height = 40;
    image.num_channels = 1;
    const char* message = nullptr;
    ASSERT_EQ(SaveEXRImageToFile(&image, &header, (folder / "a.exr").c_str(), &message), TINYEXR_SUCCESS);
    const std::string good(FileBytes(folder / "a.exr").text());
    fuzz(good, [](const std::string& bytes) {
        io::decode_image(std::as_bytes(std::span(bytes.data(), bytes.size())), "mutant");
    });
}

}  // namespace easypbr::fuzz_image_test
