// Radiance pictures (Ward, "Real Pixels", Graphics Gems II; the reference manual's "picture file format").
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>

#include "easypbr/core/parallel.h"
#include "easypbr/io/image/image_codecs.h"
#include "easypbr/io/source/text_scanner.h"

namespace easypbr::io {
namespace {

using Rgbe = std::array<uint8_t, 4>;

struct HdrHeader {
    int width = 0, height = 0;
    bool bottom_up = false, right_to_left = false;
    std::array<double, 3> divisor{1, 1, 1};  ///< radiance = pixel / divisor
    size_t data = 0;                         ///< offset of the first scanline
};

class HeaderReader {
  public:
    HeaderReader(Bytes bytes, const std::string& name)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name) {}

    HdrHeader read() {
        next_line();
        for (std::string_view line = next_line(); !line.empty(); line = next_line()) variable(line);
        resolution(next_line());
        header_.data = at_;
        return header_;
    }

  private:
    std::string_view next_line() {
        const size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos || end - at_ > 4096)
            fail_image(name_, "damaged HDR: the header has no end");
        std::string_view line = text_.substr(at_, end - at_);
        at_ = end + 1;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        return line;
    }

    /// Whether a line is "NAME=" and as many numbers as there are values.
    static bool read_values(std::string_view line, std::string_view name, std::span<double> values) {
        if (!line.starts_with(name)) return false;
        const char *p = line.data() + name.size(), *end = line.data() + line.size();
        return std::ranges::all_of(values, [&](double& value) { return read_number(p, end, value); });
    }

    void variable(std::string_view line) {
        if (line.starts_with("FORMAT=") && line.find("32-bit_rle_rgbe") == std::string_view::npos)
            fail_image(name_, fmt::format("HDR with '{}': only FORMAT=32-bit_rle_rgbe is read", line));
        std::array<double, 3> value{};
        if (read_values(line, "EXPOSURE=", {value.data(), 1}))
            divide({value[0], value[0], value[0]});
        else if (read_values(line, "COLORCORR=", value))
            divide(value);
    }

    /// Some writers put EXPOSURE=0 where they mean none: a factor that is no positive number counts as 1.
    void divide(const std::array<double, 3>& factor) {
        for (int c = 0; c < 3; ++c)
            if (factor[c] > 1e-30 && factor[c] < 1e30) header_.divisor[c] *= factor[c];
    }

    /// An axis with its sign and size, "-Y 512"; moves `p` behind it. False if there is none.
    static bool read_side(const char*& p, const char* end, char& sign, char& axis, int64_t& size) {
        if (end - p < 2) return false;
        sign = *p++;
        axis = *p++;
        const auto number = std::from_chars(skip_blanks(p, end), end, size);
        p = skip_blanks(number.ptr, end);
        return number.ec == std::errc();
    }

    void resolution(std::string_view line) {
        char sign[2]{}, axis[2]{};
        int64_t size[2]{};
        const char *p = line.data(), *end = p + line.size();
        if (!read_side(p, end, sign[0], axis[0], size[0]) || !read_side(p, end, sign[1], axis[1], size[1]))
            fail_image(
                name_,
                fmt::format("damaged HDR: expected a resolution like '-Y 512 +X 1024', got '{}'", line));
        const bool signs = (sign[0] == '-' || sign[0] == '+') && (sign[1] == '-' || sign[1] == '+');
        if (!signs || axis[0] != 'Y' || axis[1] != 'X')
            fail_image(
                name_,
                fmt::format("HDR with axes '{}': only rows along X ('-Y H +X W' and its flips) are read",
                            line));
        check_image_size(size[1], size[0], name_);
        header_.height = int(size[0]);
        header_.width = int(size[1]);
        header_.bottom_up = sign[0] == '+';
        header_.right_to_left = sign[1] == '-';
    }

    std::string_view text_;
    const std::string& name_;
    size_t at_ = 0;
    HdrHeader header_;
};

const uint8_t* data_of(Bytes bytes) {
    return reinterpret_cast<const uint8_t*>(bytes.data());
}

/// A scanline has four separate run-length coded components when it starts with 2, 2, width (15 bits).
bool has_component_runs(const uint8_t* row, size_t left, int width) {
    return width >= 8 && width <= 32767 && left >= 4 && row[0] == 2 && row[1] == 2 && !(row[2] & 128);
}

