// PIZ: a table of the values that occur, a Haar wavelet on 16-bit words, and a canonical Huffman code whose
// last symbol repeats the word before it.
#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

#include "easypbr/io/image/exr_blocks.h"

namespace easypbr::io {
namespace {

constexpr int longest_code = 58;
constexpr size_t symbol_count = (1 << 16) + 1;

/// Bits of a span, the highest of a byte first.
class BitReader {
  public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    unsigned read(int count) {
        unsigned value = 0;
        for (int i = 0; i < count; ++i) value = value << 1 | bit();
        return value;
    }

    unsigned bit() {
        if (at_ / 8 >= bytes_.size()) throw ExrDamage{"a truncated PIZ block"};
        const unsigned value = unsigned(bytes_[at_ / 8]) >> (7 - at_ % 8) & 1;
        ++at_;
        return value;
    }

    size_t position() const { return at_; }
    size_t whole_bytes() const { return (at_ + 7) / 8; }

  private:
    std::span<const std::byte> bytes_;
    size_t at_ = 0;
};

uint32_t u32_at(std::span<const std::byte> bytes, size_t at) {
    if (bytes.size() < 4 || at > bytes.size() - 4) throw ExrDamage{"a truncated PIZ block"};
    uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

/// Codes of one length are consecutive numbers; the longer the codes, the smaller their first.
class HuffmanCode {
  public:
    explicit HuffmanCode(const std::vector<uint8_t>& lengths) {
        for (const uint8_t length : lengths) ++count_[length];
        count_[0] = 0;
        uint64_t code = 0;
        for (int length = longest_code; length > 0; --length) {
            first_[length] = code;
            code = (code + count_[length]) >> 1;
        }
        uint32_t total = 0;
        for (int length = 1; length <= longest_code; ++length) {
            start_[length] = total;
            total += count_[length];
        }
        symbols_.resize(total);
        std::array<uint32_t, longest_code + 1> next = start_;
        for (size_t symbol = 0; symbol < lengths.size(); ++symbol)
            if (lengths[symbol]) symbols_[next[lengths[symbol]]++] = uint32_t(symbol);
    }

    uint32_t read(BitReader& bits) const {
        uint64_t code = 0;
        for (int length = 1; length <= longest_code; ++length) {
            code = code << 1 | bits.bit();
            if (code >= first_[length] && code - first_[length] < count_[length])
                return symbols_[start_[length] + size_t(code - first_[length])];
        }
        throw ExrDamage{"a damaged PIZ block: an unknown code"};
    }

  private:
    std::array<uint32_t, longest_code + 1> count_{}, start_{};
    std::array<uint64_t, longest_code + 1> first_{};
    std::vector<uint32_t> symbols_;
};

/// Lengths of the codes of symbols first..last in 6 bits each; 59 to 62 stand for 2 to 5 symbols without a
/// code, 63 for 6 and as many more as the next 8 bits say.
std::vector<uint8_t> read_lengths(BitReader& bits, uint32_t first, uint32_t last) {
    std::vector<uint8_t> lengths(symbol_count, 0);
    for (size_t symbol = first; symbol <= last; ++symbol) {
        const unsigned length = bits.read(6);
        if (length <= longest_code) {
            lengths[symbol] = uint8_t(length);
            continue;
        }
        const size_t skipped = length == 63 ? bits.read(8) + 6 : length - 57;
        if (skipped > last + 1 - symbol) throw ExrDamage{"a damaged PIZ block: its code table is too long"};
        symbol += skipped - 1;
    }
    return lengths;
}

std::vector<uint16_t> decode_words(std::span<const std::byte> packed, size_t count) {
    const uint32_t first = u32_at(packed, 0), last = u32_at(packed, 4), bit_count = u32_at(packed, 12);
    if (first >= symbol_count || last >= symbol_count || first > last || packed.size() < 20)
        throw ExrDamage{"a damaged PIZ block: its code table"};
    BitReader table(packed.subspan(20));
    const HuffmanCode code(read_lengths(table, first, last));
    const auto data = packed.subspan(20 + table.whole_bytes());
    if (bit_count > data.size() * 8) throw ExrDamage{"a truncated PIZ block"};
    BitReader bits(data);
    std::vector<uint16_t> out;
    out.reserve(count);
    while (out.size() < count) {
        const uint32_t symbol = code.read(bits);
        if (symbol != last) {
            out.push_back(uint16_t(symbol));
            continue;
        }
        const size_t repeats = bits.read(8);
        if (out.empty() || repeats > count - out.size()) throw ExrDamage{"a damaged PIZ block: a run"};
        out.insert(out.end(), repeats, uint16_t(out.back()));
    }
    return out;
}

/// Mean and difference back to two words; exact in 14 bits as signed numbers, else modulo 2^16.
struct Unmix {
    bool small;

    void operator()(uint16_t mean, uint16_t difference, uint16_t& a, uint16_t& b) const {
        if (small) {
            const int m = int16_t(mean), d = int16_t(difference);
            const int first = m + (d & 1) + (d >> 1);
            a = uint16_t(first);
            b = uint16_t(first - d);
            return;
        }
        const uint16_t second = uint16_t(mean - (difference >> 1));
        a = uint16_t(difference + second - 0x8000);
        b = second;
    }
};

/// Undoes the wavelet in place on width x height words that lie `step` and `line` apart.
void inverse_wavelet(uint16_t* data, int width, int height, size_t step, size_t line, uint16_t largest) {
    const Unmix unmix{largest < (1 << 14)};
    const auto at = [&](int x, int y) -> uint16_t& { return data[size_t(x) * step + size_t(y) * line]; };
    int size = 1;
    while (size <= std::min(width, height) / 2) size *= 2;
    for (int half = size / 2; half >= 1; half /= 2) {
        const int whole = half * 2;
        int x = 0, y = 0;
        for (y = 0; y + whole <= height; y += whole) {
            for (x = 0; x + whole <= width; x += whole) {
                uint16_t left_top, left_bottom, right_top, right_bottom;
                unmix(at(x, y), at(x, y + half), left_top, left_bottom);
                unmix(at(x + half, y), at(x + half, y + half), right_top, right_bottom);
                unmix(left_top, right_top, at(x, y), at(x + half, y));
                unmix(left_bottom, right_bottom, at(x, y + half), at(x + half, y + half));
            }
            if (width & half) unmix(uint16_t(at(x, y)), uint16_t(at(x, y + half)), at(x, y), at(x, y + half));
        }
        if (height & half)
            for (x = 0; x + whole <= width; x += whole)
                unmix(uint16_t(at(x, y)), uint16_t(at(x + half, y)), at(x, y), at(x + half, y));
    }
}

/// The values that occur, by their number: 0 and those marked in a bitmap.
std::vector<uint16_t> read_values(std::span<const std::byte> packed, size_t& used) {
    const uint32_t ends = u32_at(packed, 0);
    const size_t first = ends & 0xffff, last = ends >> 16;
    used = 4;
    std::vector<uint16_t> values = {0};
    if (first > last) return values;
    if (last >= 8192 || last - first >= packed.size() - 4)
        throw ExrDamage{"a damaged PIZ block: its value table"};
    used += last - first + 1;
    for (size_t value = first * 8; value < (last + 1) * 8; ++value)
        if (value && (unsigned(packed[4 + value / 8 - first]) >> value % 8 & 1))
            values.push_back(uint16_t(value));
    return values;
}

}  // namespace

std::vector<std::byte> decompress_piz(std::span<const std::byte> packed, int width, int height,
                                      const std::vector<ExrPlane>& planes) {
    size_t used = 0;
    const std::vector<uint16_t> values = read_values(packed, used);
    const size_t length = u32_at(packed, used);
    if (length > packed.size() - used - 4) throw ExrDamage{"a truncated PIZ block"};
    int words_per_pixel = 0;
    for (const ExrPlane& plane : planes) words_per_pixel += plane.words;
    std::vector<uint16_t> words = decode_words(packed.subspan(used + 4, length),
                                               size_t(words_per_pixel) * size_t(width) * size_t(height));
    size_t start = 0;
    for (const ExrPlane& plane : planes) {
        const size_t line = size_t(plane.words) * size_t(width);
        for (int word = 0; word < plane.words; ++word)
            inverse_wavelet(words.data() + start + word, width, height, size_t(plane.words), line,
                            uint16_t(values.size() - 1));
        start += line * size_t(height);
    }
    for (uint16_t& word : words) word = word < values.size() ? values[word] : uint16_t(0);

    std::vector<std::byte> out(words.size() * 2);
    size_t to = 0;
    for (int y = 0; y < height; ++y) {
        size_t plane_start = 0;
        for (const ExrPlane& plane : planes) {
            const size_t line = size_t(plane.words) * size_t(width);
            std::memcpy(out.data() + to, words.data() + plane_start + line * size_t(y), line * 2);
            to += line * 2;
            plane_start += line * size_t(height);
        }
    }
    return out;
}

}  // namespace easypbr::io
