// PNG, JPEG and EXR pictures, and files of every format.
#include <gtest/gtest.h>
#include <spng.h>
#include <tinyexr.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/environment.h"
#include "io/bytes.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"
#include "test_data.h"

namespace easypbr::image_test {

namespace {

Image noise(int width, int height, int channels, PixelType type, unsigned seed = 7) {
    Image image(width, height, channels, type);
    std::mt19937 random(seed);
    if (type == PixelType::f32)
        for (float& v : image.pixels<float>())
            v = std::ldexp(float(random() % 4096), int(random() % 20) - 14);
    else
        for (std::byte& v : image.bytes()) v = std::byte(random());
    return image;
}

/// A PNG of any kind, by libspng directly.
std::vector<std::byte> png_of_kind(uint8_t color_type, uint8_t depth, uint32_t width, uint32_t height,
                                   const std::vector<uint8_t>& rows, const spng_plte* palette,
                                   const spng_trns* trns) {
    spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
    spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
    spng_ihdr header{width, height, depth, color_type, 0, 0, 0};
    spng_set_ihdr(context, &header);
    spng_plte plte = palette ? *palette : spng_plte{};
    if (palette) spng_set_plte(context, &plte);
    spng_trns transparency = trns ? *trns : spng_trns{};
    if (trns) spng_set_trns(context, &transparency);
    EXPECT_EQ(spng_encode_image(context, rows.data(), rows.size(), SPNG_FMT_RAW, SPNG_ENCODE_FINALIZE), 0);
    size_t size = 0;
    int error = 0;
    void* data = spng_get_png_buffer(context, &size, &error);
    std::vector<std::byte> out(static_cast<std::byte*>(data), static_cast<std::byte*>(data) + size);
    free(data);
    spng_ctx_free(context);
    return out;
}

}  // namespace

TEST(Png, RoundTripsEveryChannelCountAndDepthBitForBit) {
    for (const PixelType type : {PixelType::u8, PixelType::u16})
        for (int channels = 1; channels <= 4; ++channels) {
            const Image image = noise(37, 21, channels, type);
            EXPECT_TRUE(same_bits(io::decode_image(io::encode_png(image), "x"), image)) << channels;
        }
}

TEST(Png, ExpandsAPaletteWithTransparency) {
    spng_plte palette{};
    palette.n_entries = 2;
    palette.entries[0] = {10, 20, 30, 255};
    palette.entries[1] = {200, 100, 50, 255};
    spng_trns trns{};
    trns.n_type3_entries = 2;
    trns.type3_alpha[0] = 255;
    trns.type3_alpha[1] = 64;
    // 4-bit indices 0, 1 in one byte.
    const Image image = io::decode_image(png_of_kind(3, 4, 2, 1, {0x01}, &palette, &trns), "x");
    ASSERT_EQ(image.channels(), 4);
    const uint8_t expected[] = {10, 20, 30, 255, 200, 100, 50, 64};
    EXPECT_EQ(std::memcmp(image.pixels<uint8_t>().data(), expected, 8), 0);
}

TEST(Png, ScalesOneBitGreyToTheWholeRange) {
    const Image image = io::decode_image(png_of_kind(0, 1, 8, 1, {0b10100000}, nullptr, nullptr), "x");
    ASSERT_EQ(image.channels(), 1);
    EXPECT_EQ(image.pixels<uint8_t>()[0], 255);
    EXPECT_EQ(image.pixels<uint8_t>()[1], 0);
    EXPECT_EQ(image.pixels<uint8_t>()[2], 255);
}

TEST(Png, WritesFloatsAsSrgb) {
    const TemporaryFolder folder;
    Image image(1, 1, 3, PixelType::f32);
    image.pixels<float>()[0] = 0.5f;
    image.pixels<float>()[1] = 2.0f;
    image.pixels<float>()[2] = -1.0f;
    io::save_image(image, folder / "a.png");
    const Image read = io::load_image(folder / "a.png");
    // sRGB of 0.5 is 0.73536 (IEC 61966-2-1), times 255 is 187.5; 2 and -1 are clamped.
    EXPECT_NEAR(read.pixels<uint8_t>()[0], 187.5, 0.6);
    EXPECT_EQ(read.pixels<uint8_t>()[1], 255);
    EXPECT_EQ(read.pixels<uint8_t>()[2], 0);
}

TEST(Jpeg, KeepsAGradientWithinItsQuantisation) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3}) {
        Image image(64, 48, channels, PixelType::u8);
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < channels; ++c) image.at<uint8_t>(x, y)[c] = uint8_t(2 * x + c * 40 + y);
        io::save_image(image, folder / "a.jpg");
        const Image read = io::load_image(folder / "a.jpg");
        ASSERT_EQ(read.channels(), channels);
        // Quality 95 quantises by steps of at most 12; a ramp's few coefficients give errors of a few codes.
        EXPECT_LE(compare(read, image).max, 6);
    }
}

