// Streams of H.264: FFmpeg's program decodes them back to the pictures; key frames and rates are as asked.
#include "easypbr/io/video/video_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>

#include "easypbr/core/error.h"
#include "io/temporary_folder.h"

namespace easypbr::io::video_stream_test {
namespace {

/// A disc that moves over a gradient: smooth but for its edge.
Image disc(Vec2i size, int step) {
    Image image(size.x(), size.y(), 4, PixelType::u8);
    const Vec2d centre(20.0 + 2 * step, 0.5 * size.y());
    for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) {
            uint8_t* pixel = image.at<uint8_t>(x, y);
            const bool inside = (Vec2d(x, y) - centre).norm() < 15;
            pixel[0] = inside ? 230 : uint8_t(40 + 100 * x / size.x());
            pixel[1] = inside ? 90 : uint8_t(40 + 100 * y / size.y());
            pixel[2] = inside ? 60 : 120;
            pixel[3] = 255;
        }
    return image;
}

Image noise(Vec2i size, unsigned seed) {
    Image image(size.x(), size.y(), 4, PixelType::u8);
    std::mt19937 random(seed);
    for (uint8_t& value : image.pixels<uint8_t>()) value = uint8_t(random());
    return image;
}

/// Kinds of the units of a coded picture, from their start codes.
std::vector<int> units_of(const CodedPicture& picture) {
    std::vector<int> kinds;
    const auto& bytes = picture.bytes;
    for (size_t i = 0; i + 3 < bytes.size(); ++i)
        if (bytes[i] == std::byte(0) && bytes[i + 1] == std::byte(0) && bytes[i + 2] == std::byte(1))
            kinds.push_back(int(bytes[i + 3]) & 31);
    return kinds;
}

size_t count_of(const std::vector<int>& kinds, int kind) {
    return size_t(std::ranges::count(kinds, kind));
}

constexpr int slice = 1, key_slice = 5, sequence_set = 7, picture_set = 8;

class VideoStreamTest : public testing::Test {
  protected:
    void SetUp() override {
        try {
            open_video_stream({.size = {64, 64}});
        } catch (const FormatError& error) {
            GTEST_SKIP() << error.what();
        }
    }

