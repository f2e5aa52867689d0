#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "easypbr/core/log.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/splat/spz_layout.h"
#include "easypbr/io/tables/splat_rows.h"

namespace easypbr::io {
namespace {

SpzHeader read_spz_header(const Source& source) {
    SpzHeader header;
    const Inflated begin =
        inflate_into(source.bytes, DeflateForm::gzip, {reinterpret_cast<char*>(&header), sizeof header});
    if (begin.written < sizeof header || header.magic != spz_magic)
        fail(source, "no SPZ file: it does not begin with the gzip-compressed header of one");
    if (header.version < 2 || header.version > 3)
        fail(source, fmt::format("SPZ of version {}: versions 2 and 3 are read", header.version));
    if (header.degree > most_spz_degree)
        fail(source, fmt::format("spherical harmonics of degree {}: 0 to {} are read", header.degree,
                                 most_spz_degree));
    if (header.fractional_bits > 30)
        fail(source,
             fmt::format("positions of {} fractional bits: 0 to 30 are read", header.fractional_bits));
    return header;
}

/// The arrays of a file, one after the other.
class SpzArrays {
  public:
    SpzArrays(const Source& source, const SpzHeader& header) : sizes_(header.version, header.degree) {
        const uint64_t size = sizeof header + uint64_t(header.count) * sizes_.all();
        const auto refuse = [&](uint64_t found) {
            fail(source,
                 fmt::format("truncated or damaged: {} splats of degree {} take {} bytes unpacked, and "
                             "there are at most {}",
                             header.count, header.degree, size, found));
        };
        if (size / best_deflate_ratio > source.bytes.size())
            refuse(uint64_t(source.bytes.size()) * best_deflate_ratio);
        charge_memory(size, "its unpacked bytes");
        bytes_.reset(new uint8_t[size]);
        const Inflated inflated =
            inflate_into(source.bytes, DeflateForm::gzip, {reinterpret_cast<char*>(bytes_.get()), size});
        if (inflated.written < size || inflated.damaged) refuse(inflated.written);
        const size_t count = header.count;
        position = bytes_.get() + sizeof header;
        alpha = position + count * sizes_.position;
        color = alpha + count * sizes_.alpha;
        scale = color + count * sizes_.color;
        rotation = scale + count * sizes_.scale;
        harmonics = rotation + count * sizes_.rotation;
    }

    const uint8_t *position, *alpha, *color, *scale, *rotation, *harmonics;

  private:
    SpzSizes sizes_;
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
    for (size_t k = 0; k < sizes.harmonics; ++k)
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
    SplatRows rows(source, header.count, header.degree);
    parallel_for(rows.count(), spz_grain,
                 [&](size_t row) { read_spz_splat(header, arrays, sizes, row, rows); });
    return rows.finish(source, spz_up);
}

}  // namespace easypbr::io
