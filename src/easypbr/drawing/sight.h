// Which stretches of an edge lie in the picture, and which of them are seen.
#pragma once

#include <vector>

#include "easypbr/drawing/feature_edges.h"
#include "easypbr/drawing/occluders.h"

namespace easypbr::drawing {

/// A stretch of an edge, as parts of its length in space, 0 at the first end and 1 at the second.
struct Stretch {
    double begin = 0, end = 1;
    bool visible = true;
};

/// What a camera sees of edges in a picture of a size.
class Sight {
  public:
    /// `margin`: pixels around the picture that still belong to it.
    Sight(const Camera& camera, const Vec2i& size, double margin);

    const Eye& eye() const { return eye_; }
    /// From the picture's top left corner, x right, y down.
    Vec2d pixel(const Vec3d& point) const;
    bool bends_lines() const { return camera_.is_warped(); }

    /// The stretches of an edge of an occluder inside the picture, in order. Visibility is found at places at
    /// most half a pixel apart, and where it changes to 1/64 of a pixel.
    std::vector<Stretch> stretches(const FeatureEdge& edge, size_t occluder,
                                   const Occluders& occluders) const;

  private:
    /// Half spaces, inside of which is normal.dot(point in the camera's frame) + offset >= 0.
    struct Plane {
        Vec3d normal;
        double offset;
    };
    /// The part of an edge inside of all planes; empty where end <= begin.
    Stretch clipped(const FeatureEdge& edge) const;

    Camera camera_;
    Vec2i size_;
    Eye eye_;
    std::vector<Plane> planes_;
};

}  // namespace easypbr::drawing
