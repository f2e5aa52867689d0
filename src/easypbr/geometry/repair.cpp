#include "easypbr/geometry/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <unordered_map>

#include "easypbr/core/interrupt.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/weld.h"

namespace easypbr {

using geometry::Selection;

namespace {

using Ids = std::vector<uint32_t>;

/// Ids that are equal where they were and the rows (of `size` bytes) are, byte for byte.
void refine(Ids& ids, const void* rows, size_t size) {
    const size_t stride = sizeof(uint32_t) + size;
    const auto keys = std::make_shared<std::vector<char>>(ids.size() * stride);
    for (size_t i = 0; i < ids.size(); ++i) {
        check_interrupt(i);
        char* const key = keys->data() + i * stride;
        std::memcpy(key, &ids[i], sizeof(uint32_t));
        std::memcpy(key + sizeof(uint32_t), static_cast<const char*>(rows) + i * size, size);
    }
    ids = geometry::numbered_rows({keys, keys->data()}, ids.size(), stride);
}

template <class A>
void refine(Ids& ids, const A& array) {
    if (!array.empty()) refine(ids, array.data(), size_t(array.cols()) * sizeof(typename A::Scalar));
}

/// Vertices with the same attributes have the same id.
Ids attribute_ids(const MeshData& mesh) {
    Ids ids(static_cast<size_t>(mesh.V.rows()), 0);
    refine(ids, mesh.N);
    refine(ids, mesh.C);
    refine(ids, mesh.UV);
    refine(ids, mesh.uv_tangents);
    refine(ids, mesh.T);
    refine(ids, mesh.B);
    refine(ids, mesh.I);
    if (element_of(mesh, mesh.L.rows()) == PerElement::vertex) refine(ids, mesh.L);
    for (const ScalarArray& scalar : mesh.scalars)
        if (element_of(mesh, scalar.values.rows()) == PerElement::vertex) refine(ids, scalar.values);
    return ids;
}

/// For each vertex the first one with the same id.
std::vector<int32_t> first_of_each(const Ids& ids) {
    std::vector<int32_t> first(ids.size(), -1), result(ids.size());
    for (size_t i = 0; i < ids.size(); ++i) {
        check_interrupt(i);
        int32_t& known = first[ids[i]];
        if (known < 0) known = int32_t(i);
        result[i] = known;
    }
    return result;
}

/// Vertices that stand for themselves, by the cell of a grid as wide as the tolerance.
class Representatives {
  public:
    Representatives(const MeshData& mesh, const Ids& ids, double tolerance)
        : mesh_(mesh), ids_(ids), tolerance_(tolerance) {}

    /// The first representative that is the same as vertex v, or v itself, which becomes one.
    int32_t of(int32_t v) {
        const Vec3d at = position(v);
        const std::array<int64_t, 3> cell = cell_of(at);
        int32_t found = v;
        for (int64_t x = -1; x <= 1; ++x)
            for (int64_t y = -1; y <= 1; ++y)
                for (int64_t z = -1; z <= 1; ++z) {
                    const auto bucket = cells_.find(key({cell[0] + x, cell[1] + y, cell[2] + z}));
                    if (bucket == cells_.end()) continue;
                    for (const int32_t other : bucket->second)
                        if (other < found && ids_[size_t(other)] == ids_[size_t(v)] &&
                            (position(other) - at).norm() <= tolerance_)
                            found = other;
                }
        if (found == v) cells_[key(cell)].push_back(v);
        return found;
    }

  private:
    Vec3d position(int32_t v) const { return mesh_.V.row(v).transpose().cast<double>(); }
    std::array<int64_t, 3> cell_of(const Vec3d& at) const {
        return {int64_t(std::floor(at.x() / tolerance_)), int64_t(std::floor(at.y() / tolerance_)),
                int64_t(std::floor(at.z() / tolerance_))};
    }
    /// Cells of one key share a bucket; the distance tells their vertices apart.
    static uint64_t key(const std::array<int64_t, 3>& cell) {
        return uint64_t(cell[0]) * 0x9e3779b97f4a7c15 ^ uint64_t(cell[1]) * 0xc2b2ae3d27d4eb4f ^
               uint64_t(cell[2]) * 0x165667b19e3779f9;
    }

