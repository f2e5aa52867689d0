// The casters of a RayScene as Embree holds them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/gpu/facing.h"
#include "easypbr/render/primitives/hit_surface.h"
#include "easypbr/render/primitives/primitive.h"
#include "easypbr/render/primitives/ray_geometry.h"
#include "easypbr/render/raytrace/embree_scene.h"
#include "easypbr/render/raytrace/ray_callbacks.h"

namespace easypbr::render {

/// Kinds of primitives add their items; then `tree` is built. All is in RayScene's frame.
struct CasterTree final : RayGeometry {
    /// `centre` and `unit`: RayScene::centre() and unit().
    CasterTree(const Vec3d& centre, double unit)
        : world_scale(1 / unit), from_world(Eigen::Scaling(1 / unit) * Eigen::Translation3d(-centre)) {}

    void add_faces(const DrawItem& item) override;
    void add_discs(const DrawItem& item, double world_radius) override;
    void add_polygons(const DrawItem& item, int corners,
                      const std::function<void(Eigen::Index, std::span<Vec3d>)>& polygon) override;
    void add_gaussians(const DrawItem& item,
                       const std::function<RayGaussian(Eigen::Index)>& gaussian) override;

    double world_scale;
    Eigen::Affine3d from_world;
    embree::Scene tree;
    bool calls_back = false;  ///< some primitive does, for each ray alone
    std::vector<std::unique_ptr<RayElement>> elements;
    std::vector<std::unique_ptr<RayGaussians>> gaussians;
    std::vector<Primitive*> kinds;                      ///< of the elements
    std::vector<float> reaches;                         ///< likewise
    std::vector<std::unique_ptr<HitSurface>> surfaces;  ///< likewise, once they are made
    std::map<const SceneSnapshot::Object*, std::vector<Vec3>> vertices;
    std::map<const SceneSnapshot::Object*, gpu::Winding> windings;  ///< of those that light passes

  private:
    Eigen::Affine3d placed(const DrawItem& item) const;
    void attach(const embree::Geometry& geometry, RayElement given);
    /// Of faces that light passes.
    void set_winding(RayElement& element);
    /// Of the parts of an object the same.
    const std::vector<Vec3>& vertices_of(const DrawItem& item, const Eigen::Affine3d& T);
};

}  // namespace easypbr::render