TEST(Jpeg, TurnsCmykIntoRgb) {
    // A constant plain CMYK picture without Adobe's marker: ink c = 255, k = 0 leaves no red.
    std::vector<uint8_t> cmyk;
    for (int i = 0; i < 16 * 16; ++i) cmyk.insert(cmyk.end(), {255, 0, 128, 0});
    tjhandle handle = tjInitCompress();
    unsigned char* data = nullptr;
    unsigned long size = 0;
    ASSERT_EQ(tjCompress2(handle, cmyk.data(), 16, 0, 16, TJPF_CMYK, &data, &size, TJSAMP_444, 100, 0), 0);
    std::vector<std::byte> bytes(reinterpret_cast<std::byte*>(data),
                                 reinterpret_cast<std::byte*>(data) + size);
    tjFree(data);
    tjDestroy(handle);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool inverted = text.find("Adobe") != std::string::npos;
    const Image image = io::decode_image(bytes, "x");
    ASSERT_EQ(image.channels(), 3);
    const uint8_t* p = image.pixels<uint8_t>().data();
    // Inverted CMYK has key 0 = black, so everything is black; YCCK rounding gives a code or two.
    const int expected[] = {0, inverted ? 0 : 255, inverted ? 0 : 127};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], expected[c], 3) << c;
}

TEST(Exr, RoundTripsBitForBit) {
    const TemporaryFolder folder;
    for (int channels = 1; channels <= 4; ++channels) {
        const Image image = noise(33, 40, channels, PixelType::f32);
        io::save_image(image, folder / "a.exr");
        EXPECT_TRUE(same_bits(io::load_image(folder / "a.exr"), image)) << channels;
    }
}

TEST(Exr, ReadsHalvesAndFloatsUnderEveryCompression) {
    // Written by another library; odd sizes reach the borders of the wavelet and of the blocks of lines.
    const TemporaryFolder folder;
    constexpr int width = 61, height = 75;
    std::mt19937 random(11);
    std::vector<float> planes[3];
    unsigned char* pointers[3];
    for (int c = 0; c < 3; ++c) {
        // Multiples of 1/64 below 8, with runs: exact in half precision.
        for (int i = 0; i < width * height; ++i)
            planes[c].push_back(i % 3 && i > 0 ? planes[c].back() : float(random() % 512) / 64 - 2);
        pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
    }
    for (const int compression :
         {TINYEXR_COMPRESSIONTYPE_NONE, TINYEXR_COMPRESSIONTYPE_RLE, TINYEXR_COMPRESSIONTYPE_ZIPS,
          TINYEXR_COMPRESSIONTYPE_ZIP, TINYEXR_COMPRESSIONTYPE_PIZ}) {
        EXRChannelInfo infos[3] = {};
        for (int c = 0; c < 3; ++c) infos[c].name[0] = "BGR"[c];
        int given[3] = {TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT};
        int stored[3] = {TINYEXR_PIXELTYPE_HALF, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_HALF};
        EXRHeader header;
        InitEXRHeader(&header);
        header.compression_type = compression;
        header.num_channels = 3;
        header.channels = infos;
        header.pixel_types = given;
        header.requested_pixel_types = stored;
        EXRImage picture;
        InitEXRImage(&picture);
        picture.images = pointers;
        picture.width = width;
        picture.height = height;
        picture.num_channels = 3;
        const char* message = nullptr;
        ASSERT_EQ(SaveEXRImageToFile(&picture, &header, (folder / "a.exr").c_str(), &message),
                  TINYEXR_SUCCESS);
        const Image image = io::load_image(folder / "a.exr");
        ASSERT_EQ(image.channels(), 3);
        ASSERT_EQ(image.width(), width);
        size_t wrong = 0;
        for (size_t i = 0; i < image.pixel_count(); ++i)
            for (size_t c = 0; c < 3; ++c) wrong += image.pixels<float>()[3 * i + c] != planes[2 - c][i];
        EXPECT_EQ(wrong, 0u) << "compression " << compression;
    }
}

TEST(ImageFiles, RealFilesHaveTheirSizes) {
    REQUIRE_TEST_DATA();
    struct Row {
        const char* file;
        int width, height, channels;
    };
    for (const Row& row :
         {Row{"env/monument_valley.hdr", 1600, 800, 3}, Row{"env/studio.hdr", 1440, 720, 3},
          Row{"spot.png", 774, 616, 4}, Row{"DamagedHelmet/Default_albedo.jpg", 2048, 2048, 3}}) {
        const Image image = io::load_image(test_data(row.file));
        EXPECT_EQ(image.width(), row.width) << row.file;
        EXPECT_EQ(image.height(), row.height) << row.file;
        EXPECT_EQ(image.channels(), row.channels) << row.file;
    }
}