    const MeshData& mesh_;
    const Ids& ids_;
    const double tolerance_;
    std::unordered_map<uint64_t, std::vector<int32_t>> cells_;
};

/// For each vertex the one that stands for it.
std::vector<int32_t> representatives(const MeshData& mesh, const DuplicateOptions& options) {
    Ids ids = options.keep_seams ? attribute_ids(mesh) : Ids(static_cast<size_t>(mesh.V.rows()), 0);
    const geometry::Weld weld = geometry::weld_positions(mesh.V);
    // Below the spacing of the floats themselves only equal ones are near enough, and cells could not be
    // counted.
    const double largest = mesh.V.empty() ? 0 : double(mesh.V.cwiseAbs().maxCoeff());
    if (options.tolerance <= largest * 0x1p-60) {
        refine(ids, weld.place.data(), sizeof(int32_t));
        return first_of_each(ids);
    }
    Representatives known(mesh, ids, options.tolerance);
    std::vector<int32_t> result(ids.size());
    for (size_t i = 0; i < ids.size(); ++i) {
        check_interrupt(i);
        result[i] = known.of(int32_t(i));
    }
    return result;
}

/// Mean normals of the vertices that were joined.
Array3f mean_normals(const MeshData& mesh, const Selection& selection) {
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> sums =
        Eigen::MatrixXd::Zero(Eigen::Index(selection.vertices.size()), 3);
    for (size_t i = 0; i < selection.place.size(); ++i)
        sums.row(selection.place[i]) += mesh.N.row(Eigen::Index(i)).cast<double>();
    for (Eigen::Index i = 0; i < sums.rows(); ++i) {
        const double length = sums.row(i).norm();
        // Opposite normals leave none; the first is as good as the other.
        sums.row(i) = length > 1e-6
                          ? Eigen::RowVector3d(sums.row(i) / length)
                          : Eigen::RowVector3d(mesh.N.row(selection.vertices[size_t(i)]).cast<double>());
    }
    return Array3f(sums);
}

bool face_has_area(const MeshData& mesh, int32_t f) {
    const auto corner = [&](int k) -> Vec3d { return mesh.V.row(mesh.F(f, k)).transpose().cast<double>(); };
    const Vec3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
    // Float coordinates are exact in double; what is left of an area below this is rounding of the product.
    return ab.cross(ac).norm() > 1e-14 * ab.norm() * ac.norm();
}

}  // namespace

Mesh remove_unreferenced_vertices(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    if (data->F.empty() && data->E.empty()) return mesh.clone();
    Selection selection = geometry::select_all(*data);
    geometry::drop_unreferenced(selection, *data);
    return Mesh(geometry::chosen(*data, selection));
}

Mesh remove_duplicate_vertices(const Mesh& mesh, const DuplicateOptions& options) {
    geometry::require_not_negative("remove_duplicate_vertices: tolerance", options.tolerance);
    const auto data = mesh.snapshot();
    const std::vector<int32_t> first = representatives(*data, options);
    Selection selection = geometry::select_all(*data);
    selection.vertices.clear();
    for (size_t i = 0; i < first.size(); ++i) {
        check_interrupt(i);
        const bool stays = first[i] == int32_t(i);
        selection.place[i] = stays ? int32_t(selection.vertices.size()) : selection.place[size_t(first[i])];
        if (stays) selection.vertices.push_back(int32_t(i));
    }
    geometry::drop_degenerate(selection, *data);
    MeshData result = geometry::chosen(*data, selection);
    if (!options.keep_seams) {
        if (!data->N.empty()) result.N = mean_normals(*data, selection);
        result.uv_tangents = {};
    }
    return Mesh(std::move(result));
}

Mesh remove_degenerate_faces(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    Selection selection = geometry::select_all(*data);
    std::erase_if(selection.faces, [&](int32_t f) { return !face_has_area(*data, f); });
    return Mesh(geometry::chosen(*data, selection));
}

Mesh flip_winding(const Mesh& mesh) {
    Mesh result = mesh.clone();
    result.edit([](MeshData& data) {
        if (!data.F.empty()) data.F = Array3i::Dense(data.F.rowwise().reverse());
    });
    return result;
}

Mesh flip_normals(const Mesh& mesh) {
    Mesh result = mesh.clone();
    result.edit([](MeshData& data) {
        if (!data.N.empty()) data.N = Array3f::Dense(-data.N);
    });
    return result;
}

}  // namespace easypbr
