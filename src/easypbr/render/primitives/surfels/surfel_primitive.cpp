#include "easypbr/render/primitives/surfels/surfel_primitive.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace easypbr::render {
namespace {

/// Corners of the polygon that an ellipse is for rays; its area is that of the ellipse. Few ellipses may be
/// large in the picture, many are small.
int corners_for(Eigen::Index ellipses) {
    constexpr Eigen::Index most_in_all = 1 << 16;
    return int(std::clamp<Eigen::Index>(most_in_all / std::max<Eigen::Index>(ellipses, 1), 8,
                                        RayGeometry::most_corners));
}

}  // namespace

void SurfelPrimitive::draw(const Frame& frame, DrawItems items, const GBuffer& targets,
                           const SurfaceOutputs& outputs) {
    if (items.empty()) return;
    splats_.sum(frame, items, targets.depth.texture(), outputs);
    (outputs.ids ? targets.surface_ids() : targets.surface_emission()).bind();
    splats_.write(frame, outputs);
}

std::vector<SurfelSource> SurfelPrimitive::sources_of(const Frame& frame, DrawItems items) {
    std::vector<SurfelSource> sources;
    for (const DrawItem& item : items)
        sources.push_back({&item, SurfelProjector(item, frame, splats_.spacing_of(item), batches_)});
    return sources;
}

void SurfelPrimitive::add_mean(const Frame& frame, DrawItems items, std::span<const float> hides,
                               const SurfaceOutputs& outputs, SurfaceWriter& writer) {
    software_.draw(frame, sources_of(frame, items), hides, outputs.nearest_alone, writer);
}

ShadowShape SurfelPrimitive::shadow_shape(const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    return {{mesh.V.revision(), mesh.N.revision(), mesh.T.revision(), mesh.B.revision()},
            {shadows_.reach(item), item.style.surfel_scale}};
}

ScreenReach SurfelPrimitive::screen_reach(const Frame&, const DrawItem& item) {
    // A pose that shears stretches what lies aslant by more than its longest column, by less than sqrt(3).
    const Mat3d linear = item.object->T_world_mesh.linear();
    return {shadows_.reach(item) * linear.operatorNorm() / linear.colwise().norm().maxCoeff(), 1};
}

void SurfelPrimitive::add_to(RayGeometry& geometry, const DrawItem& item) {
    const MeshData& mesh = item.mesh();
    const auto own_radius = float(shadows_.radius(item));
    const int count = corners_for(mesh.V.rows());
    const double turn = 2 * std::numbers::pi / count;
    const double same_area = std::sqrt(turn / std::sin(turn)) * item.style.surfel_scale;
    geometry.add_polygons(item, count, [&](Eigen::Index i, std::span<Vec3d> corners) {
        const Vec3d centre = mesh.V.row(i).transpose().cast<double>(),
                    n = mesh.N.row(i).transpose().cast<double>().normalized();
        const Vec3d t = mesh.T.empty() ? Vec3d(n.unitOrthogonal() * own_radius)
                                       : Vec3d(mesh.T.row(i).transpose().cast<double>());
        const double length = mesh.B.empty() ? t.norm() : double(mesh.B(i));
        const Vec3d b = n.cross(t).normalized() * length;
        for (size_t c = 0; c < corners.size(); ++c) {
            const double angle = turn * int(c);
            corners[c] = centre + same_area * (std::cos(angle) * t + std::sin(angle) * b);
        }
    });
}

}  // namespace easypbr::render
