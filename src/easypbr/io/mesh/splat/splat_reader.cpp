// .splat files, as viewers in browsers read them: 32 bytes for each 3D Gaussian. Position and scales as
// float32, colour and opacity as four bytes, the quaternion w, x, y, z as bytes of which 128 is 0.
#include <fmt/format.h>

#include <cstring>

#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/splat_rows.h"

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

void check_records(const Source& source, const SplatRows& rows) {
    for (Eigen::Index i = 0; i < rows.V.rows(); ++i) {
        const auto scales = rows.scales.row(i);
        if (!rows.V.row(i).allFinite() || !scales.allFinite() || scales.minCoeff() < 0)
            fail_at_byte(source, source.begin() + size_t(i) * record_size,
                         fmt::format("splat {} of {} has a position or scale that is not finite, or a scale "
                                     "below 0",
                                     i, rows.V.rows()));
    }
}

}  // namespace

MeshData read_splat(const Source& source) {
    if (source.bytes.empty()) fail(source, "the file is empty");
    if (source.bytes.size() % record_size)
        fail(source, fmt::format("no .splat file: {} bytes are not a multiple of {}, those of a splat",
                                 source.bytes.size(), record_size));
    SplatRows rows(source, source.bytes.size() / record_size, 0);
    parallel_for(rows.count(), splat_grain, [&](size_t row) {
        const auto i = Eigen::Index(row);
        const SplatRecord record = record_at(source, i);
        for (int k = 0; k < 3; ++k) {
            rows.V(i, k) = record.position[k];
            rows.scales(i, k) = record.scales[k];
        }
        rows.set_color(i, Vec3(record.color[0], record.color[1], record.color[2]) / 255);
        rows.opacities(i) = float(record.color[3]) / 255;
        for (int k = 0; k < 4; ++k) rows.rotations(i, k) = (float(record.rotation[k]) - 128) / 128;
        // All bytes 128: nothing was said.
        if (rows.rotations.row(i).isZero(0)) rows.rotations(i, 0) = 1;
    });
    check_records(source, rows);
    return rows.finish(source, splat_up);
}

}  // namespace easypbr::io
