#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <numeric>
#include <vector>

#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/archive/zstandard.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/splat/spz_layout.h"
#include "easypbr/io/tables/splat_rows.h"

namespace easypbr::io {
namespace {

bool is_spz4(const Source& source) {
    return source.bytes.size() >= sizeof spz_magic &&
           std::memcmp(source.bytes.data(), &spz_magic, sizeof spz_magic) == 0;
}

SpzHeader begin_of_spz4(const Source& source) {
    SpzHeader header;
    if (source.bytes.size() < sizeof(Spz4Header))
        fail(source, "truncated: an SPZ file has 32 bytes at least");
    std::memcpy(&header, source.bytes.data(), sizeof header);
    if (header.version != 4)
        fail(source, fmt::format("SPZ of version {}, plain: version 4 is read", header.version));
    return header;
}

SpzHeader begin_of_gzip(const Source& source) {
    SpzHeader header;
    const Inflated begin =
        inflate_into(source.bytes, DeflateForm::gzip, {reinterpret_cast<char*>(&header), sizeof header});
    if (begin.written < sizeof header || header.magic != spz_magic)
        fail(source, "no SPZ file: it does not begin with the gzip-compressed header of one");
    if (header.version < 2 || header.version > 3)
        fail(source, fmt::format("SPZ of version {}: versions 2 to 4 are read", header.version));
    return header;
}

SpzHeader read_spz_header(const Source& source) {
    const SpzHeader header = is_spz4(source) ? begin_of_spz4(source) : begin_of_gzip(source);
    const int most_degree = header.version == 4 ? most_spz4_degree : most_spz_degree;
    if (header.degree > most_degree)
        fail(source,
             fmt::format("spherical harmonics of degree {}: 0 to {} are read", header.degree, most_degree));
    if (header.fractional_bits > 30)
        fail(source,
             fmt::format("positions of {} fractional bits: 0 to 30 are read", header.fractional_bits));
    return header;
}

/// The arrays of a file, one after the other.
class SpzArrays {
  public:
    SpzArrays(const Source& source, const SpzHeader& header)
        : sizes_(header.version, header.degree), count_(header.count) {
        if (header.version == 4)
            unpack_each(source);
        else
            inflate(source);
        position = bytes_.get() + (header.version == 4 ? 0 : sizeof header);
        alpha = position + count_ * sizes_.position;
        color = alpha + count_ * sizes_.alpha;
        scale = color + count_ * sizes_.color;
        rotation = scale + count_ * sizes_.scale;
        harmonics = rotation + count_ * sizes_.rotation;
    }

    const uint8_t *position, *alpha, *color, *scale, *rotation, *harmonics;

  private:
    void inflate(const Source& source) {
        const uint64_t size = uint64_t(count_) * sizes_.all(), with_header = size + sizeof(SpzHeader);
        const auto refuse = [&](uint64_t found) {
            fail(source, fmt::format("truncated or damaged: {} splats take {} bytes unpacked, and there are "
                                     "at most {}",
                                     count_, with_header, found));
        };
        if (with_header / best_deflate_ratio > source.bytes.size())
            refuse(uint64_t(source.bytes.size()) * best_deflate_ratio);
        charge_memory(with_header, "its unpacked bytes");
        bytes_.reset(new uint8_t[with_header]);
        const Inflated inflated = inflate_into(source.bytes, DeflateForm::gzip,
                                               {reinterpret_cast<char*>(bytes_.get()), with_header});
        if (inflated.written < with_header || inflated.damaged) refuse(inflated.written);
    }

    /// Of version 4: the table says where each array is that is not empty.
    void unpack_each(const Source& source) {
        Spz4Header header;
        std::memcpy(&header, source.bytes.data(), sizeof header);
        std::vector<size_t> expected;
        for (const size_t size : sizes_.each())
            if (size * count_ > 0) expected.push_back(size * count_);
        const size_t arrays = header.common.reserved, table_bytes = arrays * sizeof(Spz4Entry);
        if (arrays != expected.size())
            fail(source, fmt::format("{} arrays: {} splats have {}", arrays, count_, expected.size()));
        if (header.table < sizeof header || header.table > source.bytes.size() ||
            source.bytes.size() - header.table < table_bytes)
            fail(source, "truncated or damaged: its table of arrays lies beyond the file's end");
        std::vector<Spz4Entry> table(arrays);
        std::memcpy(table.data(), source.bytes.data() + header.table, table_bytes);
        std::string_view rest = source.bytes.substr(header.table + table_bytes);
        std::vector<std::string_view> packed;
        for (size_t i = 0; i < arrays; ++i) {
            if (table[i].unpacked != expected[i])
                fail(source, fmt::format("damaged: an array of {} bytes for {} splats, which take {}",
                                         table[i].unpacked, count_, expected[i]));
            if (table[i].packed > rest.size())
                fail(source, "truncated or damaged: its arrays end beyond the file's end");
            packed.push_back(rest.substr(0, table[i].packed));
            rest.remove_prefix(table[i].packed);
        }
        const uint64_t size = uint64_t(count_) * sizes_.all();
        charge_memory(size, "its unpacked bytes");
        bytes_.reset(new uint8_t[size]);
        if (size == 0) return;
        std::atomic<bool> is_whole = true;
        std::vector<size_t> first(arrays, 0);
        std::partial_sum(expected.begin(), expected.end() - 1, first.begin() + 1);
        parallel_for(arrays, 1, [&](size_t i) {
            char* to = reinterpret_cast<char*>(bytes_.get()) + first[i];
            if (!unpack_zstandard(packed[i], {to, expected[i]})) is_whole = false;
        });
        if (!is_whole) fail(source, "damaged: an array cannot be unpacked");
    }