bool is_repeat(const uint8_t* pixel) {
    return pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
}

/// Offset behind the scanline at `at`; calls run(component, x, count, source, repeated) for each run of
/// components.
template <class Run>
size_t walk_component_runs(Bytes bytes, size_t at, int width, const std::string& name, Run&& run) {
    const uint8_t* data = data_of(bytes);
    if ((data[at + 2] << 8 | data[at + 3]) != width)
        fail_image(name, fmt::format("damaged HDR: a scanline of another width at byte {}", at));
    at += 4;
    for (int component = 0; component < 4; ++component)
        for (int x = 0; x < width;) {
            if (at >= bytes.size()) fail_image(name, "truncated HDR");
            const bool repeated = data[at] > 128;
            const int count = repeated ? data[at] & 127 : data[at];
            const size_t stored = repeated ? 1 : size_t(count);
            if (count == 0 || count > width - x)
                fail_image(name, fmt::format("damaged HDR: a run of wrong length at byte {}", at));
            if (bytes.size() - at - 1 < stored) fail_image(name, "truncated HDR");
            run(component, x, count, data + at + 1, repeated);
            at += 1 + stored;
            x += count;
        }
    return at;
}

/// The same for plain pixels with the old runs: (1, 1, 1, n) repeats the pixel before n times, and one that
/// follows another counts 256 times as much. Calls run(x, count, pixel).
template <class Run>
size_t walk_pixels(Bytes bytes, size_t at, int width, const std::string& name, Run&& run) {
    const uint8_t* data = data_of(bytes);
    const uint8_t* last = nullptr;
    int shift = 0;
    for (int x = 0; x < width;) {
        if (bytes.size() - at < 4) fail_image(name, "truncated HDR");
        const uint8_t* pixel = data + at;
        long long count = 1;
        if (is_repeat(pixel)) {
            if (!last || shift > 16)
                fail_image(name, fmt::format("damaged HDR: a run without a pixel at byte {}", at));
            count = (long long)pixel[3] << shift;
            shift += 8;
        } else {
            last = pixel;
            shift = 0;
        }
        if (count > width - x)
            fail_image(name, fmt::format("damaged HDR: a run of wrong length at byte {}", at));
        run(x, int(count), last);
        x += int(count);
        at += 4;
    }
    return at;
}

std::vector<size_t> find_scanlines(Bytes bytes, const HdrHeader& header, const std::string& name) {
    std::vector<size_t> starts;
    size_t at = header.data;
    for (int y = 0; y < header.height; ++y) {
        starts.push_back(at);
        at = has_component_runs(data_of(bytes) + at, bytes.size() - at, header.width)
                 ? walk_component_runs(bytes, at, header.width, name, [](auto&&...) {})
                 : walk_pixels(bytes, at, header.width, name, [](auto&&...) {});
    }
    return starts;
}

void decode_scanline(Bytes bytes, size_t at, int width, const std::string& name, std::vector<Rgbe>& row) {
    if (has_component_runs(data_of(bytes) + at, bytes.size() - at, width))
        walk_component_runs(bytes, at, width, name,
                            [&](int component, int x, int count, const uint8_t* source, bool repeated) {
                                for (int i = 0; i < count; ++i)
                                    row[x + i][component] = source[repeated ? 0 : i];
                            });
    else
        walk_pixels(bytes, at, width, name, [&](int x, int count, const uint8_t* pixel) {
            std::fill_n(row.begin() + x, count, Rgbe{pixel[0], pixel[1], pixel[2], pixel[3]});
        });
}

/// 2^(e - 136) for each exponent byte; 0 for 0, which stands for black. A mantissa is taken as it is: adding
/// 0.5, as some readers do, would make black grey and a constant picture brighter.
std::array<float, 256> exponent_table() {
    std::array<float, 256> table{};
    for (int e = 1; e < 256; ++e) table[e] = std::ldexp(1.0f, e - 136);
    return table;
}

