#include "easypbr/io/archive/lzf.h"

#include <cstdint>
#include <cstring>

namespace easypbr::io {
namespace {

/// Runs of this length are copied at once where there is room: most are shorter, and a copy of fixed length
/// is a few instructions.
constexpr size_t literal_copy = 32, match_copy = 16;

}  // namespace

bool LzfDecoder::decode(const char* begin, char*& out, const char* aim, char* end) {
    while (in_ != in_end_ && out < aim) {
        const unsigned control = uint8_t(*in_++);
        if (!(control < 32 ? copy_literals(control + 1, out, end) : copy_match(control, begin, out, end)))
            return false;
    }
    return true;
}

bool LzfDecoder::copy_literals(size_t length, char*& out, char* end) {
    const size_t input = size_t(in_end_ - in_), room = size_t(end - out);
    if (input < length || room < length) return false;
    std::memcpy(out, in_, input >= literal_copy && room >= literal_copy ? literal_copy : length);
    in_ += length;
    out += length;
    return true;
}

/// Repeats what stands up to 8 KB before.
bool LzfDecoder::copy_match(unsigned control, const char* begin, char*& out, char* end) {
    size_t length = (control >> 5) + 2;
    if (control >> 5 == 7) {
        if (in_ == in_end_) return false;
        length += uint8_t(*in_++);
    }
    if (in_ == in_end_) return false;
    const size_t distance = ((control & 31) << 8) + uint8_t(*in_++) + 1;
    const size_t room = size_t(end - out);
    if (size_t(out - begin) < distance || room < length) return false;
    const char* from = out - distance;
    if (distance >= match_copy && room >= length + match_copy)
        for (size_t k = 0; k < length; k += match_copy) std::memcpy(out + k, from + k, match_copy);
    else
        // Forwards byte by byte: a match may overlap what it makes.
        for (size_t k = 0; k < length; ++k) out[k] = from[k];
    out += length;
    return true;
}

bool lzf_decompress(std::string_view in, std::span<char> out) {
    LzfDecoder decoder(in);
    char* at = out.data();
    char* end = at + out.size();
    // One byte beyond the end is aimed at, so that too much is noticed.
    return decoder.decode(out.data(), at, end + 1, end) && at == end;
}

}  // namespace easypbr::io
