// What is left out as a whole: outside of a picture, turned away, or hidden.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/core/parallel.h"
#include "easypbr/core/picture.h"
#include "easypbr/render/raster/face_clusters.h"

namespace easypbr::render {

struct ScreenTriangles;

/// Reversed depths of what is drawn are at least that: 0 is where there is nothing.
inline constexpr float least_depth = 1e-30f;

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

/// What something covers at most.
struct ScreenBounds {
    /// The first and the last pixel within the area that is drawn; none where the last is before the first.
    int left, top, right, bottom;
    /// The reversed depth of what is nearest; infinite where something may lie before the near plane.
    float nearest;

    static constexpr ScreenBounds nothing() { return {1, 1, 0, 0, 0}; }
    constexpr bool empty() const { return left > right || top > bottom; }
};

/// Whatever is drawn counts, also behind what is drawn already.
struct NothingHides {
    static constexpr bool hides(const ScreenBounds& /*bounds*/) { return false; }
};

/// Asks whether neighbours are hidden while some of them are: where the first ones are seen the others most
/// likely are, and asking would cost more than it saves.
template <class Depths>
class NeighborsHidden {
  public:
    explicit NeighborsHidden(Depths& depths) : depths_(depths) {}
    /// bounds(): ScreenBounds of one of them.
    template <class BoundsOf>
    bool hides(const BoundsOf& bounds) {
        if (asked_ >= first_ones && hidden_ * least_share < asked_) return false;
        ++asked_;
        const bool hidden = depths_.hides(bounds());
        hidden_ += hidden;
        return hidden;
    }

  private:
    static constexpr int first_ones = 4, least_share = 8;

    Depths& depths_;
    int asked_ = 0, hidden_ = 0;
};

/// Which spheres are outside of the picture, and where the others are.
class SphereCulling {
  public:
    /// See Frustum.
    SphereCulling(const Mat4& clip_from_mesh, Vec2i size, const PixelRect& area, float pixels = 1,
                  float pixels_times_w = 0);
    bool drops(const Vec3& center, float radius) const { return frustum_.drops(center, radius); }
    /// What the points of a sphere cover, rounded as the rasterisers round them.
    ScreenBounds bounds(const Vec3& center, float radius) const;
    /// The reversed depth of a sphere's centre, at most 1 and 1 behind the viewer; -1 of a sphere that is
    /// outside.
    float depth(const Vec3& center, float radius) const;

  private:
    Frustum frustum_;
    Mat4 clip_from_mesh_, magnitudes_;
    Vec4 lengths_;  ///< of the rows, without translation
    Vec2 half_size_;
    PixelRect area_;
    float pixels_, pixels_times_w_;
};

/// The numbers of reversed depths, finite ones, roughly from the nearest to the farthest; without those below
/// 0.
std::vector<uint32_t> near_to_far(std::span<const float> depths);

/// Calls body(span of numbers below `count`) on all cores, at most `grain` at a time, for all whose
/// depth(number) is not below 0, roughly from the nearest to the farthest: what is near may hide others.
template <class Depth, class Body>
void visit_near_to_far(size_t count, size_t grain, const Depth& depth, const Body& body) {
    std::vector<float> depths(count);
    parallel_for(count, grain, [&](size_t i) { depths[i] = depth(i); });
    const std::vector<uint32_t> order = near_to_far(depths);
    std::atomic<size_t> begun{0};
    parallel_chunks(order.size(), grain, [&](size_t, size_t) {
        const size_t first = grain * begun.fetch_add(1, std::memory_order_relaxed);
        body(std::span(order).subspan(first, std::min(grain, order.size() - first)));
    });
}

/// Which clusters are outside of the picture, or turned away as a whole.
class ClusterCulling {
  public:
    /// Of `area`, a part of a picture of that size.
    ClusterCulling(const ScreenTriangles& triangles, Vec2i size, const PixelRect& area);
    /// See SphereCulling; -1 of clusters that are dropped.
    float depth(const FaceClusters::Cluster& cluster) const;
    /// Nothing of a cluster would have to be clipped; false where its sphere alone does not tell.
    bool is_inside(const FaceClusters::Cluster& cluster) const;
    ScreenBounds bounds(const FaceClusters::Cluster& cluster) const;

  private:
    SphereCulling spheres_;
    Frustum unclipped_;
    Vec4 eye_;  ///< faces that have it behind their planes are dropped; 0: none are
};

}  // namespace easypbr::render
