#include "easypbr/scene/mesh_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/suggest.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/mesh_arrays.h"
#include "easypbr/scene/polygon_values.h"

namespace easypbr {
namespace {

constexpr size_t scan_grain = 1 << 15;
constexpr size_t no_row = std::numeric_limits<size_t>::max();

/// The first row in [0, count) for which is_bad(row) holds, or no_row; the same for any number of threads.
template <class IsBad>
size_t first_bad_row(Eigen::Index count, IsBad&& is_bad) {
    std::atomic<size_t> first{no_row};
    parallel_chunks(size_t(count), scan_grain, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            if (!is_bad(row)) continue;
            size_t known = first.load();
            while (row < known && !first.compare_exchange_weak(known, row)) {
            }
            return;
        }
    });
    return first;
}

/// An array that is optional and otherwise has one row for each of `rows` things.
template <class Array>
void require_rows(const char* name, const Array& array, Eigen::Index rows, const char* of) {
    if (array.empty() || array.rows() == rows) return;
    throw ArgumentError(fmt::format("mesh array {}: expected {} rows, one per {}, or none; got {} x {}", name,
                                    rows, of, array.rows(), array.cols()));
}

/// Values that belong to the vertices or to the faces.
template <class Array>
void require_rows_of_either(const std::string& name, const Array& array, const MeshData& data) {
    const Eigen::Index n = data.V.rows(), m = data.F.rows();
    if (array.empty() || array.rows() == n || array.rows() == m) return;
    const Eigen::Index polygons = polygon_count(data);
    throw ArgumentError(fmt::format(
        "mesh array {}: expected {} rows, one per vertex, or {}, one per face,{} or none; got {} x {}", name,
        n, m, polygons > 0 ? fmt::format(" or {}, one per polygon,", polygons) : "", array.rows(),
        array.cols()));
}

void require_scalars(const MeshData& data) {
    std::map<std::string_view, size_t> places;
    for (size_t i = 0; i < data.scalars.size(); ++i) {
        const ScalarArray& scalar = data.scalars[i];
        if (scalar.name.empty())
            throw ArgumentError(fmt::format("mesh scalars: expected a name for array {}, got none", i));
        if (const auto [same, is_new] = places.emplace(scalar.name, i); !is_new)
            throw ArgumentError(
                fmt::format("mesh scalars: expected different names, got '{}' for arrays {} and {}",
                            scalar.name, same->second, i));
        require_rows_of_either("scalars['" + scalar.name + "']", scalar.values, data);
    }
}

void require_splat_shapes(const SplatArrays& splats, Eigen::Index n) {
    require_rows("scales", splats.scales, n, "vertex");
    require_rows("rotations", splats.rotations, n, "vertex");
    require_rows("opacities", splats.opacities, n, "vertex");
    require_rows("sh", splats.sh, n, "vertex");
    const int given = int(!splats.scales.empty()) + int(!splats.rotations.empty()) +
                      int(!splats.opacities.empty()) + int(!splats.sh.empty());
    if (given != 0 && given != 4)
        throw ArgumentError(
            fmt::format("mesh splats: expected all of scales, rotations, opacities and sh, or "
                        "none; got {} of them (assign() sets several at once)",
                        given));
    const Eigen::Index cols = splats.sh.cols();
    if (!splats.sh.empty() && cols != 3 && cols != 12 && cols != 27 && cols != 48)
        throw ArgumentError(
            fmt::format("mesh array sh: expected 3, 12, 27 or 48 columns, for spherical "
                        "harmonics of degree 0 to 3, got {}",
                        cols));
}

}  // namespace

void require_shapes(const MeshData& data) {
    const Eigen::Index n = data.V.rows(), m = data.F.rows();
    require_rows("N", data.N, n, "vertex");
    require_rows("C", data.C, n, "vertex");
    require_rows("UV", data.UV, n, "vertex");
    require_rows("uv_tangents", data.uv_tangents, n, "vertex");
    require_rows("T", data.T, n, "vertex");
    require_rows("B", data.B, n, "vertex");
    require_rows_of_either("L", data.L, data);
    require_rows("I", data.I, n, "vertex");
    require_scalars(data);
    require_splat_shapes(data.splats, n);
    require_rows("source_vertex", data.source_vertex, n, "vertex");
    require_rows("source_face", data.source_face, m, "face");
    if (!data.C.empty() && data.C.cols() != 3 && data.C.cols() != 4)
        throw ArgumentError(fmt::format("mesh array C: expected {} x 3 or {} x 4, got {} x {}", n, n,
                                        data.C.rows(), data.C.cols()));
}

