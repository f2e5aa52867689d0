// OpenEXR ("OpenEXR File Layout", openexr.com): single-part files of scanlines or tiles.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/exr_blocks.h"
#include "easypbr/io/image/image_codecs.h"

namespace easypbr::io {
namespace {

/// ZIP makes at most 1032 bytes of one, then halves become floats.
constexpr size_t most_exr_bytes_per_byte = 1032 * 2;

enum Sample : uint32_t { sample_uint, sample_half, sample_float };

struct Channel {
    std::string name;
    uint32_t type = sample_half;
};

struct ExrHeader {
    std::vector<Channel> channels;
    ExrCompression compression = ExrCompression::none;
    int32_t window[4] = {0, 0, -1, -1};
    uint32_t tile_width = 0, tile_height = 0;  ///< 0: scanlines
    int width = 0, height = 0;
    size_t data = 0;  ///< offset of the table of offsets
};

/// Little-endian values of a span, one after the other.
class Cursor {
  public:
    Cursor(Bytes bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    template <class T>
    T read() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }

    std::string text() {
        std::string out;
        for (char c = read<char>(); c != '\0'; c = read<char>()) {
            out += c;
            if (out.size() > 255) fail_image(name_, "damaged EXR: a name of more than 255 characters");
        }
        return out;
    }

    Bytes take(size_t count) {
        if (count > bytes_.size() - at_) fail_image(name_, "truncated EXR");
        const Bytes part = bytes_.subspan(at_, count);
        at_ += count;
        return part;
    }

    size_t position() const { return at_; }

  private:
    Bytes bytes_;
    const std::string& name_;
    size_t at_ = 0;
};

void read_channels(Bytes bytes, const std::string& name, ExrHeader& header) {
    Cursor cursor(bytes, name);
    for (std::string channel = cursor.text(); !channel.empty(); channel = cursor.text()) {
        const auto type = cursor.read<uint32_t>();
        cursor.take(4);
        const auto x_sampling = cursor.read<int32_t>(), y_sampling = cursor.read<int32_t>();
        if (type > sample_float)
            fail_image(name, fmt::format("EXR channel '{}' of unknown type {}", channel, type));
        if (x_sampling != 1 || y_sampling != 1)
            fail_image(name, fmt::format("EXR with subsampled channel '{}': not supported", channel));
        header.channels.push_back({channel, type});
        if (header.channels.size() > 1024) fail_image(name, "EXR with more than 1024 channels");
    }
}

void read_attribute(const std::string& key, Bytes bytes, const std::string& name, ExrHeader& header) {
    Cursor cursor(bytes, name);
    if (key == "channels") {
        read_channels(bytes, name, header);
    } else if (key == "compression") {
        const auto code = cursor.read<uint8_t>();
        if (code > uint8_t(ExrCompression::piz))
            fail_image(name, fmt::format("EXR compression {}: only none, RLE, ZIP and PIZ are read", code));
        header.compression = ExrCompression(code);
    } else if (key == "dataWindow") {
        for (int32_t& side : header.window) side = cursor.read<int32_t>();
    } else if (key == "tiles") {
        header.tile_width = cursor.read<uint32_t>();
        header.tile_height = cursor.read<uint32_t>();
    }
}

void check_header(const ExrHeader& header, bool tiled, size_t file_bytes, const std::string& name) {
    if (header.channels.empty()) fail_image(name, "damaged EXR: no channels");
    if (tiled &&
        (header.tile_width < 1 || header.tile_height < 1 || header.tile_width > uint32_t(max_image_side) ||
         header.tile_height > uint32_t(max_image_side)))
        fail_image(name,
                   fmt::format("damaged EXR: tiles of {}x{} pixels", header.tile_width, header.tile_height));
    check_plausible(size_t(header.width) * size_t(header.height) * header.channels.size() * 4, file_bytes,
                    most_exr_bytes_per_byte, name);
}

ExrHeader read_header(Bytes bytes, const std::string& name) {
    constexpr uint32_t flag_tiled = 0x200, flag_deep = 0x800, flag_parts = 0x1000;
    Cursor cursor(bytes, name);
    cursor.take(4);
    const auto version = cursor.read<uint32_t>();
    if ((version & 0xff) != 2) fail_image(name, fmt::format("EXR of version {}: expected 2", version & 0xff));
    if (version & (flag_deep | flag_parts))
        fail_image(name, "EXR with several parts or deep pixels: only single-part flat pictures are read");
    ExrHeader header;
    for (std::string key = cursor.text(); !key.empty(); key = cursor.text()) {
        cursor.text();
        const auto size = cursor.read<uint32_t>();
        read_attribute(key, cursor.take(size), name, header);
    }
    const auto side = [&](int low, int high) {
        return (long long)header.window[high] - header.window[low] + 1;
    };
    check_image_size(side(0, 2), side(1, 3), name);
    header.width = int(side(0, 2));
    header.height = int(side(1, 3));
    header.data = cursor.position();
    if (!(version & flag_tiled)) header.tile_width = header.tile_height = 0;
    check_header(header, version & flag_tiled, bytes.size(), name);
    return header;
}

/// Indices of the channels that make the picture: RGB or Y, and A where there is one; else the only channel.
std::vector<int> picture_channels(const ExrHeader& header, const std::string& name) {
    const auto named = [&](const char* wanted) {
        for (size_t c = 0; c < header.channels.size(); ++c)
            if (header.channels[c].name == wanted) return int(c);
        return -1;
    };
    std::vector<int> chosen = {named("R"), named("G"), named("B")};
    if (std::count(chosen.begin(), chosen.end(), -1) > 0) chosen = {named("Y")};
    if (chosen[0] >= 0) {
        if (const int alpha = named("A"); alpha >= 0) chosen.push_back(alpha);
        return chosen;
    }
    if (header.channels.size() == 1) return {0};
    std::vector<std::string> names;
    for (const Channel& channel : header.channels) names.push_back(channel.name);
    fail_image(name, fmt::format("EXR without channels R, G, B or Y (it has {})", fmt::join(names, ", ")));
}

float float_of_half(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000) << 16, rest = uint32_t(half & 0x7fff) << 13;
    const int exponent = half >> 10 & 31;
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | rest);
    if (exponent > 0) return std::bit_cast<float>(sign | (rest + (112u << 23)));
    const float magnitude = std::ldexp(float(half & 1023), -24);
    return sign ? -magnitude : magnitude;
}