TEST(ImageFiles, RefusesBadInput) {
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    const std::vector<std::pair<std::string, std::string>> table = {
        {"", "empty"},
        {"hello", "no known image format"},
        {"\x89PNG\r\n\x1a\n", "damaged PNG"},
        {"\xff\xd8\xff\xe0", "image size 0x0"},
        {"#?RADIANCE\n", "no end"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "xyze"},
        {hdr + "+X 1 +Y 1\nabcd", "axes"},
        {hdr + "nonsense\nabcd", "resolution"},
        {hdr + "-Y 0 +X 1\nabcd", "size"},
        {hdr + "-Y 99999999999 +X 1\nabcd", "size"},
        {hdr + "-Y 65536 +X 65536\nabcd", "truncated"},
        {hdr + "-Y 1 +X 2\n\1\1\1\2", "run without a pixel"},
        {hdr + "-Y 1 +X 8\n" + std::string("\2\2\0\11\x88\1\x88\1\x88\1\x88\1", 12), "another width"},
        {hdr + "-Y 1 +X 8\n" + std::string("\2\2\0\10\x89\1", 6), "wrong length"},
        {std::string("\x76\x2f\x31\x01\2\0\0\0", 8), "EXR"},
    };
    for (const auto& [content, expected] : table) try {
            io::decode_image(as_span(content), "the-file");
            ADD_FAILURE() << "accepted: " << expected;
        } catch (const FormatError& error) {
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("the-file"), std::string::npos) << error.what();
        }
}

TEST(ImageFiles, RefusesEveryTruncation) {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "a.jpg", "a.hdr", "a.exr"}) {
        const bool coded = extension_of(name) == "png" || extension_of(name) == "jpg";
        io::save_image(noise(40, 40, 3, coded ? PixelType::u8 : PixelType::f32), folder / name);
        const FileBytes file(folder / name);
        // The last 12 bytes of a PNG (IEND) and the last 2 of a JPEG (EOI) hold no pixels.
        for (size_t size = 0; size + 16 < file.size(); size += std::max<size_t>(1, file.size() / 97))
            EXPECT_THROW(io::decode_image(file.bytes().first(size), name), FormatError)
                << name << " " << size;
    }
}

TEST(ImageFiles, RefusesALyingPngHeader) {
    // A valid header (its checksum too) of 65536 x 65536 pixels in front of a handful of bytes.
    std::vector<std::byte> bytes =
        png_of_kind(2, 8, 65536, 1, std::vector<uint8_t>(65536 * 3), nullptr, nullptr);
    ASSERT_NO_THROW(io::decode_image(bytes, "x"));
    bytes[20] = bytes[21] = bytes[22] = std::byte(0);
    bytes[21] = std::byte(1);
    bytes[23] = std::byte(0);
    EXPECT_THROW(io::decode_image(bytes, "x"), FormatError);
}

// Half covered, colour 1: 1 in codes, 0.5 in floats. 128 / 255 is what 8 bits make of one half.
TEST(ImageFiles, ConvertAlphaBetweenStraightAndPremultiplied) {
    const TemporaryFolder folder;
    Image linear(1, 1, 4, PixelType::f32);
    std::ranges::fill(linear.pixels<float>(), 0.5f);
    io::save_image(linear, folder / "a.png");
    const Image png = io::load_image(folder / "a.png");
    const auto codes = png.pixels<uint8_t>();
    EXPECT_EQ(std::vector<int>(codes.begin(), codes.end()), (std::vector<int>{255, 255, 255, 128}));
    io::save_image(png, folder / "a.exr");
    const Image exr = io::load_image(folder / "a.exr");
    for (const float value : exr.pixels<float>()) EXPECT_EQ(value, 128 / 255.0f);
}

TEST(ImageFiles, RefusesTransparencyWhereThereIsNoAlpha) {
    const TemporaryFolder folder;
    for (const char* name : {"a.jpg", "a.jpeg", "a.hdr"}) {
        for (const PixelType type : {PixelType::u8, PixelType::u16, PixelType::f32})
            EXPECT_THROW(io::save_image(Image(2, 2, 4, type), folder / name), ArgumentError) << name;
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
    }
    Image opaque(2, 2, 4, PixelType::u8);
    std::ranges::fill(opaque.pixels<uint8_t>(), uint8_t(255));
    EXPECT_NO_THROW(io::save_image(opaque, folder / "a.jpg"));
    EXPECT_NO_THROW(io::save_image(opaque, folder / "a.hdr"));
}

TEST(ImageFiles, RefusesWhatItCannotWrite) {
    const TemporaryFolder folder;
    const Image image = noise(2, 2, 3, PixelType::u8);
    EXPECT_THROW(io::save_image(image, folder / "a.bmp"), ArgumentError);
    EXPECT_THROW(io::save_image(Image(), folder / "a.png"), ArgumentError);
    EXPECT_THROW(io::save_image(image, folder / "missing" / "a.png"), FileError);
    EXPECT_THROW(io::load_image(folder / "missing.png"), FileError);
    EXPECT_THROW(io::load_image(folder.path()), FileError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(EnvironmentFile, IsReadAsLinear) {
    const TemporaryFolder folder;
    Image image(2, 1, 3, PixelType::u8);
    for (uint8_t& v : image.pixels<uint8_t>()) v = 188;
    io::save_image(image, folder / "a.png");
    const Environment environment(folder / "a.png");
    ASSERT_EQ(environment.image().type(), PixelType::f32);
    // 188/255 = 0.73725 is sRGB of 0.50289 (inverse of IEC 61966-2-1).
    EXPECT_NEAR(environment.image().pixels<float>()[0], 0.50289f, 1e-4);
}

}  // namespace easypbr::image_test