namespace {

void require_splats(const SplatArrays& splats) {
    const auto require = [](const char* what, Eigen::Index rows, auto&& is_bad) {
        if (const size_t row = first_bad_row(rows, [&](size_t i) { return is_bad(Eigen::Index(i)); });
            row != no_row)
            throw ArgumentError(fmt::format("mesh array {}, got others in row {} of {}", what, row, rows));
    };
    const Eigen::Index n = splats.scales.rows();
    require("scales: expected finite numbers of 0 or more", n, [&](Eigen::Index i) {
        return !splats.scales.row(i).allFinite() || splats.scales.row(i).minCoeff() < 0;
    });
    require("rotations: expected finite quaternions w, x, y, z of a length above 0", n, [&](Eigen::Index i) {
        return !splats.rotations.row(i).allFinite() || splats.rotations.row(i).isZero(0);
    });
    require("opacities: expected numbers from 0 to 1", n,
            [&](Eigen::Index i) { return !(splats.opacities(i) >= 0 && splats.opacities(i) <= 1); });
    require("sh: expected finite numbers", n, [&](Eigen::Index i) { return !splats.sh.row(i).allFinite(); });
}

void require_finite_positions(const Array3f& V) {
    const size_t row = first_bad_row(V.rows(), [&](size_t i) { return !V.row(Eigen::Index(i)).allFinite(); });
    if (row == no_row) return;
    const Eigen::Index i = Eigen::Index(row);
    throw ArgumentError(
        fmt::format("mesh array V: expected finite positions, got ({}, {}, {}) in row {} of {}", V(i, 0),
                    V(i, 1), V(i, 2), row, V.rows()));
}

template <class Indices>
void require_indices(const char* name, const Indices& indices, Eigen::Index vertices) {
    const auto is_outside = [&](int32_t index) { return index < 0 || index >= vertices; };
    const size_t row = first_bad_row(indices.rows(), [&](size_t i) {
        for (Eigen::Index k = 0; k < indices.cols(); ++k)
            if (is_outside(indices(Eigen::Index(i), k))) return true;
        return false;
    });
    if (row == no_row) return;
    for (Eigen::Index k = 0; k < indices.cols(); ++k)
        if (const int32_t index = indices(Eigen::Index(row), k); is_outside(index))
            throw ArgumentError(
                fmt::format("mesh array {}: expected vertex indices from 0 to {}, got {} in row {} of {}",
                            name, vertices - 1, index, row, indices.rows()));
}

/// Why a label may be unknown: SemanticKITTI's files hold an instance's number in the upper 16 bits.
std::string advice_on(int32_t label, const LabelMap& map) {
    const LabelClass* const lower = label > 0xffff ? map.find(label & 0xffff) : nullptr;
    if (!lower) return "add it, or let the map show unknown labels as unlabelled";
    return fmt::format("its lower 16 bits are '{}' ({}): take labels & 0xFFFF", lower->name, lower->label);
}

void require_labels(const Array1i& L, const LabelMap& map) {
    const size_t row = first_bad_row(L.rows(), [&](size_t i) { return !map.accepts(L(Eigen::Index(i))); });
    if (row == no_row) return;
    const int32_t label = L(Eigen::Index(row));
    throw ArgumentError(
        fmt::format("mesh array L: label {} in row {} of {} is not in the label map '{}', which has {}; {}",
                    label, row, L.rows(), map.name(), map.range_text(), advice_on(label, map)));
}

/// Throws unless each face is in one part.
void require_cover(const MeshData& data) {
    if (data.parts.empty()) return;
    std::vector<const MeshPart*> parts;
    parts.reserve(data.parts.size());
    for (const MeshPart& part : data.parts)
        if (part.face_count > 0) parts.push_back(&part);
    std::ranges::stable_sort(parts, {}, &MeshPart::first_face);
    const auto refuse = [&](int64_t first, int64_t end, const std::string& in) {
        throw ArgumentError(
            fmt::format("mesh parts: expected each of the {} faces in one part, got faces {} to {} in {}",
                        data.F.rows(), first, end - 1, in));
    };
    int64_t covered = 0;  // all faces before it are in one part
    for (const MeshPart* const part : parts) {
        const int64_t first = part->first_face, end = first + part->face_count;
        if (first > covered) refuse(covered, first, "none");
        if (first < covered)
            refuse(first, std::min(covered, end), fmt::format("two, the second '{}'", part->name));
        covered = end;
    }
    if (covered < data.F.rows()) refuse(covered, data.F.rows(), "none");
}

void require_parts(const MeshData& data) {
    for (const MeshPart& part : data.parts) {
        const int64_t end = int64_t(part.first_face) + part.face_count;
        if (part.first_face < 0 || part.face_count < 0 || end > data.F.rows())
            throw ArgumentError(
                fmt::format("mesh part '{}': expected a range of the {} faces, got {} from face {} on",
                            part.name, data.F.rows(), part.face_count, part.first_face));
        const size_t materials = std::max<size_t>(1, data.materials.size());
        if (part.material < 0 || size_t(part.material) >= materials)
            throw ArgumentError(fmt::format("mesh part '{}': expected a material index from 0 to {}, got {}",
                                            part.name, materials - 1, part.material));
    }
    require_cover(data);
}

void require_finite_vector(const char* name, const Vec3d& v) {
    if (!v.allFinite())
        throw ArgumentError(
            fmt::format("mesh {}: expected finite numbers, got ({}, {}, {})", name, v.x(), v.y(), v.z()));
}

template <class Array>
bool same_array(const Array& a, const Array& b) {
    return a.data() == b.data() && a.rows() == b.rows() && a.revision() == b.revision();
}

}  // namespace

