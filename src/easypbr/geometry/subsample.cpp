#include "easypbr/geometry/sample.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/random.h"
#include "easypbr/geometry/require.h"

namespace easypbr {
namespace {

constexpr size_t subsample_grain = 4096;
constexpr int64_t most_cells = int64_t(1) << 21;

/// The vertices of each cell of a grid, cells by their first vertex, vertices rising.
class CellGroups {
  public:
    CellGroups(const char* what, const Array3f& V, double cell_size) : cell_size_(cell_size) {
        geometry::require_positive(fmt::format("{}: cell size", what).c_str(), cell_size);
        const Eigen::Array3d low =
            (V.colwise().minCoeff().transpose().cast<double>() / cell_size).array().floor();
        const Eigen::Array3d high =
            (V.colwise().maxCoeff().transpose().cast<double>() / cell_size).array().floor();
        const double cells = (high - low).maxCoeff() + 1;
        if (!(cells <= double(most_cells)))
            throw ArgumentError(
                fmt::format("{}: expected at most {} cells along an axis, got {:.6g} with a cell size of {}",
                            what, most_cells, cells, cell_size));
        low_ = low;
        items_.resize(size_t(V.rows()));
        parallel_for(items_.size(), subsample_grain, [&](size_t i) {
            const Eigen::Array3d cell =
                (V.row(Eigen::Index(i)).transpose().cast<double>() / cell_size).array().floor() - low_;
            items_[i] = {uint64_t(cell.x()) << 42 | uint64_t(cell.y()) << 21 | uint64_t(cell.z()),
                         uint32_t(i)};
        });
        parallel_sort(items_);
        for (size_t i = 0; i < items_.size(); ++i)
            if (i == 0 || items_[i].key != items_[i - 1].key)
                groups_.push_back({items_[i].index, uint32_t(i)});
        const size_t count = groups_.size();
        ends_.resize(items_.size() + 1);
        for (size_t g = 0; g < count; ++g)
            ends_[groups_[g].index] = g + 1 < count ? groups_[g + 1].index : uint32_t(items_.size());
        // By first vertex: the key is the first vertex, the index where the group begins.
        parallel_sort(groups_);
    }

    size_t count() const { return groups_.size(); }

    /// Calls visit(vertex) for the vertices of a group.
    template <class Visit>
    void visit(size_t group, Visit&& visit) const {
        const uint32_t begin = groups_[group].index;
        for (uint32_t i = begin; i < ends_[begin]; ++i) visit(Eigen::Index(items_[i].index));
    }

    Vec3d center(size_t group) const {
        const uint64_t key = items_[groups_[group].index].key;
        const Eigen::Array3d cell(double(key >> 42), double(key >> 21 & (most_cells - 1)),
                                  double(key & (most_cells - 1)));
        return (cell_size_ * (low_ + cell + 0.5)).matrix();
    }

