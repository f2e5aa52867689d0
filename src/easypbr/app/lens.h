// Pictures of lenses with distortion or skew: a wider picture without them is drawn and warped.
#pragma once

#include <memory>
#include <vector>

#include "easypbr/core/image.h"
#include "easypbr/scene/camera.h"

namespace easypbr::app {

/// From the pixels of a picture to those of the picture that is drawn. Without distortion and skew the two
/// are the same, and `source` is empty.
struct LensMap {
    Vec2i size{0, 0};  ///< of the picture
    Camera drawn;      ///< what is drawn: a pinhole camera without skew
    Vec2i drawn_size{0, 0};
    std::vector<Vec2> source;  ///< for each pixel its place in the drawn picture, pixel centres at integers
    std::vector<Vec2> slopes;  ///< for each pixel x/z and y/z of its ray, OpenCV's axes

    bool is_identity() const { return source.empty(); }
    /// Place of the nearest drawn pixel, row by row.
    size_t nearest(size_t pixel) const;
    /// x/z and y/z of the ray through the middle of a drawn pixel. Not of an identity.
    Vec2d drawn_slope(size_t pixel) const;
};

/// The map of a camera for a picture of this size. Throws ArgumentError where the lens has no inverse
/// (Distortion::undistort), or when the picture to draw would be larger than `max_image_side` or
/// `max_picture_pixels`.
LensMap lens_map(const Camera& camera, Vec2i size);

/// The camera of the picture before as the picture of `now` is drawn, whose map this is: without distortion
/// and skew, and where `now` is drawn wider, as much wider. With the intrinsics of `now` it has exactly those
/// of what is drawn. Of its own distortion nothing is left: how a lens bends does not move.
Camera drawn_before(const Camera& before, const Camera& now, const LensMap& map);

/// Keeps the map that was asked for last.
class LensCache {
  public:
    /// lens_map() of the camera.
    const std::shared_ptr<const LensMap>& get(const Camera& camera, Vec2i size);

  private:
    std::shared_ptr<const LensMap> map_;
    std::vector<double> key_;
};

/// The picture as the lens shows it: bilinear, 0 where nothing was drawn. RGBA of an Encoding's type:
/// integers are sRGB codes with straight alpha, which are mixed as the light that they stand for, weighted by
/// alpha. `exact`: of the drawn picture's size, u8, one channel; where one of the four neighbours has not 0
/// the nearest pixel is taken. Null: nowhere. Throws std::logic_error for other than 4 channels.
Image warp(const Image& drawn, const LensMap& map, const Image* exact = nullptr);

/// The nearest drawn pixel of each: for values that must not be mixed. f32 only.
Image pick_nearest(const Image& drawn, const LensMap& map);

}  // namespace easypbr::app
