// What is seen where: objects, their parts and elements, and positions, pixel by pixel.
#pragma once

#include <memory>
#include <optional>

#include "easypbr/app/element_depth.h"
#include "easypbr/app/lens.h"
#include "easypbr/app/picture.h"
#include "easypbr/core/image.h"
#include "easypbr/render/pipeline/surface_frame.h"

namespace easypbr::app {

/// The surfaces of one view, kept so that a pointer that moves over them asks for no drawing.
class PickBuffer {
  public:
    /// What was drawn for the camera's lens, and the camera that the picture shows.
    PickBuffer(render::SurfaceFrame frame, Camera camera, std::shared_ptr<const LensMap> lens)
        : frame_(std::move(frame)), camera_(std::move(camera)), lens_(std::move(lens)) {}

    /// What is seen in the pixel that the point lies in, counted from the picture's top left corner; nothing
    /// where there is no surface or outside of the picture. Lines are no surface: what is behind them counts.
    std::optional<Pick> at(Vec2d pixel) const;

    /// Along the optical axis, where the pixels' own rays meet what is seen; 0 where there is nothing. One
    /// channel, f32.
    Image depths() const;

    Vec2i size() const { return lens_->is_identity() ? frame_.size : lens_->size; }

  private:
    /// In the camera's frame, OpenCV's axes, through a point of the picture.
    PixelRay ray_through(Vec2d pixel) const;
    /// Where a ray meets what is drawn at a pixel.
    double depth_along(const PixelRay& ray, size_t drawn) const;
    /// Through a lens the ray of the drawn pixel, which is another one.
    std::optional<PixelRay> ray_of_drawn(size_t drawn) const;

    render::SurfaceFrame frame_;
    Camera camera_;
    std::shared_ptr<const LensMap> lens_;
};

}  // namespace easypbr::app
