// What is seen where: objects, their parts and elements, and positions, pixel by pixel.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "easypbr/app/lens.h"
#include "easypbr/render/pipeline/surface_frame.h"

namespace easypbr::app {

/// What lies under a pixel.
struct Pick {
    std::string object;  ///< name in the scene, "car/wheel" for a child
    std::string part;    ///< name of the part of the mesh, empty where it has none and for points
    int part_index = -1;
    bool is_face = true;      ///< else a vertex: of a point, a surfel or a voxel
    int element = -1;         ///< index of the face or vertex in the object's own data; the first in a voxel
    Vec3d position{0, 0, 0};  ///< world, in the scene's frame
    double depth = 0;         ///< along the optical axis
};

/// The surfaces of one view, kept so that a pointer that moves over them asks for no drawing.
class PickBuffer {
  public:
    /// What was drawn for the camera's lens, and the camera that the picture shows.
    PickBuffer(render::SurfaceFrame frame, Camera camera, std::shared_ptr<const LensMap> lens)
        : frame_(std::move(frame)), camera_(std::move(camera)), lens_(std::move(lens)) {}

    /// What is seen in the pixel that the point lies in, counted from the picture's top left corner; nothing
    /// where there is no surface or outside of the picture. Lines are no surface: what is behind them counts.
    std::optional<Pick> at(Vec2d pixel) const;

    Vec2i size() const { return lens_->is_identity() ? frame_.size : lens_->size; }

  private:
    render::SurfaceFrame frame_;
    Camera camera_;
    std::shared_ptr<const LensMap> lens_;
};

}  // namespace easypbr::app
