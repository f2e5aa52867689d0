#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>

#include "easypbr/core/parallel.h"
#include "easypbr/io/mesh/cloud_reader.h"
#include "easypbr/io/mesh/las/las_header.h"
#include "easypbr/io/mesh/las/laz.h"
#include "easypbr/io/mesh/mesh_readers.h"
#include "easypbr/scene/label_map.h"

namespace easypbr::io {
namespace {

constexpr size_t las_grain = 1 << 16;

/// Seconds since some year are too many for float32: those of the first point's whole second are left out.
void shorten_times(const char* first_record, std::vector<Property>& fields) {
    size_t place = 0;
    for (Property& field : fields) {
        if (field.name == "gps_time" && !field.is_extra) {
            double seconds;
            std::memcpy(&seconds, first_record + place, sizeof seconds);
            if (std::isfinite(seconds)) field.shift = -std::floor(seconds);
        }
        place += size_of(field.type);
    }
}

/// The number of returns stands in the same byte as the return number.
void split_returns(bool new_layout, MeshData& mesh) {
    const auto found = std::ranges::find_if(
        mesh.scalars, [](const ScalarArray& scalar) { return scalar.name == "return_number"; });
    if (found == mesh.scalars.end()) return;
    const int bits = new_layout ? 4 : 3, mask = (1 << bits) - 1;
    const Array1f both = found->values;
    Array1f::Dense number(both.rows()), total(both.rows());
    parallel_for(size_t(both.rows()), las_grain, [&](size_t i) {
        const int byte = int(both[Eigen::Index(i)]);
        number[Eigen::Index(i)] = float(byte & mask);
        total[Eigen::Index(i)] = float(byte >> bits & mask);
    });
    found->values = std::move(number);
    mesh.scalars.insert(found + 1, {"number_of_returns", std::move(total)});
}

void clear_class_flags(MeshData& mesh) {
    Array1i::Dense L(mesh.L.rows());
    constexpr int32_t class_bits = 31;
    parallel_for(size_t(L.rows()), las_grain,
                 [&](size_t i) { L[Eigen::Index(i)] = mesh.L[Eigen::Index(i)] & class_bits; });
    mesh.L = std::move(L);
}

bool is_zero(const float* values, size_t count) {
    std::atomic<bool> zero{true};
    parallel_chunks(count, las_grain, [&](size_t begin, size_t end) {
        if (zero && std::any_of(values + begin, values + end, [](float v) { return v != 0; })) zero = false;
    });
    return zero;
}

/// Colours should span 16 bits; many programs write 8 into them.
void scale_colors(MeshData& mesh) {
    if (mesh.C.empty()) return;
    if (is_zero(mesh.C.data(), size_t(mesh.C.size()))) {
        mesh.C = {};
        return;
    }
    constexpr float largest_byte = 255.5f / 65535;
    if (mesh.C.maxCoeff() > largest_byte) return;
    mesh.C = ArrayXf::Dense(mesh.C * (65535.0f / 255));
}

MeshData read_records(const Source& source, const Source& records, const LasHeader& header) {
    const size_t left = size_t(records.end() - records.begin());
    if (header.points == 0) fail(source, "no points");
    if (header.points > left / header.record_size)
        fail(source, fmt::format("truncated: {} points of {} bytes expected, but {} bytes are left",
                                 header.points, header.record_size, left));
    Element points{"point", header.points, las_fields(header)};
    points.properties.insert(points.properties.end(), header.extra.begin(), header.extra.end());
    shorten_times(records.begin(), points.properties);
    MeshData mesh = read_binary_cloud(source, {{records, records.begin(), std::endian::little, {points}}});
    split_returns(header.has_new_layout(), mesh);
    if (!header.has_new_layout()) clear_class_flags(mesh);
    scale_colors(mesh);
    std::erase_if(mesh.scalars, [](const ScalarArray& scalar) {
        return is_zero(scalar.values.data(), size_t(scalar.values.rows()));
    });
    mesh.label_map = built_in_label_map("asprs");
    return mesh;
}

std::mutex decompressor_mutex;
LazDecompressor decompressor;

std::string decompressed(const Source& source, const LasHeader& header) {
    LazDecompressor decompress;
    {
        const std::lock_guard lock(decompressor_mutex);
        decompress = decompressor;
    }
    if (!decompress)
        fail(source,
             "compressed points (LAZ) are read by the Python package alone, with lazrs (pip install lazrs); "
             "elsewhere decompress the file first, with laszip or las2las");
    if (header.laszip.empty())
        fail(source, "its points are compressed (LAZ), but the record of LASzip is missing");
    // What is compressed can hardly become more than this; a header that lies must not take all memory.
    constexpr size_t largest_ratio = 1000;
    const size_t left = source.bytes.size() - header.body;
    if (header.points / largest_ratio > left / header.record_size)
        fail(source, fmt::format("truncated: {} compressed points expected, but {} bytes are left",
                                 header.points, left));
    const size_t size = header.points * header.record_size;
    try {
        std::string records = decompress(header.laszip, source.bytes.substr(header.body), header.body, size);
        if (records.size() != size)
            fail(source, fmt::format("{} bytes of points expected, got {}", size, records.size()));
        return records;
    } catch (const FormatError&) {
        throw;
    } catch (const Error& error) {
        fail(source, error.what());
    }
}

}  // namespace

void set_laz_decompressor(LazDecompressor given) {
    const std::lock_guard lock(decompressor_mutex);
    decompressor = std::move(given);
}

MeshData read_las(const Source& source) {
    const LasHeader header = parse_las_header(source);
    const std::string records = header.compressed ? decompressed(source, header) : std::string();
    const Source body = header.compressed ? Source(records, source.path) : source.from(header.body);
    MeshData mesh = read_records(source, body, header);
    drop_points_without_position(source, mesh);
    mesh.up = Vec3d::UnitZ();
    return mesh;
}

}  // namespace easypbr::io
