#include "easypbr/io/tables/polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "easypbr/core/error.h"
#include "easypbr/core/log.h"
#include "easypbr/core/parallel.h"
#include "easypbr/io/tables/ear_clipping.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr::io {
namespace {

constexpr size_t polygon_grain = 1 << 16;

/// Whether cutting the quad a b c d along a-c gives two triangles of opposite orientation: a-c lies outside.
bool diagonal_is_outside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot((c - a).cross(d - a)) < 0;
}

/// The corner from which the polygon is cut into a fan.
size_t fan_start(const Array3f& V, const int32_t* polygon, size_t size) {
    if (size != 4) return 0;
    const auto at = [&](int corner) { return Vec3(V.row(polygon[corner]).transpose()); };
    const Vec3 a = at(0), b = at(1), c = at(2), d = at(3);
    return diagonal_is_outside(a, b, c, d) && !diagonal_is_outside(b, c, d, a) ? 1 : 0;
}

void write_fan(const int32_t* polygon, size_t size, size_t start, int32_t* out) {
    for (size_t k = 1; k + 1 < size; ++k) {
        *out++ = polygon[start];
        *out++ = polygon[(start + k) % size];
        *out++ = polygon[(start + k + 1) % size];
    }
}

size_t triangles_of(size_t corners) {
    return corners < 3 ? 0 : corners - 2;
}

/// Index of each polygon's first triangle, and the number of triangles at the end.
std::vector<uint32_t> first_triangles(const Polygons& polygons) {
    std::vector<uint32_t> first(polygons.rows + 1);
    size_t count = 0;
    for (size_t i = 0; i < polygons.rows; ++i) {
        first[i] = uint32_t(count);
        count += triangles_of(polygons.size_of(i));
    }
    if (count > INT32_MAX)
        throw FormatError(fmt::format("{} triangles are more than a mesh can hold", count));
    first.back() = uint32_t(count);
    return first;
}

Array3i view_as_triangles(Polygons&& polygons) {
    auto owner = std::make_shared<Eigen::VectorXi>(std::move(polygons.values));
    const int32_t* data = owner->data();
    return {std::move(owner), data, Eigen::Index(polygons.rows), 3};
}

}  // namespace

bool cut_polygon(const Array3f& V, const int32_t* polygon, size_t size, int32_t* out, uint64_t looks) {
    if (size > 4 && !is_fan_good(V, polygon, size)) return EarClipper(V, polygon, size, looks).write(out);
    write_fan(polygon, size, fan_start(V, polygon, size), out);
    return true;
}

void check_indices(const Source& source, std::span<const int32_t> indices, size_t count,
                   std::string_view what, int base) {
    std::atomic<uint32_t> largest{0};
    parallel_chunks(indices.size(), polygon_grain * 4, [&](size_t begin, size_t end) {
        uint32_t maximum = 0;
        for (size_t i = begin; i < end; ++i) maximum = std::max(maximum, uint32_t(indices[i]));
        uint32_t seen = largest;
        while (seen < maximum && !largest.compare_exchange_weak(seen, maximum)) {
        }
    });
    if (indices.empty() || largest < count) return;
    const auto bad =
        std::find_if(indices.begin(), indices.end(), [&](int32_t i) { return uint32_t(i) >= count; });
    fail(source, fmt::format("{} has index {}, expected {} to {} ({} vertices)", what, int64_t(*bad) + base,
                             base, int64_t(count) - 1 + base, count));
}

void check_positions(const Source& source, const Array3f::Dense& V) {
    std::atomic<bool> finite{true};
    parallel_chunks(size_t(V.rows()), polygon_grain, [&](size_t begin, size_t end) {
        // A sum of zero times each value is zero exactly when all of them are finite, and needs no branches.
        const auto rows = V.middleRows(Eigen::Index(begin), Eigen::Index(end - begin));
        if (!((rows * 0.0f).sum() == 0)) finite = false;
    });
    if (finite) return;
    Eigen::Index row = 0;
    while (V.row(row).allFinite()) ++row;
    fail(source, fmt::format("vertex {} has position ({}, {}, {}), expected finite numbers", row, V(row, 0),
                             V(row, 1), V(row, 2)));
}

void triangulate(Polygons&& polygons, MeshData& mesh, uint64_t looks) {
    if (polygons.first.empty() && polygons.width == 3) {
        mesh.F = view_as_triangles(std::move(polygons));
        return;
    }
    const std::vector<uint32_t> first = first_triangles(polygons);
    Array3i::Dense F(first.back(), 3);
    Array1i::Dense source_face(first.back());
    std::atomic<size_t> rough{0};
    parallel_for(polygons.rows, polygon_grain / 8, [&](size_t i) {
        const size_t size = polygons.size_of(i);
        if (size < 3) return;
        const int32_t* polygon = polygons.values.data() + polygons.begin_of(i);
        if (!cut_polygon(mesh.V, polygon, size, F.data() + size_t(first[i]) * 3, looks)) ++rough;
        std::fill(source_face.data() + first[i], source_face.data() + first[i + 1], int32_t(i));
    });
    mesh.F = std::move(F);
    mesh.source_face = std::move(source_face);
    if (rough > 0)
        log_warning(
            fmt::format("{} of {} polygons would take too long to cut exactly: their triangles may overlap",
                        rough.load(), polygons.rows));
}

