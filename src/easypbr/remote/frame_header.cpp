#include "easypbr/remote/frame_header.h"

namespace easypbr::remote {
namespace {

/// Puts numbers one after another, lowest byte first.
class Packer {
  public:
    template <class T>
    Packer& put(T value) {
        for (size_t i = 0; i < sizeof(T); ++i) bytes[at++] = std::byte((uint64_t(value) >> (8 * i)) & 0xff);
        return *this;
    }
    std::array<std::byte, FrameHeader::size> bytes{};
    size_t at = 0;
};

}  // namespace

std::array<std::byte, FrameHeader::size> FrameHeader::encoded() const {
    Packer packer;
    packer.put(uint8_t(kind)).put(uint8_t(codec)).put(flags).put(frame).put(input).put(view);
    packer.put(width).put(height).put(refined).put(total).put(chunk);
    packer.put(bytes).put(draw_us).put(encode_us).put(wait_us);
    return packer.bytes;
}

}  // namespace easypbr::remote
