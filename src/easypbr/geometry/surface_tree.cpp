#include <limits>

#include "easypbr/core/parallel.h"
#include "easypbr/core/triangle.h"
#include "easypbr/geometry/gather.h"
#include "easypbr/geometry/nearest.h"
#include "easypbr/geometry/require.h"
#include "easypbr/geometry/triangle_tree.h"
#include "easypbr/scene/mesh_arrays.h"

namespace easypbr {
struct SurfaceTree::Tree : geometry::TriangleTree {
    using TriangleTree::TriangleTree;

    struct Found {
        double squared = std::numeric_limits<double>::infinity();
        int32_t face = -1;
        Vec3d point = Vec3d::Zero();
    };

    Found nearest(const Vec3d& query) const {
        Found found;
        const auto squared_distance = [&](const geometry::TreeBox& box) {
            return box.squared_distance(query);
        };
        visit(squared_distance, found.squared, [&](size_t i) {
            const auto [a, b, c] = triangle(i);
            const Vec3d point = nearest_on_triangle(query, a, b, c);
            const double squared = (point - query).squaredNorm();
            if (squared < found.squared || (squared == found.squared && original[i] < found.face))
                found = {squared, original[i], point};
        });
        return found;
    }
};

Vec3d nearest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return detail::nearest_on_triangle(p, a, b, c);
}

SurfaceTree::SurfaceTree(const MeshData& mesh) {
    geometry::require_vertices("surface distance", mesh);
    require_faces(mesh.F, mesh.V.rows());
    tree_ = std::make_shared<const Tree>(mesh);
}

SurfaceTree::Nearest SurfaceTree::nearest(const Array3f& queries) const {
    const auto count = size_t(queries.rows());
    geometry::require_finite("surface distance", queries);
    Nearest result{std::vector<double>(count), std::vector<int32_t>(count), std::vector<Vec3d>(count)};
    parallel_for(count, 256, [&](size_t i) {
        const Tree::Found found = tree_->nearest(queries.row(Eigen::Index(i)).transpose().cast<double>());
        result.distance[i] = std::sqrt(found.squared);
        result.face[i] = found.face;
        result.point[i] = found.point;
    });
    return result;
}

}  // namespace easypbr
