#include "easypbr/io/mesh/gltf/gltf_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "easypbr/core/color.h"
#include "easypbr/core/error.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"

namespace easypbr::io {
namespace {

constexpr size_t block_grain = 1 << 15;

void encode_colors(ArrayXf::Dense& C) {
    parallel_for(size_t(C.rows()), block_grain, [&](size_t i) {
        for (int c = 0; c < 3; ++c) {
            float& value = C(Eigen::Index(i), c);
            value = value > 0 ? srgb_from_linear(std::min(value, 1.0f)) : 0.0f;
        }
    });
}

/// Normals that are unit vectors keep their bits; quantised ones are brought to unit length.
void normalize_rows(ArrayXf::Dense& N) {
    parallel_for(size_t(N.rows()), block_grain, [&](size_t i) {
        auto row = N.row(Eigen::Index(i));
        const float length = row.norm();
        if (!(length > 1e-20f && length < 1e20f))
            row << 0, 0, 1;
        else if (std::abs(length - 1) > 1e-3f)
            row /= length;
    });
}

/// Unit directions and signs of 1 or -1; 0 0 0 0 where a row is none.
void tidy_tangents(ArrayXf::Dense& tangents) {
    parallel_for(size_t(tangents.rows()), block_grain, [&](size_t i) {
        auto row = tangents.row(Eigen::Index(i));
        const float length = row.head<3>().norm(), sign = row[3];
        if (!(length > 1e-20f && length < 1e20f) || !(std::abs(sign) > 0))
            row.setZero();
        else
            row << Eigen::RowVector3f(row.head<3>() / length), std::copysign(1.0f, sign);
    });
}

void flip_v(ArrayXf::Dense& UV) {
    parallel_for(size_t(UV.rows()), block_grain, [&](size_t i) {
        auto row = UV.row(Eigen::Index(i));
        if (!row.allFinite()) row.setZero();
        row[1] = 1 - row[1];
    });
}

ArrayXf::Dense chosen_rows(const ArrayXf::Dense& array, const std::vector<int32_t>& rows) {
    if (array.rows() == 0) return {};
    ArrayXf::Dense chosen(Eigen::Index(rows.size()), array.cols());
    parallel_for(rows.size(), block_grain,
                 [&](size_t i) { chosen.row(Eigen::Index(i)) = array.row(rows[i]); });
    return chosen;
}

/// All arrays of a block's vertices.
template <class Visit>
void for_each_array(VertexBlock& block, Visit&& visit) {
    for (ArrayXf::Dense VertexBlock::*array :
         {&VertexBlock::V, &VertexBlock::N, &VertexBlock::UV, &VertexBlock::tangents, &VertexBlock::C,
          &VertexBlock::joints, &VertexBlock::weights})
        visit(block.*array);
    for (ArrayXf::Dense& target : block.targets_V) visit(target);
    for (ArrayXf::Dense& target : block.targets_N) visit(target);
    for (auto& [name, values] : block.values) visit(values);
}

bool has_flat_faces(const VertexBlock& block) {
    return block.N.rows() == 0 && !block.triangles.empty();
}

/// How many rows of a block remain before those of the corners: all, or none where only faces have them.
size_t kept_rows(const VertexBlock& block, bool has_lines) {
    return !has_flat_faces(block) || has_lines ? size_t(block.row_count) : 0;
}

/// The rows of a block after the split: those that remain, then one for each corner.
std::vector<int32_t> split_rows(const VertexBlock& block, bool has_lines) {
    std::vector<int32_t> rows(kept_rows(block, has_lines));
    std::iota(rows.begin(), rows.end(), 0);
    if (has_flat_faces(block)) rows.insert(rows.end(), block.triangles.begin(), block.triangles.end());
    return rows;
}

/// The number of all rows after the split.
size_t count_split_rows(const std::vector<VertexBlock>& blocks, const std::vector<bool>& has_lines) {
    size_t count = 0;
    for (size_t b = 0; b < blocks.size(); ++b)
        count +=
            kept_rows(blocks[b], has_lines[b]) + (has_flat_faces(blocks[b]) ? blocks[b].triangles.size() : 0);
    return count;
}

}  // namespace

void tidy(VertexBlock& block) {
    normalize_rows(block.N);
    tidy_tangents(block.tangents);
    flip_v(block.UV);
    encode_colors(block.C);
}

void choose_rows(VertexBlock& block, const std::vector<int32_t>& rows, const std::string& name) {
    uint64_t columns = 0;
    for_each_array(block, [&](const ArrayXf::Dense& array) { columns += uint64_t(array.cols()); });
    charge_memory(rows.size() * columns * sizeof(float), name);
    for_each_array(block, [&](ArrayXf::Dense& array) { array = chosen_rows(array, rows); });
    block.row_count = Eigen::Index(rows.size());
}

GltfFlatFaces split_flat_faces(std::vector<VertexBlock>& blocks, std::vector<int32_t>& faces,
                               std::vector<int32_t>& edges, const std::string& name) {
    std::vector<Eigen::Index> before;
    for (const VertexBlock& block : blocks) before.push_back(block.first);
    const auto block_of = [&](int32_t vertex) {
        return size_t(std::ranges::upper_bound(before, Eigen::Index(vertex)) - before.begin()) - 1;
    };
    std::vector<bool> has_lines(blocks.size(), false);
    for (const int32_t vertex : edges) has_lines[block_of(vertex)] = true;
    const size_t count = count_split_rows(blocks, has_lines);
    if (count > size_t(std::numeric_limits<int32_t>::max()))
        throw FormatError(fmt::format("{} has more than 2^31 vertices", name));
    charge_memory(count * sizeof(int32_t), name);
    std::vector<std::optional<int32_t>> next_corner(blocks.size());
    std::vector<int32_t> sources;
    sources.reserve(count);
    for (size_t b = 0; b < blocks.size(); ++b) {
        VertexBlock& block = blocks[b];
        const std::vector<int32_t> rows = split_rows(block, has_lines[b]);
        block.first = Eigen::Index(sources.size());
        for (const int32_t row : rows) sources.push_back(int32_t(before[b]) + row);
        if (!has_flat_faces(block)) continue;
        const size_t kept = rows.size() - block.triangles.size();
        next_corner[b] = int32_t(block.first) + int32_t(kept);
        choose_rows(block, rows, name);
        std::iota(block.triangles.begin(), block.triangles.end(), int32_t(kept));
    }
    const auto moved = [&](int32_t vertex) {
        const size_t b = block_of(vertex);
        return vertex + int32_t(blocks[b].first - before[b]);
    };
    std::vector<int32_t> corners;
    for (int32_t& vertex : faces) {
        std::optional<int32_t>& next = next_corner[block_of(vertex)];
        // Both lists have the triangles of a block in one order.
        vertex = next ? (*next)++ : moved(vertex);
        if (next) corners.push_back(vertex);
    }
    for (int32_t& vertex : edges) vertex = moved(vertex);
    if (corners.empty()) return {};
    return {Array3i(Eigen::Map<const Array3i::Dense>(corners.data(), Eigen::Index(corners.size() / 3), 3)),
            Array1i(Array1i::Dense(
                Eigen::Map<const Eigen::VectorXi>(sources.data(), Eigen::Index(sources.size()))))};
}

}  // namespace easypbr::io
