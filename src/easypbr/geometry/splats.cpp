#include "easypbr/geometry/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "easypbr/core/error.h"
#include "easypbr/core/parallel.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr {
namespace {

constexpr size_t splat_edit_grain = 1 << 13;

/// The vertices for which stays(row) holds, and what hangs on them.
template <class Stays>
Mesh kept(const char* what, const MeshData& mesh, Stays&& stays) {
    geometry::Selection selection = geometry::select_all(mesh);
    std::vector<char> flags(size_t(mesh.V.rows()));
    parallel_for(flags.size(), splat_edit_grain,
                 [&](size_t i) { flags[i] = char(bool(stays(Eigen::Index(i)))); });
    selection.vertices.clear();
    for (size_t i = 0; i < flags.size(); ++i) {
        selection.place[i] = flags[i] ? int32_t(selection.vertices.size()) : -1;
        if (flags[i]) selection.vertices.push_back(int32_t(i));
    }
    if (selection.vertices.empty())
        throw ArgumentError(
            fmt::format("{}: nothing stays of '{}' with {} vertices", what, mesh.name, mesh.V.rows()));
    geometry::drop_degenerate(selection, mesh);
    return Mesh(geometry::chosen(mesh, selection));
}

Vec3d place_of(const MeshData& mesh, Eigen::Index i) {
    return mesh.V.row(i).transpose().cast<double>() + mesh.offset;
}

/// sRGB-encoded, and the opacity last.
ArrayXf colors_of(const SplatArrays& splats) {
    ArrayXf::Dense C(splats.sh.rows(), 4);
    C.leftCols(3) = (splats.sh.leftCols(3).array() * splat_constant + 0.5f).cwiseMax(0.0f).cwiseMin(1.0f);
    C.col(3) = splats.opacities;
    return ArrayXf(std::move(C));
}

}  // namespace

Mesh crop_box(const Mesh& mesh, const Box3d& box, Keep keep) {
    const auto data = mesh.snapshot();
    geometry::require_vertices("crop_box", *data);
    geometry::require_box("crop_box", box);
    return kept("crop_box", *data,
                [&](Eigen::Index i) { return box.contains(place_of(*data, i)) == (keep == Keep::inside); });
}

Mesh crop_sphere(const Mesh& mesh, const Vec3d& center, double radius, Keep keep) {
    const auto data = mesh.snapshot();
    geometry::require_vertices("crop_sphere", *data);
    geometry::require_sphere("crop_sphere", center, radius);
    return kept("crop_sphere", *data, [&](Eigen::Index i) {
        return ((place_of(*data, i) - center).norm() <= radius) == (keep == Keep::inside);
    });
}

Mesh prune_splats(const Mesh& mesh, const SplatLimits& limits) {
    const auto data = mesh.snapshot();
    geometry::require_splats("prune_splats", *data);
    if (std::isnan(limits.least_opacity) || std::isnan(limits.least_size) || std::isnan(limits.most_size))
        throw ArgumentError("prune_splats: expected limits that are numbers");
    const SplatArrays& splats = data->splats;
    return kept("prune_splats", *data, [&](Eigen::Index i) {
        const auto size = double(splats.scales.row(i).maxCoeff());
        return double(splats.opacities(i)) >= limits.least_opacity && size >= limits.least_size &&
               size <= limits.most_size;
    });
}

Mesh cloud_from_splats(const Mesh& mesh) {
    MeshData data = *mesh.snapshot();
    geometry::require_splats("cloud_from_splats", data);
    data.C = colors_of(data.splats);
    data.splats = {};
    return Mesh(std::move(data));
}

}  // namespace easypbr
