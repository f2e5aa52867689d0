#include <cmath>

#include "easypbr/core/file.h"
#include "easypbr/io/image_io.h"
#include "io/fuzz.h"
#include "io/temporary_folder.h"

using namespace easypbr;

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
    const std::string good(MappedFile(folder / ("a." + extension)).text());
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