  private:
    double cell_size_;
    Eigen::Array3d low_;
    std::vector<KeyedIndex> items_, groups_;
    std::vector<uint32_t> ends_;  ///< by where a group begins, where it ends
};

/// Mean rows of the groups, in double; values that are not finite do not count, and a group of only such gets
/// NaN.
template <class A>
A means(const A& array, const CellGroups& groups) {
    if (array.empty()) return {};
    typename A::Dense result(Eigen::Index(groups.count()), array.cols());
    parallel_for(groups.count(), subsample_grain, [&](size_t group) {
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(array.cols());
        int count = 0;
        groups.visit(group, [&](Eigen::Index v) {
            if (!array.row(v).allFinite()) return;
            sum += array.row(v).template cast<double>();
            ++count;
        });
        result.row(Eigen::Index(group)) = (sum / double(count)).template cast<float>();
    });
    return result;
}

Array3f mean_directions(const Array3f& N, const CellGroups& groups) {
    if (N.empty()) return {};
    Array3f::Dense result = means(N, groups);
    for (Eigen::Index i = 0; i < result.rows(); ++i) {
        const float length = result.row(i).norm();
        if (length > 1e-6f) {
            result.row(i) /= length;
            continue;
        }
        // Opposite normals leave no mean; that of the first vertex is as good as any.
        bool is_first = true;
        groups.visit(size_t(i), [&](Eigen::Index v) {
            if (is_first) result.row(i) = N.row(v);
            is_first = false;
        });
    }
    return result;
}

Array1i most_frequent(const Array1i& L, const CellGroups& groups) {
    Array1i::Dense result(Eigen::Index(groups.count()));
    parallel_chunks(groups.count(), subsample_grain, [&](size_t begin, size_t end) {
        std::vector<int32_t> labels;
        for (size_t group = begin; group < end; ++group) {
            labels.clear();
            groups.visit(group, [&](Eigen::Index v) { labels.push_back(L[v]); });
            std::sort(labels.begin(), labels.end());
            size_t longest = 0;
            for (size_t i = 0, run = 0; i < labels.size(); ++i) {
                run = i > 0 && labels[i] == labels[i - 1] ? run + 1 : 1;
                if (run <= longest) continue;
                longest = run;
                result[Eigen::Index(group)] = labels[i];
            }
        }
    });
    return result;
}

/// What vertices have on average in each group.
MeshData averaged(const MeshData& mesh, const CellGroups& groups) {
    MeshData result = geometry::clone_without_arrays(mesh);
    result.V = means(mesh.V, groups);
    result.N = mean_directions(mesh.N, groups);
    result.C = means(mesh.C, groups);
    result.UV = means(mesh.UV, groups);
    result.I = means(mesh.I, groups);
    if (!mesh.L.empty() && element_of(mesh, mesh.L.rows()) == PerElement::vertex)
        result.L = most_frequent(mesh.L, groups);
    for (const ScalarArray& scalar : mesh.scalars)
        if (element_of(mesh, scalar.values.rows()) == PerElement::vertex)
            result.scalars.push_back({scalar.name, means(scalar.values, groups)});
    return result;
}

/// Splats have their colours in their harmonics, which have no mean: they become those of their means.
std::shared_ptr<const MeshData> points_of(const Mesh& mesh) {
    const auto data = mesh.snapshot();
    return data->splats.empty() ? data : cloud_from_splats(mesh).snapshot();
}

}  // namespace

Mesh subsample_random(const Mesh& mesh, int64_t count, uint64_t seed) {
    if (count < 0) throw ArgumentError(fmt::format("subsample: expected a count >= 0, got {}", count));
    const auto data = mesh.snapshot();
    const geometry::RandomNumbers random(seed);
    const auto n = int64_t(data->V.rows());
    std::vector<int32_t> kept;
    // Selection sampling (Knuth, The Art of Computer Programming, 3.4.2, algorithm S).
    for (int64_t i = 0; i < n && int64_t(kept.size()) < count; ++i)
        if (double(n - i) * random.uniform(uint64_t(i)) < double(count - int64_t(kept.size())))
            kept.push_back(int32_t(i));
    return Mesh(geometry::gather_vertices(*data, kept));
}

Mesh subsample_voxels(const Mesh& mesh, double cell_size) {
    const auto data = points_of(mesh);
    geometry::require_vertices("subsample", *data);
    return Mesh(averaged(*data, CellGroups("subsample", data->V, cell_size)));
}

Mesh voxelize(const Mesh& mesh, double cell_size) {
    const auto data = points_of(mesh);
    geometry::require_vertices("voxelize", *data);
    const CellGroups groups("voxelize", data->V, cell_size);
    MeshData voxels = averaged(*data, groups);
    Array3f::Dense V(Eigen::Index(groups.count()), 3);
    for (size_t i = 0; i < groups.count(); ++i)
        V.row(Eigen::Index(i)) = groups.center(i).cast<float>().transpose();
    voxels.V = std::move(V);
    voxels.N = {};
    voxels.UV = {};
    voxels.voxel_size = float(cell_size);
    return Mesh(std::move(voxels));
}

}  // namespace easypbr