    /// All decoded pictures, RGBA, one after another.
    std::vector<uint8_t> decoded(const std::vector<CodedPicture>& pictures, size_t first = 0) {
        const auto coded = folder_ / "stream.h264", raw = folder_ / "pictures.raw";
        {
            std::ofstream file(coded, std::ios::binary);
            for (size_t i = first; i < pictures.size(); ++i)
                file.write(reinterpret_cast<const char*>(pictures[i].bytes.data()),
                           std::streamsize(pictures[i].bytes.size()));
        }
        const std::string command = "ffmpeg -v error -y -f h264 -i '" + coded.string() +
                                    "' -fps_mode passthrough -f rawvideo -pix_fmt rgba '" + raw.string() +
                                    "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        std::ifstream file(raw, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    TemporaryFolder folder_;
};

/// Peak signal to noise ratio in dB of a decoded picture, whose sides are even ones, over the picture's own.
double psnr(const Image& picture, const uint8_t* decoded, int stride) {
    double sum = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < 3; ++c) {
                const double error = picture.at<uint8_t>(x, y)[c] - decoded[4 * (y * stride + x) + c];
                sum += error * error;
            }
    return 10 * std::log10(255.0 * 255.0 / (sum / (3.0 * picture.width() * picture.height())));
}

TEST_F(VideoStreamTest, DecodesBackToThePictures) {
    const Vec2i size(161, 97), even(162, 98);
    const auto stream = open_video_stream({.size = size});
    std::vector<CodedPicture> coded;
    for (int step = 0; step < 12; ++step) coded.push_back(stream->add(disc(size, step), false));
    const std::vector<uint8_t> pictures = decoded(coded);
    const size_t bytes = 4 * size_t(even.prod());
    ASSERT_EQ(pictures.size(), 12 * bytes);
    // Quantisers of 26 leave about 38 dB of luma on smooth pictures; the disc's edge loses colour, which has
    // a quarter of the pixels. A wrong range, matrix, row or order leaves less than 31.
    for (int step = 0; step < 12; ++step)
        EXPECT_GT(psnr(disc(size, step), pictures.data() + size_t(step) * bytes, even.x()), 32) << step;
}

TEST_F(VideoStreamTest, KeyFramesAreTheFirstAndThoseThatAreAskedFor) {
    const Vec2i size(160, 96);
    const auto stream = open_video_stream({.size = size});
    std::vector<CodedPicture> coded;
    for (int step = 0; step < 90; ++step) coded.push_back(stream->add(disc(size, step % 40), step == 50));
    for (size_t step = 0; step < coded.size(); ++step) {
        const bool is_key = step == 0 || step == 50;
        EXPECT_EQ(coded[step].is_key, is_key) << step;
        const std::vector<int> kinds = units_of(coded[step]);
        EXPECT_EQ(count_of(kinds, sequence_set), size_t(is_key)) << step;
        EXPECT_EQ(count_of(kinds, picture_set), size_t(is_key)) << step;
        EXPECT_GE(count_of(kinds, is_key ? key_slice : slice), 1u) << step;
        EXPECT_EQ(count_of(kinds, is_key ? slice : key_slice), 0u) << step;
    }
    // Who comes with a key frame sees what all see, to the last bit.
    const std::vector<uint8_t> all = decoded(coded), from_key = decoded(coded, 50);
    const size_t before = 50 * 4 * size_t(size.prod());
    ASSERT_EQ(from_key.size() + before, all.size());
    EXPECT_TRUE(std::equal(from_key.begin(), from_key.end(), all.begin() + std::ptrdiff_t(before)));
}

/// Noise takes whatever it is given: the rate alone holds it. Four seconds, of which a burst of three frames
/// is 3 %; x264 may miss its rate by some percent on pictures that it cannot foresee.
TEST_F(VideoStreamTest, TheRateHoldsAndChanges) {
    const Vec2i size(320, 180);
    const auto stream = open_video_stream({.size = size, .fps = 30, .rate = 2e6});
    const auto bits_per_second = [&](unsigned seed) {
        size_t bytes = 0;
        for (unsigned i = 0; i < 120; ++i) bytes += stream->add(noise(size, seed + i), false).bytes.size();
        return 8.0 * double(bytes) / 4;
    };
    const double high = bits_per_second(0);
    EXPECT_LT(high, 2e6 * 1.1);
    EXPECT_GT(high, 2e6 * 0.7);
    stream->set_rate(1e6);
    bits_per_second(1000);  // It settles.
    const double low = bits_per_second(2000);
    EXPECT_LT(low, 1e6 * 1.1);
    EXPECT_GT(low, 1e6 * 0.7);
}

TEST_F(VideoStreamTest, RefusesWhatIsOutOfRange) {
    EXPECT_THROW(open_video_stream({.size = {1, 64}}), ArgumentError);
    EXPECT_THROW(open_video_stream({.size = {64, 8193}}), ArgumentError);
    EXPECT_THROW(open_video_stream({.size = {64, 64}, .fps = 0}), ArgumentError);
    EXPECT_THROW(open_video_stream({.size = {64, 64}, .rate = NAN}), ArgumentError);
    EXPECT_THROW(open_video_stream({.size = {64, 64}, .quantiser = 52}), ArgumentError);
    const auto stream = open_video_stream({.size = {64, 64}});
    EXPECT_THROW(stream->add(Image(64, 65, 4, PixelType::u8), false), ArgumentError);
    EXPECT_THROW(stream->add(Image(64, 64, 3, PixelType::u8), false), ArgumentError);
    EXPECT_THROW(stream->set_rate(1), ArgumentError);
    EXPECT_FALSE(stream->add(Image(64, 64, 4, PixelType::u8), false).bytes.empty());
}

}  // namespace
}  // namespace easypbr::io::video_stream_test
