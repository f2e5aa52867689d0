// WebP pictures, made by libwebp's encoder.
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cmath>

#include "easypbr/core/file.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/io/image/image_io.h"
#include "io/fuzz.h"
#include "io/gltf_decoded.h"
#include "io/temporary_folder.h"

namespace easypbr::webp_test {

namespace {

Image picture(int channels) {
    Image image(21, 13, channels, PixelType::u8);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < channels; ++c) image.at<uint8_t>(x, y)[c] = uint8_t(6 * x + 4 * y + 20 * c);
    return image;
}

std::string lossless(const Image& image) {
    uint8_t* bytes = nullptr;
    const uint8_t* pixels = image.pixels<uint8_t>().data();
    const int w = image.width(), h = image.height();
    const size_t size = image.channels() == 4 ? WebPEncodeLosslessRGBA(pixels, w, h, 4 * w, &bytes)
                                              : WebPEncodeLosslessRGB(pixels, w, h, 3 * w, &bytes);
    std::string out(reinterpret_cast<char*>(bytes), size);
    WebPFree(bytes);
    return out;
}

std::string lossy(const Image& image) {
    uint8_t* bytes = nullptr;
    const size_t size = WebPEncodeRGB(image.pixels<uint8_t>().data(), image.width(), image.height(),
                                      3 * image.width(), 90, &bytes);
    std::string out(reinterpret_cast<char*>(bytes), size);
    WebPFree(bytes);
    return out;
}

std::string refusal(const std::string& bytes) {
    try {
        io::decode_image(as_span(bytes), "a.webp");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "accepted";
}

/// A textured triangle whose texture is WebP, beside a PNG of another colour for programs that cannot read
/// it.
GltfBuilder textured() {
    GltfBuilder builder;
    builder.triangle()["material"] = 0;
    const std::string webp = lossless(picture(4));
    const auto png = io::encode_png(Image(1, 1, 3, PixelType::u8));
    builder.json["images"] = {{{"bufferView", builder.view(png)}, {"mimeType", "image/png"}},
                              {{"bufferView", builder.view(std::vector<char>(webp.begin(), webp.end()))},
                               {"mimeType", "image/webp"}}};
    builder.json["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
    builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    return builder;
}

}  // namespace

TEST(WebP, IsReadAsItWasWritten) {
    for (const int channels : {3, 4}) {
        const Image image = picture(channels);
        const Image read = io::decode_image(as_span(lossless(image)), "a.webp");
        ASSERT_EQ(read.channels(), channels);
        ASSERT_EQ(read.width(), 21);
        EXPECT_TRUE(std::ranges::equal(read.pixels<uint8_t>(), image.pixels<uint8_t>()));
    }
}

TEST(WebP, IsReadFromAFileWithLossesToo) {
    const TemporaryFolder folder;
    const Image image = picture(3);
    write_file(folder / "a.webp", lossy(image));
    const Image read = io::load_image(folder / "a.webp");
    ASSERT_EQ(read.channels(), 3);
    double sum = 0;
    for (size_t i = 0; i < image.pixels<uint8_t>().size(); ++i)
        sum += std::abs(double(read.pixels<uint8_t>()[i]) - double(image.pixels<uint8_t>()[i]));
    EXPECT_LT(sum / double(image.pixels<uint8_t>().size()), 4);
}

TEST(WebP, RefusesBadInput) {
    const std::string good = lossless(picture(3));
    for (size_t size = 12; size < good.size(); size += 3)
        EXPECT_NE(refusal(good.substr(0, size)).find("damaged WebP"), std::string::npos) << size;
    // An extended header: animation, canvas of 16 x 16.
    const std::string animated =
        std::string("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\x0f\0\0\x0f\0\0", 30);
    EXPECT_EQ(refusal(animated), "cannot read a.webp: an animated WebP: expected a single picture");
    EXPECT_EQ(refusal("\xabKTX 20\xbb\r\n\x1a\n"),
              "cannot read a.webp: a KTX texture, which is not supported: expected PNG, JPEG or WebP");
    const MemoryScope scope("a.webp", 500);
    EXPECT_NE(refusal(good).find("the pixels of a.webp would take"), std::string::npos) << refusal(good);
}

TEST(WebP, SurvivesDamage) {
    const auto load = [](const std::string& bytes) { io::decode_image(as_span(bytes), "mutant"); };
    fuzz(lossless(picture(4)), load);
    fuzz(lossy(picture(3)), load);
}

TEST(WebP, IsPreferredByTexturesOfGltf) {
    const Texture texture = node(decode(textured())).materials.at(0).base_color_texture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture.image->width(), 21);
    EXPECT_EQ(texture.image->channels(), 4);
    GltfBuilder alone = textured();
    alone.json["textures"][0].erase("source");
    alone.json["extensionsRequired"] = {"EXT_texture_webp"};
    EXPECT_EQ(node(decode(alone)).materials.at(0).base_color_texture.image->width(), 21);
}

TEST(WebP, TexturesOfBasisUniversalAreDrawnByTheirFallbackAlone) {
    GltfBuilder builder = textured();
    nlohmann::json& texture = builder.json["textures"][0];
    texture["extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}};
    EXPECT_EQ(node(decode(builder)).materials.at(0).base_color_texture.image->width(), 1);
    texture.erase("source");
    const LogCapture log;
    EXPECT_FALSE(node(decode(builder)).materials.at(0).base_color_texture);
    EXPECT_NE(
        log.text.find("textures[0] has no PNG, JPEG or WebP image (KHR_texture_basisu is not supported)"),
        std::string::npos)
        << log.text;
}

}  // namespace easypbr::webp_test