void require_faces(const Array3i& F, Eigen::Index vertices) {
    require_indices("F", F, vertices);
}

void require_sources(const char* name, const Array1i& sources, const char* of) {
    const size_t row = first_bad_row(sources.rows(), [&](size_t i) { return sources(Eigen::Index(i)) < 0; });
    if (row == no_row) return;
    throw ArgumentError(fmt::format("mesh array {}: expected numbers of {} from 0 on, got {} in row {} of {}",
                                    name, of, sources(Eigen::Index(row)), row, sources.rows()));
}

void require_pose(const char* name, const Eigen::Affine3d& T) {
    if (!T.matrix().allFinite()) throw ArgumentError(fmt::format("mesh {}: expected finite numbers", name));
    if (const Eigen::RowVector4d last = T.matrix().row(3); last != Eigen::RowVector4d(0, 0, 0, 1))
        throw ArgumentError(fmt::format("mesh {}: expected a last row of (0, 0, 0, 1), got ({}, {}, {}, {})",
                                        name, last[0], last[1], last[2], last[3]));
}

void validate(const MeshData& data) {
    validate(data, MeshData{});
}

void validate(const MeshData& data, const MeshData& valid) {
    require_shapes(data);
    require_finite_vector("offset", data.offset);
    require_finite_vector("up", data.up);
    require_finite_vector("front", data.front);
    if (!(data.voxel_size >= 0) || !std::isfinite(data.voxel_size))
        throw ArgumentError(
            fmt::format("mesh voxel_size: expected a finite number of at least 0, got {}", data.voxel_size));
    require_pose("T_parent_mesh", data.T_parent_mesh);
    const bool same_V = same_array(data.V, valid.V);
    const bool same_count = data.V.rows() == valid.V.rows();
    if (!same_V) require_finite_positions(data.V);
    if (!same_count || !same_array(data.F, valid.F)) require_faces(data.F, data.V.rows());
    if (!same_array(data.source_face, valid.source_face))
        require_sources("source_face", data.source_face, "polygons");
    if (!same_array(data.source_vertex, valid.source_vertex))
        require_sources("source_vertex", data.source_vertex, "vertices");
    if (!same_count || !same_array(data.E, valid.E)) require_indices("E", data.E, data.V.rows());
    if (!same_array(data.splats.scales, valid.splats.scales) ||
        !same_array(data.splats.rotations, valid.splats.rotations) ||
        !same_array(data.splats.opacities, valid.splats.opacities) ||
        !same_array(data.splats.sh, valid.splats.sh))
        require_splats(data.splats);
    const bool same_labels = same_array(data.L, valid.L) && data.label_map == valid.label_map;
    if (data.label_map && !same_labels) require_labels(data.L, *data.label_map);
    require_parts(data);
    if (data.style != valid.style) validate(data.style, fmt::format("mesh '{}': ", data.name));
    for (const Material& material : data.materials) validate(material);
}

const ScalarArray& scalar_named(const MeshData& data, const std::string& name) {
    std::vector<std::string> names;
    for (const ScalarArray& scalar : data.scalars) {
        if (scalar.name == name) return scalar;
        names.push_back(scalar.name);
    }
    throw NameError(fmt::format("mesh '{}' has no scalars '{}'{}; it has {}", data.name, name,
                                did_you_mean(name, names),
                                names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace easypbr
