// What is seen where: objects, their parts and elements, and positions, pixel by pixel.
#pragma once

#include <optional>
#include <string>

#include "easypbr/core/image.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/scene.h"

namespace easypbr::app {

/// What lies under a pixel.
struct Pick {
    std::string object;  ///< name in the scene, "car/wheel" for a child
    std::string part;    ///< name of the part of the mesh, empty where it has none
    int part_index = -1;
    bool is_face = true;      ///< else a point
    int element = -1;         ///< index of the face or point
    Vec3d position{0, 0, 0};  ///< world, in the scene's frame
    double depth = 0;         ///< along the optical axis
};

/// The surfaces of one view, kept so that a pointer that moves over them asks for no drawing.
class PickBuffer {
  public:
    /// Layers id, element and depth of a picture of `scene` from `camera`, drawn with the settings' style.
    PickBuffer(SceneSnapshot scene, const Style& overrides, const Camera& camera, Image id, Image element,
               Image depth);

    /// What is seen in the pixel that the point lies in, counted from the picture's top left corner; nothing
    /// where there is no surface or outside of the picture.
    std::optional<Pick> at(Vec2d pixel) const;

    Vec2i size() const { return {id_.width(), id_.height()}; }

  private:
    SceneSnapshot scene_;
    Style overrides_;
    Camera camera_;
    Image id_, element_, depth_;
};

}  // namespace easypbr::app
