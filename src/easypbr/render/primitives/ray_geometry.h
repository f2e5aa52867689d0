// What rays can meet, as kinds of primitives tell it.
#pragma once

#include <functional>
#include <span>

#include "easypbr/render/drawables/draw_list.h"

namespace easypbr::render {

/// A Gaussian in the frame of its mesh, of one opacity at its mean.
struct RayGaussian {
    Vec3d mean;
    Mat3d axes;  ///< columns: semi-axes of one standard deviation, of which none is 0
    float opacity = 1;
};

class RayGeometry {
  public:
    virtual ~RayGeometry() = default;

    /// The triangles of the item's part of its mesh.
    virtual void add_faces(const DrawItem& item) = 0;
    /// A disc around each vertex, across its normal, or towards the ray where the mesh has none. `radius` is
    /// in world units.
    virtual void add_discs(const DrawItem& item, double radius) = 0;
    static constexpr int most_corners = 48;
    /// A convex polygon of `corners` corners, 3 to most_corners, for each vertex. polygon(vertex, out) gives
    /// them in the mesh's frame; it is called from several threads.
    virtual void add_polygons(
        const DrawItem& item, int corners,
        const std::function<void(Eigen::Index vertex, std::span<Vec3d> out)>& polygon) = 0;
    /// A Gaussian for each vertex, which stops a ray with its opacity where it is densest along the ray.
    /// gaussian(vertex) is called from several threads.
    virtual void add_gaussians(const DrawItem& item,
                               const std::function<RayGaussian(Eigen::Index vertex)>& gaussian) = 0;
};

}  // namespace easypbr::render
