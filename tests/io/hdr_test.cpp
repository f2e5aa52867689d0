// Radiance pictures (.hdr).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "io/bytes.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"
#include "test_data.h"

namespace easypbr::hdr_test {

TEST(Hdr, ReadsAPixelExactly) {
    // (128, 64, 1) with exponent byte 129: mantissa * 2^(129 - 136), nothing added.
    const Image image =
        io::decode_image(as_span(std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
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
    const Image image = io::decode_image(as_span(header + pixel + run3 + run1x256), "x");
    ASSERT_EQ(image.width(), 260);
    // Exposure 2: the stored value is twice the radiance.
    for (const float v : image.pixels<float>()) ASSERT_EQ(v, 0.5f);
}

TEST(Hdr, TakesAnExposureOfZeroForNone) {
    const Image image = io::decode_image(as_span("#?RGBE\nEXPOSURE=0\n\n-Y 1 +X 1\n\x80\x40\x20\x81"), "x");
    EXPECT_EQ(image.pixels<float>()[0], 1.0f);
}

TEST(Hdr, ReadsComponentRunsAndFlips) {
    const std::string row1 = std::string("\2\2\0\10", 4) + "\x88\x80" + "\x88\x40" + "\x88\x20" + "\x88\x81";
    const std::string row2 = std::string("\2\2\0\10", 4) + std::string("\10\1\2\3\4\5\6\7\10", 9) +
                             "\x88\x40" + "\x88\x20" + "\x88\x88";
    const Image image = io::decode_image(as_span("#?RGBE\n\n+Y 2 -X 8\n" + row1 + row2), "x");
    // +Y: the file's first row is the lowest; -X: its first pixel is the rightmost.
    EXPECT_EQ(image.at<float>(0, 1)[0], 1.0f);
    EXPECT_EQ(image.at<float>(7, 0)[0], 1.0f);
    EXPECT_EQ(image.at<float>(0, 0)[0], 8.0f);
}

TEST(Hdr, RoundTripsWhatItRead) {
    Image image = io::decode_image(as_span("#?RGBE\n\n-Y 1 +X 1\n\x80\x40\x20\x81"), "x");
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
        EXPECT_TRUE(same_bits(io::load_image(folder / "a.hdr"), picture)) << width;
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

TEST(ImageFiles, RealHdrSurvivesWriting) {
    REQUIRE_TEST_DATA();
    const TemporaryFolder folder;
    const Image image = io::load_image(test_data("env/studio.hdr"));
    io::save_image(image, folder / "a.hdr");
    EXPECT_TRUE(same_bits(io::load_image(folder / "a.hdr"), image));
}

}  // namespace easypbr::hdr_test
