#include "easypbr/io/mesh/ply/compressed_splats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/splat_columns.h"
#include "easypbr/io/tables/splat_names.h"
#include "easypbr/io/tables/splat_rows.h"

namespace easypbr::io {
namespace {

constexpr size_t chunk_splats = 256, packed_grain = 1 << 14;
constexpr auto packed_position = packed_splat_names[0], packed_rotation = packed_splat_names[1],
               packed_scale = packed_splat_names[2], packed_color = packed_splat_names[3];

/// Where a property of an element lies in the file.
struct PackedColumn {
    const char* begin = nullptr;
    size_t stride = 0;

    template <class T>
    T at(size_t row) const {
        T value;
        std::memcpy(&value, begin + row * stride, sizeof value);
        return value;
    }
};

/// The rows of an element, which has no lists.
class PackedTable {
  public:
    PackedTable(const Source& source, const Element& element, const char* begin)
        : source_(source), element_(element), begin_(begin) {
        for (const Property& property : element.properties) {
            if (property.count_type)
                fail(source, fmt::format("packed splats have no lists, and '{}' is one", property.name));
            stride_ += size_of(property.type);
        }
        const auto left = size_t(source.end() - begin);
        if (element.count > left / stride_)
            fail(source, fmt::format("truncated: {} rows of '{}' take {} bytes each, but {} bytes are left",
                                     element.count, element.name, stride_, left));
    }

    size_t count() const { return element_.count; }
    const char* end() const { return begin_ + element_.count * stride_; }

    std::optional<PackedColumn> find(std::string_view name, ScalarType type) const {
        size_t place = 0;
        for (const Property& property : element_.properties) {
            if (property.name == name && property.type == type) return PackedColumn{begin_ + place, stride_};
            place += size_of(property.type);
        }
        return std::nullopt;
    }

    PackedColumn require(std::string_view name, ScalarType type) const {
        if (const auto column = find(name, type)) return *column;
        fail(source_, fmt::format("packed splats: element '{}' has no property '{}' of the expected type",
                                  element_.name, name));
    }

    /// Numbers of these names; nothing when the first is missing.
    template <size_t n>
    std::optional<std::array<PackedColumn, n>> floats(const std::array<const char*, n>& names) const {
        if (!find(names[0], ScalarType::float32)) return std::nullopt;
        std::array<PackedColumn, n> columns;
        for (size_t k = 0; k < n; ++k) columns[k] = require(names[k], ScalarType::float32);
        return columns;
    }

  private:
    const Source& source_;
    const Element& element_;
    const char* begin_;
    size_t stride_ = 0;
};

/// The value of some bits, from 0 to 1.
float part_of(uint32_t code, int shift, int bits) {
    const uint32_t most = (1u << bits) - 1;
    return float(code >> shift & most) / float(most);
}

/// 11, 10 and 11 bits.
Vec3 unpacked_vector(uint32_t code) {
    return {part_of(code, 21, 11), part_of(code, 11, 10), part_of(code, 0, 11)};
}

/// Bounds of a chunk for three numbers.
struct ChunkBounds {
    std::array<PackedColumn, 6> columns;

    Vec3 at(size_t chunk, const Vec3& part) const {
        Vec3 value;
        for (size_t k = 0; k < 3; ++k) {
            const float low = columns[k].at<float>(chunk), high = columns[k + 3].at<float>(chunk);
            value[Eigen::Index(k)] = low * (1 - part[Eigen::Index(k)]) + high * part[Eigen::Index(k)];
        }
        return value;
    }
};

class PackedReader {
  public:
    PackedReader(const Source& source, const PlyHeader& header) : source_(source), header_(header) {
        if (header.format != PlyFormat::binary_little_endian)
            fail(source, "packed splats are read from binary little-endian PLY");
        const char* place = header.body;
        for (const Element& element : header.elements) {
            const PackedTable table(source, element, place);
            place = table.end();
            if (element.name == "chunk") chunks_.emplace(table);
            if (element.name == "vertex") splats_.emplace(table);
            if (element.name == "sh") harmonics_.emplace(table);
        }
        if (!chunks_) fail(source, "packed splats have an element 'chunk' with the bounds; it is missing");
    }

