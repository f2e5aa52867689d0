#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/archive/deflate.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/mesh/splat/spz_layout.h"
#include "easypbr/scene/splat_transform.h"

namespace easypbr::io {
namespace {

constexpr uint32_t written_version = 3;
constexpr double most_fixed = (1 << 23) - 1;  ///< of a coordinate's code
/// Smaller codes compress well: those of degree 1 are multiples of 8, the others of 16, as is usual.
constexpr int first_degree_step = 8, other_degrees_step = 16;

uint8_t code_of(float value, float step, float zero) {
    return uint8_t(std::clamp(std::round(value * step + zero), 0.0f, 255.0f));
}

uint8_t harmonic_code(float value, int step) {
    const int code = int(code_of(value, spz_harmonic_step, spz_harmonic_zero));
    return uint8_t(std::min(255, (code + step / 2) / step * step));
}

/// Splats in the axes of the format.
struct SpzSplats {
    SplatArrays splats;
    Mat3d turn = Mat3d::Identity();

    explicit SpzSplats(const MeshData& mesh) : splats(mesh.splats) {
        // Half a turn about x leads from the axes of COLMAP, where y points down.
        if (!(mesh.up.y() < 0)) return;
        turn = Vec3d(1, -1, -1).asDiagonal();
        splats = transformed_splats(mesh.splats, turn);
    }
    Vec3d position(const MeshData& mesh, Eigen::Index i) const {
        return turn * (mesh.V.row(i).transpose().cast<double>() + mesh.offset);
    }
};

/// As many as the largest coordinate leaves of 23, but no more than tell floats near 1 apart.
int fractional_bits_of(const MeshData& mesh) {
    const Vec3d low = mesh.V.colwise().minCoeff().transpose().cast<double>() + mesh.offset;
    const Vec3d high = mesh.V.colwise().maxCoeff().transpose().cast<double>() + mesh.offset;
    const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
    if (farthest > most_fixed)
        throw ArgumentError(fmt::format("cannot write SPZ: a coordinate of {} is beyond the {} that it holds",
                                        farthest, most_fixed));
    if (farthest <= most_fixed / (1 << 24)) return 24;
    return std::clamp(int(std::floor(std::log2(most_fixed / farthest))), 0, 24);
}

/// Far from zero the steps of positions are large.
void warn_of_coarse_positions(const SplatArrays& splats, int fractional_bits) {
    const double step = std::ldexp(1.0, -fractional_bits);
    const Eigen::Index fine = (splats.scales.rowwise().maxCoeff().cast<double>().array() < step).count();
    if (2 * fine <= splats.scales.rows()) return;
    log_warning(
        fmt::format("SPZ holds positions this far from zero in steps of {:.3g}, and {} of {} splats are "
                    "smaller: move them near zero (offset), or write PLY or GLB",
                    step, fine, splats.scales.rows()));
}

void write_spz_rotation(const SplatArrays& splats, Eigen::Index i, uint8_t* out) {
    Eigen::RowVector4f wxyz = splats.rotations.row(i).normalized();
    float xyzw[4];
    for (int k = 0; k < 4; ++k) xyzw[spz_components[size_t(k)]] = wxyz[k];
    int largest = 0;
    for (int k = 1; k < 4; ++k)
        if (std::abs(xyzw[k]) > std::abs(xyzw[largest])) largest = k;
    uint32_t code = uint32_t(largest);
    for (int k = 0; k < 4; ++k) {
        if (k == largest) continue;
        const uint32_t negative = (xyzw[k] < 0) != (xyzw[largest] < 0);
        const float size = std::abs(xyzw[k]) / std::sqrt(0.5f) * spz_rotation_most;
        code = code << (spz_rotation_bits + 1) | negative << spz_rotation_bits |
               std::min(uint32_t(std::lround(size)), uint32_t(spz_rotation_most));
    }
    std::memcpy(out, &code, sizeof code);
}

void write_spz_position(const Vec3d& position, int fractional_bits, uint8_t* out) {
    for (int k = 0; k < 3; ++k) {
        const double fixed = std::round(std::ldexp(position[k], fractional_bits));
        const auto code = int32_t(std::clamp(fixed, -most_fixed, most_fixed));
        for (int byte = 0; byte < 3; ++byte) *out++ = uint8_t(code >> (8 * byte));
    }
}

}  // namespace

std::string encode_spz(const MeshData& mesh) {
    if (mesh.splats.empty()) throw ArgumentError("cannot write SPZ: the mesh has no splats");
    const SpzSplats written(mesh);
    const SplatArrays& splats = written.splats;
    const auto count = size_t(mesh.V.rows());
    const int fractional_bits = fractional_bits_of(mesh);
    warn_of_coarse_positions(splats, fractional_bits);
    const SpzHeader header{
        spz_magic, written_version, uint32_t(count), uint8_t(splats.degree()), uint8_t(fractional_bits), 0,
        0};
    const SpzSizes sizes(written_version, splats.degree());
    std::string out(sizeof header + count * sizes.all(), '\0');
    std::memcpy(out.data(), &header, sizeof header);
    auto* const position = reinterpret_cast<uint8_t*>(out.data()) + sizeof header;
    uint8_t* const alpha = position + count * sizes.position;
    uint8_t* const color = alpha + count * sizes.alpha;
    uint8_t* const scale = color + count * sizes.color;
    uint8_t* const rotation = scale + count * sizes.scale;
    uint8_t* const harmonics = rotation + count * sizes.rotation;
    parallel_for(count, spz_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        write_spz_position(written.position(mesh, i), header.fractional_bits,
                           position + row * sizes.position);
        alpha[row] = code_of(splats.opacities(i), 255, 0);
        for (int k = 0; k < 3; ++k) {
            color[row * 3 + size_t(k)] = code_of(splats.sh(i, k), spz_color_step, spz_color_zero);
            const float log_scale = std::log(std::max(splats.scales(i, k), 1e-30f));
            scale[row * 3 + size_t(k)] = code_of(log_scale, spz_scale_step, spz_scale_zero);
        }
        write_spz_rotation(splats, i, rotation + row * sizes.rotation);
        for (size_t k = 0; k < sizes.harmonics; ++k)
            harmonics[row * sizes.harmonics + k] = harmonic_code(
                splats.sh(i, Eigen::Index(3 + k)), k < 9 ? first_degree_step : other_degrees_step);
    });
    return gzip(out);
}

}  // namespace easypbr::io