void write_row(Image& image, const HdrHeader& header, size_t row_in_file, const std::vector<Rgbe>& row) {
    static const std::array<float, 256> scale = exponent_table();
    const bool exposed = header.divisor != std::array<double, 3>{1, 1, 1};
    const int y = header.bottom_up ? header.height - 1 - int(row_in_file) : int(row_in_file);
    for (int x = 0; x < header.width; ++x) {
        const Rgbe& pixel = row[header.right_to_left ? header.width - 1 - x : x];
        float* to = image.at<float>(x, y);
        for (int c = 0; c < 3; ++c) to[c] = float(pixel[c]) * scale[pixel[3]];
        if (exposed)
            for (int c = 0; c < 3; ++c) to[c] = float(to[c] / header.divisor[c]);
    }
}

Rgbe rgbe_of(const float* color) {
    // The largest value that an exponent byte of 255 holds.
    constexpr float top = 255 * 0x1p119f;
    float value[3], most = 0;
    for (int c = 0; c < 3; ++c) {
        value[c] = color[c] > 0 ? std::min(color[c], top) : 0.0f;
        most = std::max(most, value[c]);
    }
    int exponent = 0;
    std::frexp(most, &exponent);
    if (std::lround(std::ldexp(most, 8 - exponent)) == 256) ++exponent;
    if (most == 0 || exponent < -127) return {0, 0, 0, 0};
    Rgbe out;
    for (int c = 0; c < 3; ++c) out[c] = uint8_t(std::lround(std::ldexp(value[c], 8 - exponent)));
    out[3] = uint8_t(exponent + 128);
    return out;
}

int run_length(const std::vector<Rgbe>& row, size_t x, int component, int most) {
    int count = 1;
    while (count < most && x + count < row.size() && row[x + count][component] == row[x][component]) ++count;
    return count;
}

void encode_component(const std::vector<Rgbe>& row, int component, std::vector<uint8_t>& out) {
    // A run costs 2 bytes, so it pays from 3 equal ones on; up to there they join the literals.
    for (size_t x = 0; x < row.size();) {
        const int run = run_length(row, x, component, 127);
        if (run >= 3) {
            out.push_back(uint8_t(128 + run));
            out.push_back(row[x][component]);
            x += size_t(run);
            continue;
        }
        const size_t begin = x;
        while (x < row.size() && x - begin < 128 && run_length(row, x, component, 3) < 3) ++x;
        out.push_back(uint8_t(x - begin));
        for (size_t i = begin; i < x; ++i) out.push_back(row[i][component]);
    }
}

void encode_scanline(const std::vector<Rgbe>& row, std::vector<uint8_t>& out) {
    if (row.size() < 8 || row.size() > 32767) {
        for (const Rgbe& pixel : row) out.insert(out.end(), pixel.begin(), pixel.end());
        return;
    }
    out.insert(out.end(), {2, 2, uint8_t(row.size() >> 8), uint8_t(row.size() & 255)});
    for (int component = 0; component < 4; ++component) encode_component(row, component, out);
}

}  // namespace

Image decode_hdr(Bytes bytes, const std::string& name) {
    const HdrHeader header = HeaderReader(bytes, name).read();
    const std::vector<size_t> starts = find_scanlines(bytes, header, name);
    Image image = make_image(header.width, header.height, 3, PixelType::f32, name);
    parallel_chunks(starts.size(), 16, [&](size_t begin, size_t end) {
        std::vector<Rgbe> row(size_t(header.width));
        for (size_t y = begin; y < end; ++y) {
            decode_scanline(bytes, starts[y], header.width, name, row);
            write_row(image, header, y, row);
        }
    });
    return image;
}

std::vector<std::byte> encode_hdr(const Image& image) {
    const Image rgb = with_channels(image, 3);
    const std::string header =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", rgb.height(), rgb.width());
    std::vector<uint8_t> out(header.begin(), header.end());
    std::vector<Rgbe> row(size_t(rgb.width()));
    for (int y = 0; y < rgb.height(); ++y) {
        for (int x = 0; x < rgb.width(); ++x) row[size_t(x)] = rgbe_of(rgb.at<float>(x, y));
        encode_scanline(row, out);
    }
    const auto* begin = reinterpret_cast<const std::byte*>(out.data());
    return {begin, begin + out.size()};
}

}  // namespace easypbr::io
