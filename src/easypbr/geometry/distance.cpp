#include "easypbr/geometry/nearest.h"

#include <algorithm>
#include <cmath>

#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/sample.h"
#include "easypbr/scene/merge.h"

namespace easypbr {
namespace {

SurfaceDistance summary(const std::vector<double>& distances) {
    SurfaceDistance result;
    if (distances.empty()) return result;
    for (const double distance : distances) {
        result.max = std::max(result.max, distance);
        result.mean += distance;
        result.root_mean_square += distance * distance;
    }
    result.mean /= double(distances.size());
    result.root_mean_square = std::sqrt(result.root_mean_square / double(distances.size()));
    return result;
}

bool has_area(const MeshData& mesh) {
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
        const auto corner = [&](int k) -> Vec3d {
            return mesh.V.row(mesh.F(f, k)).transpose().cast<double>();
        };
        if ((corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() > 0) return true;
    }
    return false;
}

}  // namespace

SurfaceDistance surface_distance(const Mesh& from, const Mesh& to, int64_t samples, uint64_t seed) {
    geometry::require_between("surface distance: samples", samples, 0, std::numeric_limits<int32_t>::max());
    const MeshData b = flatten_shape(to);
    MeshData a = flatten_shape(from);
    geometry::require_vertices("surface distance", a);
    a.V = positions_from(a, b.offset);
    a.offset = b.offset;
    const SurfaceTree tree(b);
    SurfaceDistance result = summary(tree.nearest(a.V).distance);
    if (samples == 0 || !has_area(a)) return result;
    const double at_vertices = result.max;
    result = summary(tree.nearest(sample_surface(Mesh(a), samples, seed).V()).distance);
    result.max = std::max(result.max, at_vertices);
    return result;
}

double hausdorff_distance(const Mesh& a, const Mesh& b, int64_t samples, uint64_t seed) {
    return std::max(surface_distance(a, b, samples, seed).max, surface_distance(b, a, samples, seed).max);
}

}  // namespace easypbr