    SpzSizes sizes_;
    size_t count_;
    std::unique_ptr<uint8_t[]> bytes_;
};

/// 24 bits, little-endian, two's complement.
float spz_coordinate(const uint8_t* bytes, float unit) {
    const uint32_t bits = uint32_t(bytes[0]) << 8 | uint32_t(bytes[1]) << 16 | uint32_t(bytes[2]) << 24;
    return float(int32_t(bits) >> 8) * unit;
}

/// Version 3: two bits say which component is the largest; of the others the last comes first.
void read_smallest_three(const uint8_t* bytes, Eigen::Index i, SplatRows& rows) {
    uint32_t code;
    std::memcpy(&code, bytes, sizeof code);
    const int largest = int(code >> 30);
    float xyzw[4];
    float squares = 0;
    for (int k = 3; k >= 0; --k) {
        if (k == largest) continue;
        const float size = std::sqrt(0.5f) * float(int(code) & spz_rotation_most) / spz_rotation_most;
        xyzw[k] = code >> spz_rotation_bits & 1 ? -size : size;
        squares += size * size;
        code >>= spz_rotation_bits + 1;
    }
    xyzw[largest] = std::sqrt(std::max(0.0f, 1 - squares));
    for (int k = 0; k < 4; ++k) rows.rotations(i, k) = xyzw[spz_components[size_t(k)]];
}

/// Version 2: x, y, z of a rotation with w of 0 or more.
void read_first_three(const uint8_t* bytes, Eigen::Index i, SplatRows& rows) {
    const Vec3 xyz = (Vec3(bytes[0], bytes[1], bytes[2]) / 127.5f).array() - 1;
    complete_rotation(rows.rotations, i, 0, xyz);
}

void read_spz_splat(const SpzHeader& header, const SpzArrays& arrays, const SpzSizes& sizes, size_t row,
                    SplatRows& rows) {
    const auto i = Eigen::Index(row);
    const float unit = std::ldexp(1.0f, -header.fractional_bits);
    for (int k = 0; k < 3; ++k) {
        rows.V(i, k) = spz_coordinate(arrays.position + row * sizes.position + 3 * k, unit);
        const float scale = arrays.scale[row * sizes.scale + size_t(k)];
        rows.scales(i, k) = std::exp((scale - spz_scale_zero) / spz_scale_step);
        const float color = arrays.color[row * sizes.color + size_t(k)];
        rows.sh(i, k) = (color - spz_color_zero) / spz_color_step;
    }
    rows.opacities(i) = float(arrays.alpha[row]) / 255;
    const uint8_t* rotation = arrays.rotation + row * sizes.rotation;
    header.version >= 3 ? read_smallest_three(rotation, i, rows) : read_first_three(rotation, i, rows);
    const size_t used = size_t(rows.sh.cols()) - 3;  // beyond degree 3 none are
    for (size_t k = 0; k < used; ++k)
        rows.sh(i, Eigen::Index(3 + k)) =
            (float(arrays.harmonics[row * sizes.harmonics + k]) - spz_harmonic_zero) / spz_harmonic_step;
}

}  // namespace

MeshData read_spz(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    const SpzHeader header = read_spz_header(source);
    if (header.flags & spz_has_extensions)
        log_warning(fmt::format("{}: extensions of SPZ are not read", source.path.string()));
    const SpzArrays arrays(source, header);
    const SpzSizes sizes(header.version, header.degree);
    if (header.degree > most_spz_degree)
        log_warning(fmt::format("{}: spherical harmonics of degree {}: what is beyond {} is left out",
                                source.path.string(), header.degree, most_spz_degree));
    SplatRows rows(source, header.count, std::min<int>(header.degree, most_spz_degree));
    parallel_for(rows.count(), spz_grain,
                 [&](size_t row) { read_spz_splat(header, arrays, sizes, row, rows); });
    return rows.finish(source, spz_up);
}

}  // namespace easypbr::io
