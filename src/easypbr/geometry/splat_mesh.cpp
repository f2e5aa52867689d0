#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/memory_budget.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/isosurface.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/scene/spacing.h"

namespace easypbr {
namespace {

/// Splats end at so many standard deviations.
constexpr double splat_extent = 3;
/// The least standard deviation, in cells.
constexpr double thinnest_splat = 0.5;
constexpr uint64_t bytes_a_sample = 29;

/// Semi-axes of a splat as columns.
Mat3d semi_axes(const MeshData& mesh, Eigen::Index i, const Vec3d& lengths) {
    const auto q = mesh.splats.rotations.row(i).cast<double>();
    return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix() * lengths.asDiagonal();
}

Vec3d scales_of(const MeshData& mesh, Eigen::Index i) {
    return mesh.splats.scales.row(i).transpose().cast<double>();
}

/// Half of the box in which a splat counts.
Vec3d half_box(const Mat3d& axes) {
    return splat_extent * axes.rowwise().norm();
}

Vec3d mean_of(const MeshData& mesh, Eigen::Index i) {
    return mesh.V.row(i).transpose().cast<double>();
}

/// What an evaluation needs of a splat.
struct Kernel {
    Vec3d mean;
    Mat3d inverse;  ///< of the covariance
    Vec3d half;     ///< of the box in which it counts
    double opacity = 0;
};

Kernel kernel_of(const MeshData& mesh, Eigen::Index i, double least_scale) {
    const Vec3d scales = scales_of(mesh, i).cwiseMax(least_scale);
    const Mat3d inverse_axes = semi_axes(mesh, i, scales.cwiseInverse());
    return {mean_of(mesh, i), inverse_axes * inverse_axes.transpose(), half_box(semi_axes(mesh, i, scales)),
            double(mesh.splats.opacities(i))};
}

/// Sums over the splats at each sample.
struct Density {
    explicit Density(size_t count, bool with_labels)
        : value(count),
          color(count, Vec3(0, 0, 0)),
          densest(with_labels ? count : 0),
          label(densest.size(), -1) {}

    std::vector<float> value;
    std::vector<Vec3> color;  ///< weighed by density
    std::vector<float> densest;
    std::vector<int32_t> label;  ///< of the densest
};

SampleGrid grid_of(const MeshData& mesh, int resolution) {
    const Box3d means = trimmed_bounds(mesh.V);
    Box3d box;
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
        const Vec3d mean = mean_of(mesh, i), half = half_box(semi_axes(mesh, i, scales_of(mesh, i)));
        if (means.contains(mean)) box.extend(Box3d(mean - half, mean + half));
    }
    SampleGrid grid;
    grid.step = box.sizes().maxCoeff() / resolution;
    if (!(grid.step > 0)) throw ArgumentError("mesh_from_splats: expected splats of some extent");
    // Two samples on all sides are outside of all splats.
    const Eigen::Vector3i cells = (box.sizes() / grid.step).array().ceil().cast<int>();
    grid.size = cells + Eigen::Vector3i::Constant(5);
    grid.corner = box.center() - grid.step * (grid.size - Eigen::Vector3i::Constant(1)).cast<double>() / 2;
    return grid;
}

class DensityField {
  public:
    DensityField(const MeshData& mesh, const MeshData& cloud, const SampleGrid& grid)
        : mesh_(mesh), cloud_(cloud), grid_(grid), density_(grid.count(), !mesh.L.empty()) {
        find_slices();
        parallel_for(size_t(grid.size.z()), 1, [&](size_t z) {
            for (const int32_t i : by_slice_[z]) add(i, int(z));
        });
    }
    const Density& density() const { return density_; }

