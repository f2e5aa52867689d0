// LZF, the compression of PCD files (M. Lehmann, LibLZF).
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace easypbr::io {

/// Most bytes that `compressed` bytes can become: 3 bytes repeat up to 264.
constexpr size_t lzf_largest_size(size_t compressed) {
    return compressed * 88;
}

/// Decompresses in pieces. What was written last is looked back at, so it has to stay before what is written
/// next.
class LzfDecoder {
  public:
    /// How far a match looks back, and how far beyond its aim decode() may write.
    static constexpr size_t history = 8192, overshoot = 264;

    explicit LzfDecoder(std::string_view in) : in_(in.data()), in_end_(in_ + in.size()) {}

    /// Writes to `out` until it is at or behind `aim`, or all is read. `begin`: the first byte that was
    /// written and is still there; `end`: where the room ends. False when the data are damaged.
    bool decode(const char* begin, char*& out, const char* aim, char* end);

    bool at_end() const { return in_ == in_end_; }

  private:
    bool copy_literals(size_t length, char*& out, char* end);
    bool copy_match(unsigned control, const char* begin, char*& out, char* end);

    const char* in_;
    const char* in_end_;
};

/// Decompresses into all of `out`. False when the data are damaged: they would read or write outside, or give
/// another number of bytes.
bool lzf_decompress(std::string_view in, std::span<char> out);

}  // namespace easypbr::io