/// A rectangle of the picture that is compressed on its own.
struct ExrBlock {
    int x = 0, y = 0, width = 0, height = 0;
};

class BlockReader {
  public:
    BlockReader(Bytes bytes, const ExrHeader& header, std::vector<int> chosen, Image& image,
                const std::string& name)
        : bytes_(bytes), header_(header), chosen_(std::move(chosen)), image_(image), name_(name) {
        for (const Channel& channel : header.channels)
            planes_.push_back({channel.type == sample_half ? 1 : 2});
    }

    void read_all() {
        const bool tiled = header_.tile_width > 0;
        const int lines = header_.compression == ExrCompression::zip   ? 16
                          : header_.compression == ExrCompression::piz ? 32
                                                                       : 1;
        const int width = tiled ? int(header_.tile_width) : header_.width;
        const int height = tiled ? int(header_.tile_height) : lines;
        const size_t columns = size_t((header_.width + width - 1) / width);
        const size_t rows = size_t((header_.height + height - 1) / height);
        const Bytes table = bytes_.subspan(header_.data);
        if (columns * rows > table.size() / 8) fail_image(name_, "truncated EXR");
        parallel_for(columns * rows, 1, [&](size_t i) {
            uint64_t offset;
            std::memcpy(&offset, table.data() + 8 * i, 8);
            read_block(offset, {int(i % columns) * width, int(i / columns) * height, width, height}, tiled);
        });
    }

  private:
    void read_block(uint64_t offset, ExrBlock block, bool tiled) const {
        if (offset > bytes_.size()) fail_image(name_, "damaged EXR: a block outside of the file");
        Cursor cursor(bytes_.subspan(size_t(offset)), name_);
        if (tiled) {
            const auto column = cursor.read<int32_t>(), row = cursor.read<int32_t>();
            cursor.take(8);
            if (column != block.x / block.width || row != block.y / block.height)
                fail_image(name_, "damaged EXR: tiles in a wrong place");
        } else if ((long long)cursor.read<int32_t>() - header_.window[1] != block.y) {
            fail_image(name_, "damaged EXR: scanlines in a wrong place");
        }
        block.width = std::min(block.width, header_.width - block.x);
        block.height = std::min(block.height, header_.height - block.y);
        const Bytes packed = cursor.take(cursor.read<uint32_t>());
        try {
            copy(decompress_exr(header_.compression, packed, block.width, block.height, planes_), block);
        } catch (const ExrDamage& damage) {
            fail_image(name_, fmt::format("damaged EXR: {} at byte {}", damage.what, offset));
        }
    }

    void copy(const std::vector<std::byte>& samples, const ExrBlock& block) const {
        size_t line_bytes = 0;
        std::vector<size_t> starts;
        for (const ExrPlane& plane : planes_) {
            starts.push_back(line_bytes);
            line_bytes += size_t(plane.words) * 2 * size_t(block.width);
        }
        for (int y = 0; y < block.height; ++y)
            for (size_t c = 0; c < chosen_.size(); ++c) {
                const size_t channel = size_t(chosen_[c]);
                const std::byte* from = samples.data() + line_bytes * size_t(y) + starts[channel];
                float* to = image_.at<float>(block.x, block.y + y) + c;
                copy_line(from, header_.channels[channel].type, block.width, to);
            }
    }

    void copy_line(const std::byte* from, uint32_t type, int count, float* to) const {
        switch (type) {
            case sample_half:
                return copy_line<uint16_t>(from, count, to, float_of_half);
            case sample_float:
                return copy_line<float>(from, count, to, [](float value) { return value; });
            default:
                return copy_line<uint32_t>(from, count, to, [](uint32_t value) { return float(value); });
        }
    }

    template <class T, class Convert>
    void copy_line(const std::byte* from, int count, float* to, Convert convert) const {
        const size_t stride = chosen_.size();
        for (int x = 0; x < count; ++x, to += stride) {
            T value;
            std::memcpy(&value, from + sizeof(T) * size_t(x), sizeof(T));
            *to = convert(value);
        }
    }

    Bytes bytes_;
    const ExrHeader& header_;
    std::vector<int> chosen_;
    Image& image_;
    const std::string& name_;
    std::vector<ExrPlane> planes_;
};

}  // namespace

Image decode_exr(Bytes bytes, const std::string& name) {
    const ExrHeader header = read_header(bytes, name);
    const std::vector<int> chosen = picture_channels(header, name);
    Image image = make_image(header.width, header.height, int(chosen.size()), PixelType::f32, name);
    BlockReader(bytes, header, chosen, image, name).read_all();
    return image;
}

}  // namespace easypbr::io