    MeshData read() {
        const size_t count = splats_->count(), needed = (count + chunk_splats - 1) / chunk_splats;
        if (chunks_->count() < needed)
            fail(source_, fmt::format("{} packed splats have {} chunks of {}; there are {}", count, needed,
                                      chunk_splats, chunks_->count()));
        plan_harmonics(count);
        SplatRows rows(source_, count, degree_);
        const PackedColumn position = packed(packed_position), rotation = packed(packed_rotation),
                           scale = packed(packed_scale), color = packed(packed_color);
        const ChunkBounds positions{*required({"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"})};
        const ChunkBounds scales{*required(
            {"min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})};
        std::optional<ChunkBounds> colors;
        // Files of before have none: the colours are from 0 to 1.
        if (const auto columns = chunks_->floats<6>({"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"}))
            colors = ChunkBounds{*columns};
        parallel_for(count, packed_grain, [&](size_t row) {
            const auto i = Eigen::Index(row);
            const size_t chunk = row / chunk_splats;
            rows.V.row(i) = positions.at(chunk, unpacked_vector(position.at<uint32_t>(row))).transpose();
            const Vec3 logs = scales.at(chunk, unpacked_vector(scale.at<uint32_t>(row)));
            rows.scales.row(i) = logs.array().exp().matrix().transpose();
            unpack_rotation(rotation.at<uint32_t>(row), i, rows);
            const auto code = color.at<uint32_t>(row);
            const Vec3 part(part_of(code, 24, 8), part_of(code, 16, 8), part_of(code, 8, 8));
            rows.set_color(i, colors ? colors->at(chunk, part) : part);
            rows.opacities(i) = part_of(code, 0, 8);
            unpack_harmonics(row, rows);
        });
        return rows.finish(source_, header_.up.value_or(splat_up));
    }

  private:
    PackedColumn packed(std::string_view name) const { return splats_->require(name, ScalarType::uint32); }

    std::optional<std::array<PackedColumn, 6>> required(const std::array<const char*, 6>& names) const {
        const auto columns = chunks_->floats<6>(names);
        if (!columns) fail(source_, fmt::format("packed splats: element 'chunk' has no '{}'", names[0]));
        return columns;
    }

    void plan_harmonics(size_t count) {
        if (!harmonics_) return;
        if (harmonics_->count() != count)
            fail(source_, fmt::format("packed splats: {} rows of spherical harmonics for {} splats",
                                      harmonics_->count(), count));
        while (const auto column = harmonics_->find(harmonic_name(rest_.size()), ScalarType::uint8))
            rest_.push_back(*column);
        constexpr std::array<size_t, 4> counts{0, 9, 24, 45};
        const auto found = std::ranges::find(counts, rest_.size());
        if (found == counts.end())
            fail(source_, fmt::format("packed splats have 0, 9, 24 or 45 properties f_rest_N; found {}",
                                      rest_.size()));
        degree_ = int(found - counts.begin());
    }

    /// Two bits say which of w, x, y, z is the largest; 10 bits for each of the others.
    static void unpack_rotation(uint32_t code, Eigen::Index i, SplatRows& rows) {
        const Vec3 parts(part_of(code, 20, 10), part_of(code, 10, 10), part_of(code, 0, 10));
        complete_rotation(rows.rotations, i, Eigen::Index(code >> 30),
                          (parts.array() - 0.5f) * std::sqrt(2.0f));
    }

    /// From -4 to 4, channel by channel.
    void unpack_harmonics(size_t row, SplatRows& rows) const {
        const size_t of_channel = rest_.size() / 3;
        for (size_t k = 0; k < rest_.size(); ++k)
            rows.sh(Eigen::Index(row), harmonic_column(k % of_channel, k / of_channel)) =
                float(rest_[k].at<uint8_t>(row)) * (8.0f / 255) - 4;
    }

    const Source& source_;
    const PlyHeader& header_;
    std::optional<PackedTable> chunks_, splats_, harmonics_;
    std::vector<PackedColumn> rest_;
    int degree_ = 0;
};

}  // namespace

bool has_compressed_splats(const PlyHeader& header) {
    return std::ranges::any_of(header.elements, [](const Element& element) {
        return element.name == "vertex" && std::ranges::any_of(element.properties, [](const Property& p) {
                   return p.name == packed_position;
               });
    });
}

MeshData read_compressed_splats(const Source& source, const PlyHeader& header) {
    return PackedReader(source, header).read();
}

}  // namespace easypbr::io
