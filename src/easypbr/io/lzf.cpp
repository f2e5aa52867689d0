#include "easypbr/io/lzf.h"

#include <cstdint>
#include <cstring>

namespace easypbr::io {
namespace {

/// Runs of this length are copied at once where there is room: most are shorter, and a copy of fixed length
/// is a few instructions.
constexpr size_t literal_copy = 32, match_copy = 16;

class Decoder {
  public:
    Decoder(std::string_view in, std::span<char> out)
        : in_(in.data()),
          in_end_(in_ + in.size()),
          begin_(out.data()),
          out_(begin_),
          end_(begin_ + out.size()) {}

    bool decode() {
        while (in_ != in_end_) {
            const unsigned control = uint8_t(*in_++);
            if (!(control < 32 ? copy_literals(control + 1) : copy_match(control))) return false;
        }
        return out_ == end_;
    }

  private:
    size_t input() const { return size_t(in_end_ - in_); }
    size_t room() const { return size_t(end_ - out_); }

    bool copy_literals(size_t length) {
        if (input() < length || room() < length) return false;
        std::memcpy(out_, in_, input() >= literal_copy && room() >= literal_copy ? literal_copy : length);
        in_ += length;
        out_ += length;
        return true;
    }

    /// Repeats what stands up to 8 KB before.
    bool copy_match(unsigned control) {
        size_t length = (control >> 5) + 2;
        if (control >> 5 == 7) {
            if (in_ == in_end_) return false;
            length += uint8_t(*in_++);
        }
        if (in_ == in_end_) return false;
        const size_t distance = ((control & 31) << 8) + uint8_t(*in_++) + 1;
        if (size_t(out_ - begin_) < distance || room() < length) return false;
        const char* from = out_ - distance;
        if (distance >= match_copy && room() >= length + match_copy)
            for (size_t k = 0; k < length; k += match_copy) std::memcpy(out_ + k, from + k, match_copy);
        else
            // Forwards byte by byte: a match may overlap what it makes.
            for (size_t k = 0; k < length; ++k) out_[k] = from[k];
        out_ += length;
        return true;
    }

    const char* in_;
    const char* in_end_;
    char* begin_;
    char* out_;
    char* end_;
};

}  // namespace

bool lzf_decompress(std::string_view in, std::span<char> out) {
    return Decoder(in, out).decode();
}

}  // namespace easypbr::io
