// An image behind everything: as linear light, and where a frame shows it.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "easypbr/core/image.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// An image behind everything, shown as it is: neither exposure nor tone curve apply to it.
class BackgroundImage {
  public:
    /// `name`: for messages.
    BackgroundImage(std::shared_ptr<const Image> image, std::string name)
        : image_(std::move(image)), name_(std::move(name)) {}

    const std::shared_ptr<const Image>& image() const { return image_; }
    /// Linear light, premultiplied by alpha: halved as long as it has two texels for a pixel of a picture
    /// that it covers, or a side longer than `most_side`.
    const Target& light(const Vec2i& picture, int most_side);
    /// Scale and offset of the frame's texture coordinates with which that light covers the picture, centred,
    /// nothing distorted.
    Vec4 uv(const Frame& frame) const;
    /// The same in the pixels of a whole picture: RGBA, f32.
    Image covering(const Vec2i& picture);
    /// Longest side of light() that native shaders read.
    static constexpr int most_native_side = 1 << 15;

  private:
    int halvings(const Vec2i& picture, int most_side) const;
    /// Texture coordinates of the light by those of the image: halving leaves out odd lines at the end.
    Vec2 uv_scale() const;

    std::shared_ptr<const Image> image_;
    std::string name_;
    Target light_;
    int halvings_ = 0;  ///< of light_
};

}  // namespace easypbr::render
