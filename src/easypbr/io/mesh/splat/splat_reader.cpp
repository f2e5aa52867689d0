// .splat files, as viewers in browsers read them: 32 bytes for each 3D Gaussian. Position and scales as
// float32, colour and opacity as four bytes, the quaternion w, x, y, z as bytes of which 128 is 0.
#include <fmt/format.h>

#include <cstring>

#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/splat_columns.h"

namespace easypbr::io {
namespace {

constexpr size_t record_size = 32, splat_grain = 1 << 15;

struct SplatRecord {
    float position[3], scales[3];
    uint8_t color[4], rotation[4];
};
static_assert(sizeof(SplatRecord) == record_size);

SplatRecord record_at(const Source& source, Eigen::Index i) {
    SplatRecord record;
    std::memcpy(&record, source.begin() + size_t(i) * record_size, record_size);
    return record;
}

void check_records(const Source& source, const MeshData& mesh) {
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
        const auto scales = mesh.splats.scales.row(i);
        if (!mesh.V.row(i).allFinite() || !scales.allFinite() || scales.minCoeff() < 0)
            fail_at_byte(source, source.begin() + size_t(i) * record_size,
                         fmt::format("splat {} of {} has a position or scale that is not finite, or a scale "
                                     "below 0",
                                     i, mesh.V.rows()));
    }
}

}  // namespace

MeshData read_splat(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    if (source.bytes.size() % record_size)
        fail(source, fmt::format("no .splat file: {} bytes are not a multiple of {}, those of a splat",
                                 source.bytes.size(), record_size));
    const size_t count = source.bytes.size() / record_size;
    if (count > INT32_MAX)
        fail(source, fmt::format("{} splats are more than the {} that are read", count, INT32_MAX));
    charge_memory(count * 14 * sizeof(float), "its splats");
    const auto rows = Eigen::Index(count);
    Array3f::Dense V(rows, 3), scales(rows, 3);
    Array4f::Dense rotations(rows, 4);
    Array1f::Dense opacities(rows);
    ArrayXf::Dense sh(rows, 3);
    parallel_for(count, splat_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        const SplatRecord record = record_at(source, i);
        for (int k = 0; k < 3; ++k) {
            V(i, k) = record.position[k];
            scales(i, k) = record.scales[k];
            sh(i, k) = constant_of_color(float(record.color[k]) / 255);
        }
        opacities(i) = float(record.color[3]) / 255;
        for (int k = 0; k < 4; ++k) rotations(i, k) = (float(record.rotation[k]) - 128) / 128;
        // All bytes 128: nothing was said.
        if (rotations.row(i).isZero(0)) rotations(i, 0) = 1;
    });
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    check_records(source, mesh);
    mesh.up = splat_up;
    return mesh;
}

}  // namespace easypbr::io
