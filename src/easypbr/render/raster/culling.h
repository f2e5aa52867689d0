// What is left out as a whole: outside of a picture, or turned away.
#pragma once

#include <array>

#include "easypbr/core/math.h"
#include "easypbr/core/picture.h"
#include "easypbr/render/raster/face_clusters.h"

namespace easypbr::render {

struct ScreenTriangles;

class Frustum {
  public:
    /// Of `area`, a part of a picture of that size. What lies beside it by as many pixels is inside too, and
    /// by as many divided by the clip coordinate w.
    Frustum(const Mat4& clip_from_mesh, Vec2i size, const PixelRect& area, float pixels = 1,
            float pixels_times_w = 0);
    /// Nothing of a sphere is inside.
    bool drops(const Vec3& center, float radius) const {
        for (const Plane& p : planes_)
            if (p.plane.head<3>().dot(center) + p.plane.w() < -radius * p.length) return true;
        return false;
    }
    /// All of a sphere is inside.
    bool holds(const Vec3& center, float radius) const {
        for (const Plane& p : planes_)
            if (!(p.plane.head<3>().dot(center) + p.plane.w() > radius * p.length)) return false;
        return true;
    }

  private:
    /// Homogeneous points are outside where its product with them is negative.
    struct Plane {
        Vec4 plane;
        float length;  ///< of its first three components
    };
    std::array<Plane, 6> planes_;
};

/// Which clusters are outside of the picture, or turned away as a whole.
class ClusterCulling {
  public:
    /// Of `area`, a part of a picture of that size.
    ClusterCulling(const ScreenTriangles& triangles, Vec2i size, const PixelRect& area);
    bool drops(const FaceClusters::Cluster& cluster) const;
    /// Nothing of a cluster would have to be clipped; false where its sphere alone does not tell.
    bool is_inside(const FaceClusters::Cluster& cluster) const;

  private:
    Frustum frustum_, unclipped_;
    Vec4 eye_;  ///< faces that have it behind their planes are dropped; 0: none are
};

}  // namespace easypbr::render
