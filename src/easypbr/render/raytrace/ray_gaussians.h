// Gaussians that rays meet: as much as they stop of a ray where they are densest along it.
#pragma once

#include <cstddef>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/render/primitives/ray_geometry.h"

namespace easypbr::render {

class RayGaussians {
  public:
    explicit RayGaussians(size_t count) : gaussians_(count) {}
    size_t size() const { return gaussians_.size(); }

    /// `T` places meshes in the frame of the rays.
    void set(size_t i, const RayGaussian& gaussian, const Eigen::Affine3d& T);

    /// Where a ray meets one.
    struct Meeting {
        float distance = 0;
        float opacity = 0;  ///< 0: it is not met
    };
    /// `direction` of unit length.
    Meeting meet(size_t i, const Vec3& from, const Vec3& direction) const;
    /// Beyond it less than least_opacity is stopped; empty where that holds everywhere.
    Eigen::AlignedBox3f bounds(size_t i) const;

    /// What stops less of a ray is not there, and none stops more than most_opacity (Kerbl et al. 2023).
    static constexpr float least_opacity = 1.0f / 255, most_opacity = 0.99f;

  private:
    struct Gaussian {
        Vec3 mean;
        Mat3 whiten;  ///< makes it a unit Gaussian
        float opacity;
    };
    std::vector<Gaussian> gaussians_;
};

}  // namespace easypbr::render
