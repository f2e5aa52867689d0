#include <fmt/format.h>
#include <gtest/gtest.h>
#include <spng.h>
#include <tinyexr.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "easypbr/scene/environment.h"
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

bool same(const Image& a, const Image& b) {
    return a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels() &&
           a.type() == b.type() && std::memcmp(a.bytes().data(), b.bytes().data(), a.bytes().size()) == 0;
}

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

/// A number of TIFF, little-endian ("II") or big-endian ("MM").
std::string tiff_number(unsigned value, int bytes, bool little) {
    std::string text;
    for (int i = 0; i < bytes; ++i) {
        const int place = little ? i : bytes - 1 - i;
        text += char(value >> (8 * place) & 0xff);
    }
    return text;
}

/// An EXIF block with the tags of width and orientation, as a type of TIFF (3: 16 bits, 4: 32).
std::string exif_of(unsigned orientation, bool little, unsigned type = 3) {
    const auto n = [&](unsigned value, int bytes) { return tiff_number(value, bytes, little); };
    const int bytes = type == 3 ? 2 : 4;
    std::string text = std::string("Exif\0\0", 6) + (little ? "II" : "MM");
    text += n(42, 2) + n(8, 4) + n(2, 2);
    text += n(0x100, 2) + n(4, 2) + n(1, 4) + n(24, 4);
    text += n(0x112, 2) + n(type, 2) + n(1, 4) + n(orientation, bytes) + std::string(size_t(4 - bytes), '\0');
    return text + n(0, 4);
}

/// 24 x 16 pixels: blocks of 8 x 8, each of one grey.
Image grey_blocks() {
    Image image(24, 16, 1, PixelType::u8);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) *image.at<uint8_t>(x, y) = uint8_t(20 + 40 * (x / 8 + 3 * (y / 8)));
    return image;
}

