// What hides lines: the faces of all objects, in a tree of boxes.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/scene/eye.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::drawing {

/// A mesh with the faces that hide what lies behind them.
struct Occluder {
    std::shared_ptr<const MeshData> mesh;
    Eigen::Affine3d T_world_mesh;
    std::vector<Eigen::Index> faces;
};

class Occluders {
  public:
    /// Throws Error where there is not enough memory.
    explicit Occluders(std::span<const Occluder> occluders);
    ~Occluders();
    Occluders(const Occluders&) = delete;
    Occluders& operator=(const Occluders&) = delete;

    /// Whether a face lies between the eye and a point of `occluder`, but for `faces`, which the point lies
    /// on. A face that the point touches (touch_part of the content's size) does not hide it. Thread-safe.
    bool hide(const Vec3d& point, const Eye& eye, size_t occluder,
              const std::array<Eigen::Index, 2>& faces) const;

    static constexpr double touch_part = 2e-5;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace easypbr::drawing
