#include "easypbr/scene/corner_split.h"

#include <algorithm>
#include <numeric>

#include "easypbr/core/parallel.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
namespace {

constexpr size_t corner_grain = 1 << 16;

}  // namespace

CornerSplit split_corners(std::span<int32_t> corner_vertices, std::span<const uint64_t> keys,
                          size_t vertex_count) {
    std::vector<uint32_t> first(vertex_count + 1, 0);
    for (const int32_t v : corner_vertices) ++first[size_t(v) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());

    std::vector<uint64_t> sorted(corner_vertices.size());
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    for (size_t c = 0; c < corner_vertices.size(); ++c) sorted[next[size_t(corner_vertices[c])]++] = keys[c];

    std::vector<uint32_t> different(vertex_count + 1, 0);
    parallel_for(vertex_count, corner_grain / 4, [&](size_t v) {
        const auto begin = sorted.begin() + first[v], end = sorted.begin() + first[v + 1];
        std::sort(begin, end);
        different[v + 1] = std::max<uint32_t>(1, uint32_t(std::unique(begin, end) - begin));
    });
    std::partial_sum(different.begin(), different.end(), different.begin());

    CornerSplit split{std::vector<int32_t>(different.back()),
                      std::vector<uint64_t>(different.back(), no_key)};
    parallel_for(vertex_count, corner_grain / 4, [&](size_t v) {
        const size_t base = different[v], count = different[v + 1] - base;
        std::fill_n(split.source_vertex.begin() + ptrdiff_t(base), count, int32_t(v));
        if (first[v] != first[v + 1])
            std::copy_n(sorted.begin() + first[v], count, split.key.begin() + ptrdiff_t(base));
    });
    parallel_for(corner_vertices.size(), corner_grain, [&](size_t c) {
        const size_t v = size_t(corner_vertices[c]);
        const auto begin = split.key.begin() + different[v], end = split.key.begin() + different[v + 1];
        corner_vertices[c] = int32_t(different[v] + (std::lower_bound(begin, end, keys[c]) - begin));
    });
    return split;
}

void gather_vertices(const CornerSplit& split, MeshData& mesh) {
    if (split.source_vertex.size() == size_t(mesh.V.rows())) return;
    repeat_vertices(split.source_vertex, mesh);
}

void follow_split(const CornerSplit& split, std::span<int32_t> indices) {
    const auto begin = split.source_vertex.begin(), end = split.source_vertex.end();
    for (int32_t& index : indices) index = int32_t(std::lower_bound(begin, end, index) - begin);
}

}  // namespace easypbr