  private:
    Kernel kernel(int32_t i) const { return kernel_of(mesh_, i, thinnest_splat * grid_.step); }
    /// First and last sample along an axis; those of the border stay empty.
    std::pair<int, int> range(const Kernel& kernel, int axis) const {
        const double at = (kernel.mean[axis] - grid_.corner[axis]) / grid_.step,
                     half = kernel.half[axis] / grid_.step;
        const double last = grid_.size[axis] - 2;
        return {int(std::ceil(std::clamp(at - half, 1.0, last + 1))),
                int(std::floor(std::clamp(at + half, 0.0, last)))};
    }
    void find_slices() {
        by_slice_.resize(size_t(grid_.size.z()));
        for (int32_t i = 0; i < int32_t(mesh_.V.rows()); ++i) {
            const auto [low, high] = range(kernel(i), 2);
            for (int z = low; z <= high; ++z) by_slice_[size_t(z)].push_back(i);
        }
    }
    void add(int32_t i, int z) {
        const Kernel one = kernel(i);
        const auto [x0, x1] = range(one, 0);
        const auto [y0, y1] = range(one, 1);
        const Vec3 color = cloud_.C.row(i).head<3>().transpose();
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const Vec3d d = grid_.corner + grid_.step * Vec3d(x, y, z) - one.mean;
                const double square = d.dot(one.inverse * d);
                if (square > splat_extent * splat_extent) continue;
                const auto part = float(one.opacity * std::exp(-square / 2));
                const size_t sample = grid_.index(x, y, z);
                density_.value[sample] += part;
                density_.color[sample] += part * color;
                if (density_.densest.empty() || part <= density_.densest[sample]) continue;
                density_.densest[sample] = part;
                density_.label[sample] = mesh_.L(i);
            }
    }

    const MeshData& mesh_;
    const MeshData& cloud_;  ///< of the same, with colours
    SampleGrid grid_;
    Density density_;
    std::vector<std::vector<int32_t>> by_slice_;  ///< splats that reach it
};

void add_looks(const Isosurface& surface, const Density& density, MeshData& to) {
    const auto count = Eigen::Index(surface.edges.size());
    ArrayXf::Dense C(count, 3);
    parallel_for(surface.edges.size(), size_t(1) << 14, [&](size_t i) {
        const auto& [inside, outside, part] = surface.edges[i];
        const Vec3 color = (1 - part) * density.color[inside] + part * density.color[outside];
        const float weight = (1 - part) * density.value[inside] + part * density.value[outside];
        C.row(Eigen::Index(i)) = (color / weight).cwiseMax(0.0f).cwiseMin(1.0f).transpose();
    });
    to.C = std::move(C);
    if (density.label.empty()) return;
    Array1i::Dense L(count);
    for (size_t i = 0; i < surface.edges.size(); ++i)
        L(Eigen::Index(i)) = density.label[surface.edges[i].inside];
    to.L = std::move(L);
}

}  // namespace

Mesh mesh_from_splats(const Mesh& mesh, const SplatMeshOptions& options) {
    const std::shared_ptr<const MeshData> source = mesh.snapshot();
    geometry::require_splats("mesh_from_splats", *source);
    geometry::require_in("mesh_from_splats: resolution", options.resolution,
                         geometry::splat_mesh_resolutions);
    if (!(options.level > 0 && options.level < 1))
        throw ArgumentError(fmt::format(
            "mesh_from_splats: level: expected a number above 0 and below 1, got {}", options.level));
    const SampleGrid grid = grid_of(*source, options.resolution);
    charge_memory(grid.count() * bytes_a_sample, "the samples of the splats' density");
    const Mesh cloud = cloud_from_splats(mesh);
    const DensityField field(*source, *cloud.snapshot(), grid);
    const Isosurface surface = isosurface(field.density().value, grid, float(options.level));
    if (surface.F.empty())
        throw ArgumentError(
            fmt::format("mesh_from_splats: the density is nowhere above the level {}; the most is {:.3g}",
                        options.level, *std::ranges::max_element(field.density().value)));
    MeshData result;
    result.name = source->name;
    result.offset = source->offset;
    result.T_parent_mesh = source->T_parent_mesh;
    result.label_map = source->label_map;
    add_looks(surface, field.density(), result);
    result.V = surface.V;
    result.F = surface.F;
    return Mesh(std::move(result));
}

}  // namespace easypbr