/// A JPEG file with a segment APP1 behind its first marker.
std::string with_app1(const std::vector<std::byte>& jpeg, const std::string& content) {
    std::string file(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
    return file.insert(2, "\xff\xe1" + tiff_number(unsigned(content.size() + 2), 2, false) + content);
}

Image upright_file(const std::string& jpeg) {
    const TemporaryFolder folder;
    write_file(folder / "a.jpg", bytes_of(jpeg));
    return io::load_upright_image(folder / "a.jpg");
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
            EXPECT_TRUE(same(io::decode_image(io::encode_png(image), "x"), image)) << channels;
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

TEST(Hdr, ReadsAPixelExactly) {
    // (128, 64, 1) with exponent byte 129: mantissa * 2^(129 - 136), nothing added.
    const Image image =
        io::decode_image(bytes_of(std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                                  std::string("\x80\x40\x01\x81\0\0\0\0", 8)),
                         "x");
    ASSERT_EQ(image.type(), PixelType::f32);
    ASSERT_EQ(image.channels(), 3);
    const float expected[] = {1.0f, 0.5f, 1.0f / 128, 0, 0, 0};
    for (int i = 0; i < 6; ++i) EXPECT_EQ(image.pixels<float>()[i], expected[i]);
}

TEST(Hdr, ReadsOldRuns) {
    // One pixel, a run of 2, then two runs in a row: 1 + 0 * 256: the second counts in units of 256.
    const std::string header = "#?RADIANCE\nEXPOSURE=2\n\n-Y 1 +X 260\n";
    const std::string pixel = "\x80\x80\x80\x81", run3("\1\1\1\3", 4), run1x256("\1\1\1\1", 4);
    const Image image = io::decode_image(bytes_of(header + pixel + run3 + run1x256), "x");
    ASSERT_EQ(image.width(), 260);
    // Exposure 2: the stored value is twice the radiance.
    for (const float v : image.pixels<float>()) ASSERT_EQ(v, 0.5f);
}

TEST(Hdr, TakesAnExposureOfZeroForNone) {
    const Image image = io::decode_image(bytes_of("#?RGBE\nEXPOSURE=0\n\n-Y 1 +X 1\n\x80\x40\x20\x81"), "x");
    EXPECT_EQ(image.pixels<float>()[0], 1.0f);
}

TEST(Hdr, ReadsComponentRunsAndFlips) {
    const std::string row1 = std::string("\2\2\0\10", 4) + "\x88\x80" + "\x88\x40" + "\x88\x20" + "\x88\x81";
    const std::string row2 = std::string("\2\2\0\10", 4) + std::string("\10\1\2\3\4\5\6\7\10", 9) +
                             "\x88\x40" + "\x88\x20" + "\x88\x88";
    const Image image = io::decode_image(bytes_of("#?RGBE\n\n+Y 2 -X 8\n" + row1 + row2), "x");
    // +Y: the file's first row is the lowest; -X: its first pixel is the rightmost.
    EXPECT_EQ(image.at<float>(0, 1)[0], 1.0f);
    EXPECT_EQ(image.at<float>(7, 0)[0], 1.0f);
    EXPECT_EQ(image.at<float>(0, 0)[0], 8.0f);
}

TEST(Hdr, RoundTripsWhatItRead) {
    Image image = io::decode_image(bytes_of("#?RGBE\n\n-Y 1 +X 1\n\x80\x40\x20\x81"), "x");
    const TemporaryFolder folder;
    for (const int width : {3, 8, 300, 40000}) {
        Image picture(width, 3, 3, PixelType::f32);
        std::mt19937 random(3);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < width; ++x) {
                const float scale = std::ldexp(1.0f, int(random() % 200) - 110);
                const bool copy = x > 0 && random() % 2;
                for (int c = 0; c < 3; ++c)
                    picture.at<float>(x, y)[c] =
                        copy ? picture.at<float>(x - 1, y)[c]
                             : float(c ? random() % 256 : 128 + random() % 128) * scale;
            }
        io::save_image(picture, folder / "a.hdr");
        EXPECT_TRUE(same(io::load_image(folder / "a.hdr"), picture)) << width;
    }
}

TEST(Hdr, WritesOddValues) {
    const TemporaryFolder folder;
    Image image(1, 2, 3, PixelType::f32);
    const float values[] = {std::numeric_limits<float>::quiet_NaN(), -3, 1,
                            std::numeric_limits<float>::infinity(),  0,  0.9999f};
    std::copy(values, values + 6, image.pixels<float>().data());
    io::save_image(image, folder / "a.hdr");
    const Image read = io::load_image(folder / "a.hdr");
    const float* p = read.pixels<float>().data();
    EXPECT_EQ(p[0], 0);
    EXPECT_EQ(p[1], 0);
    EXPECT_EQ(p[2], 1);
    EXPECT_EQ(p[3], 255 * 0x1p119f);
}

TEST(Exr, RoundTripsBitForBit) {
    const TemporaryFolder folder;
    for (int channels = 1; channels <= 4; ++channels) {
        const Image image = noise(33, 40, channels, PixelType::f32);
        io::save_image(image, folder / "a.exr");
        EXPECT_TRUE(same(io::load_image(folder / "a.exr"), image)) << channels;
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

TEST(ImageFiles, RealHdrSurvivesWriting) {
    REQUIRE_TEST_DATA();
    const TemporaryFolder folder;
    const Image image = io::load_image(test_data("env/studio.hdr"));
    io::save_image(image, folder / "a.hdr");
    EXPECT_TRUE(same(io::load_image(folder / "a.hdr"), image));
}

// EXIF 2.32, tag 0x112: which side of the picture the stored row 0 and column 0 are.
TEST(ImageFiles, PhotographsAreTurnedUpright) {
    const std::vector<std::byte> jpeg = io::encode_jpeg(grey_blocks(), 100);
    const Image stored = io::decode_image(jpeg, "stored");
    const int w = stored.width(), h = stored.height();
    enum Side { top, bottom, left, right };
    const std::pair<Side, Side> sides[] = {{top, left}, {top, right}, {bottom, right}, {bottom, left},
                                           {left, top}, {right, top}, {right, bottom}, {left, bottom}};
    for (unsigned orientation = 1; orientation <= 8; ++orientation)
        for (const bool little : {true, false}) {
            const std::string file = with_app1(jpeg, exif_of(orientation, little));
            const Image picture = upright_file(file);
            const Side row = sides[orientation - 1].first, column = sides[orientation - 1].second;
            const bool turned = row == left || row == right;
            ASSERT_EQ(picture.width(), turned ? h : w) << orientation;
            ASSERT_EQ(picture.height(), turned ? w : h) << orientation;
            for (int y = 0; y < h; ++y)
                for (int x = 0; x < w; ++x) {
                    const int from_row = row == top || row == left ? y : h - 1 - y;
                    const int from_column = column == top || column == left ? x : w - 1 - x;
                    ASSERT_EQ(*picture.at<uint8_t>(turned ? from_row : from_column,
                                                   turned ? from_column : from_row),
                              *stored.at<uint8_t>(x, y))
                        << orientation << ": " << x << ", " << y;
                }
            // Textures have their pixels where their coordinates say.
            EXPECT_TRUE(same(io::decode_image(bytes_of(file), "stored"), stored)) << orientation;
        }
}

TEST(ImageFiles, DamagedOrientationsTurnNothing) {
    const std::vector<std::byte> jpeg = io::encode_jpeg(grey_blocks(), 100);
    const Image stored = io::decode_image(jpeg, "stored");
    const std::string good = exif_of(6, true);
    EXPECT_EQ(io::jpeg_orientation(bytes_of(with_app1(jpeg, good))), 6);
    EXPECT_EQ(io::jpeg_orientation(bytes_of(with_app1(jpeg, "http://ns.adobe.com/xap/1.0/") + good)), 1);
    // The block ends with the last byte of the value, two of padding and four of the next directory.
    for (size_t size = 0; size + 6 < good.size(); ++size)
        EXPECT_TRUE(same(upright_file(with_app1(jpeg, good.substr(0, size))), stored)) << size;
    for (const unsigned orientation : {0u, 9u, 0xffffu})
        EXPECT_TRUE(same(upright_file(with_app1(jpeg, exif_of(orientation, false))), stored)) << orientation;
    EXPECT_TRUE(same(upright_file(with_app1(jpeg, exif_of(6, false, 4))), stored)) << "of another type";
    // Each byte once inverted: whatever becomes of it, the picture is there.
    for (size_t i = 0; i < good.size(); ++i) {
        std::string exif = good;
        exif[i] = char(~exif[i]);
        EXPECT_EQ(upright_file(with_app1(jpeg, exif)).pixel_count(), stored.pixel_count()) << i;
    }
    // A file that ends within the segment.
    const std::string file = with_app1(jpeg, good);
    for (size_t size = 0; size < 2 + 2 + 2 + good.size(); ++size)
        EXPECT_EQ(io::jpeg_orientation(bytes_of(file.substr(0, size))), 1) << size;
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
            io::decode_image(bytes_of(content), "the-file");
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