std::vector<int32_t> triangles_of_strips(const Polygons& strips) {
    std::vector<int32_t> triangles;
    for (size_t row = 0; row < strips.rows; ++row) {
        const int32_t* index = strips.values.data() + strips.begin_of(row);
        const size_t size = strips.size_of(row);
        size_t start = 0;
        for (size_t i = 0; i < size; ++i) {
            if (index[i] == -1) start = i + 1;
            if (i < start + 2 || index[i] == -1) continue;
            const bool odd = (i - start) % 2 != 0;
            const int32_t a = index[odd ? i - 1 : i - 2], b = index[odd ? i - 2 : i - 1], c = index[i];
            if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
        }
    }
    return triangles;
}

namespace {

template <class A>
void permute_rows(A& array, const std::vector<uint32_t>& order) {
    typename A::Dense permuted(Eigen::Index(order.size()), array.cols());
    parallel_for(order.size(), polygon_grain,
                 [&](size_t i) { permuted.row(Eigen::Index(i)) = array.row(order[i]); });
    array = std::move(permuted);
}

constexpr float color_steps = 65535;

/// Four codes of 16 bits, of which those of bytes are exact; alpha is 1 where there is none.
uint64_t color_key(const Eigen::RowVectorXf& color) {
    uint64_t key = 0;
    for (Eigen::Index i = 0; i < 4; ++i)
        key = key << 16 | uint64_t(std::lround((i < color.size() ? color[i] : 1.0f) * color_steps));
    return key;
}

/// White for `no_key`, the key of a vertex without a face.
Eigen::RowVector4f color_of(uint64_t key) {
    Eigen::RowVector4f color;
    for (Eigen::Index i = 0; i < 4; ++i) color[i] = float(key >> (48 - 16 * i) & 0xffff) / color_steps;
    return color;
}

}  // namespace

CornerSplit color_vertices_by_faces(const ArrayXf::Dense& C, Polygons& polygons, MeshData& mesh) {
    std::vector<uint64_t> keys(polygons.value_count(), no_key);
    parallel_for(polygons.rows, polygon_grain / 8, [&](size_t face) {
        std::fill_n(keys.begin() + ptrdiff_t(polygons.begin_of(face)), polygons.size_of(face),
                    color_key(C.row(Eigen::Index(face))));
    });
    CornerSplit split =
        split_corners({polygons.values.data(), polygons.value_count()}, keys, size_t(mesh.V.rows()));
    gather_vertices(split, mesh);
    ArrayXf::Dense of_vertices(Eigen::Index(split.key.size()), C.cols());
    parallel_for(split.key.size(), polygon_grain / 4,
                 [&](size_t i) { of_vertices.row(Eigen::Index(i)) = color_of(split.key[i]).head(C.cols()); });
    mesh.C = std::move(of_vertices);
    return split;
}

void assign_materials(std::span<const int32_t> material_of_polygon, MeshData& mesh) {
    const size_t count = size_t(mesh.F.rows());
    const auto polygon_of = [&](size_t face) {
        return mesh.source_face.empty() ? face : size_t(mesh.source_face(Eigen::Index(face)));
    };
    std::vector<int> begin(mesh.materials.size() + 1, 0);
    for (size_t i = 0; i < count; ++i) ++begin[size_t(material_of_polygon[polygon_of(i)]) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());

    std::vector<uint32_t> order(count);
    std::vector<int> next(begin.begin(), begin.end() - 1);
    for (size_t i = 0; i < count; ++i)
        order[size_t(next[size_t(material_of_polygon[polygon_of(i)])]++)] = uint32_t(i);

    mesh.parts.clear();
    for (size_t m = 0; m < mesh.materials.size(); ++m)
        if (begin[m] != begin[m + 1])
            mesh.parts.push_back({mesh.materials[m].name, begin[m], begin[m + 1] - begin[m], int(m)});
    if (std::is_sorted(order.begin(), order.end())) return;
    if (mesh.source_face.empty())
        mesh.source_face = Array1i::Dense::LinSpaced(Eigen::Index(count), 0, int(count) - 1);
    permute_rows(mesh.F, order);
    permute_rows(mesh.source_face, order);
}

}  // namespace easypbr::io
