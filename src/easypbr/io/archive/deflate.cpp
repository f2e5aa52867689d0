#include "easypbr/io/archive/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "easypbr/core/error.h"

namespace easypbr::io {
namespace {

/// zlib counts in 32 bits.
constexpr size_t most_at_once = std::numeric_limits<uInt>::max();
/// Added to the window's size: a gzip file.
constexpr int gzip_window = MAX_WBITS + 16;

/// Gives a stream the next pieces of what it reads and fills.
void feed(z_stream& stream, std::string_view in, size_t read, std::span<char> out, size_t written) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data() + read));
    stream.avail_in = uInt(std::min(most_at_once, in.size() - read));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + written);
    stream.avail_out = uInt(std::min(most_at_once, out.size() - written));
}

/// Calls step() until the stream ends, `out` is full or nothing moves; its last answer and what was written.
template <class Step>
std::pair<int, size_t> run(z_stream& stream, std::string_view in, std::span<char> out, Step&& step) {
    size_t read = 0, written = 0;
    for (int state = Z_OK;;) {
        feed(stream, in, read, out, written);
        const uInt in_before = stream.avail_in, out_before = stream.avail_out;
        state = step(in_before == in.size() - read);
        read += in_before - stream.avail_in;
        written += out_before - stream.avail_out;
        const bool moved = in_before != stream.avail_in || out_before != stream.avail_out;
        if (state != Z_OK || !moved) return {state, written};
    }
}

}  // namespace

Inflated inflate_into(std::string_view packed, DeflateForm form, std::span<char> out) {
    z_stream stream{};
    if (inflateInit2(&stream, form == DeflateForm::gzip ? gzip_window : -MAX_WBITS) != Z_OK)
        return {.damaged = true};
    const auto [state, written] =
        run(stream, packed, out, [&](bool) { return inflate(&stream, Z_NO_FLUSH); });
    inflateEnd(&stream);
    // Z_BUF_ERROR: no room, or no bytes, are left.
    return {written, state == Z_STREAM_END, state != Z_STREAM_END && state != Z_OK && state != Z_BUF_ERROR};
}

std::string gzip(std::string_view bytes) {
    z_stream stream{};
    constexpr int memory_level = 9;
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, memory_level,
                     Z_DEFAULT_STRATEGY) != Z_OK)
        throw FormatError("zlib cannot be started");
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    const auto packed = run(stream, bytes, out,
                            [&](bool is_last) { return deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH); });
    deflateEnd(&stream);
    out.resize(packed.second);
    return out;
}

}  // namespace easypbr::io
