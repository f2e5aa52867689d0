// The head of every binary message to a client: 40 bytes, little endian; the bytes of the picture follow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace easypbr::remote {

enum class FrameKind : uint8_t {
    moving = 1,  ///< a whole picture, drawn quickly
    still = 2,   ///< a chunk of a picture at rest
    shot = 3,    ///< a chunk of a still that a client asked for; `input` is its id
    file = 4     ///< a chunk of a video that a client has recorded
};
enum class Codec : uint8_t { jpeg = 1, png = 2, h264 = 3, mp4 = 4, webm = 5, gif = 6 };

struct FrameHeader {
    static constexpr size_t size = 40;
    static constexpr uint16_t last = 1;    ///< flag: no chunk of this picture follows
    static constexpr uint16_t exact = 2;   ///< flag: bit for bit what is rendered, refined to its end
    static constexpr uint16_t opaque = 4;  ///< flag: nothing shines through
    static constexpr uint16_t key = 8;     ///< flag: of a video, which begins here for who has nothing of it

    FrameKind kind = FrameKind::moving;  // offset 0
    Codec codec = Codec::jpeg;           // 1
    uint16_t flags = 0;                  // 2
    uint32_t frame = 0;                  // 4: number of the picture
    uint32_t input = 0;                  // 8: the last input of the controlling client that it shows
    uint16_t view = 0;                   // 12
    uint16_t width = 0, height = 0;      // 14, 16: of the picture, pixels
    uint16_t refined = 0, total = 0;     // 18, 20: frames that are averaged, and all that shall be
    uint16_t chunk = 0;                  // 22
    uint32_t bytes = 0;                  // 24: of the whole picture
    uint32_t draw_us = 0;                // 28: microseconds of the last drawing
    uint32_t encode_us = 0;              // 32: of encoding
    uint32_t wait_us = 0;                // 36: from the input's arrival to the end of the drawing

    std::array<std::byte, size> encoded() const;
};

}  // namespace easypbr::remote
