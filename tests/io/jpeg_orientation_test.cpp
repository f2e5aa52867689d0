// The orientation in the EXIF block of JPEG photographs.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "easypbr/core/file.h"
#include "easypbr/core/image.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/image/image_io.h"
#include "io/bytes.h"
#include "io/same_bits.h"
#include "io/temporary_folder.h"

namespace easypbr::jpeg_orientation_test {

namespace {

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
    write_file(folder / "a.jpg", as_span(jpeg));
    return io::load_upright_image(folder / "a.jpg");
}

}  // namespace

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
            EXPECT_TRUE(same_bits(io::decode_image(as_span(file), "stored"), stored)) << orientation;
        }
}

TEST(ImageFiles, DamagedOrientationsTurnNothing) {
    const std::vector<std::byte> jpeg = io::encode_jpeg(grey_blocks(), 100);
    const Image stored = io::decode_image(jpeg, "stored");
    const std::string good = exif_of(6, true);
    EXPECT_EQ(io::jpeg_orientation(as_span(with_app1(jpeg, good))), 6);
    EXPECT_EQ(io::jpeg_orientation(as_span(with_app1(jpeg, "http://ns.adobe.com/xap/1.0/") + good)), 1);
    // The block ends with the last byte of the value, two of padding and four of the next directory.
    for (size_t size = 0; size + 6 < good.size(); ++size)
        EXPECT_TRUE(same_bits(upright_file(with_app1(jpeg, good.substr(0, size))), stored)) << size;
    for (const unsigned orientation : {0u, 9u, 0xffffu})
        EXPECT_TRUE(same_bits(upright_file(with_app1(jpeg, exif_of(orientation, false))), stored))
            << orientation;
    EXPECT_TRUE(same_bits(upright_file(with_app1(jpeg, exif_of(6, false, 4))), stored)) << "of another type";
    // Each byte once inverted: whatever becomes of it, the picture is there.
    for (size_t i = 0; i < good.size(); ++i) {
        std::string exif = good;
        exif[i] = char(~exif[i]);
        EXPECT_EQ(upright_file(with_app1(jpeg, exif)).pixel_count(), stored.pixel_count()) << i;
    }
    // A file that ends within the segment.
    const std::string file = with_app1(jpeg, good);
    for (size_t size = 0; size < 2 + 2 + 2 + good.size(); ++size)
        EXPECT_EQ(io::jpeg_orientation(as_span(file.substr(0, size))), 1) << size;
}

}  // namespace easypbr::jpeg_orientation_test
