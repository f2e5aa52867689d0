// Pixels of targets in host memory, by their place in the picture.
#pragma once

#include <span>

#include "easypbr/render/frame/target.h"

namespace easypbr::render {

/// A target in host memory: the pixel at a place, nothing beyond what is held.
template <class Pixel>
class HeldPixels {
  public:
    explicit HeldPixels(const Target& target) : area_(target.area()), pixels_(target.pixels<Pixel>()) {}

    Pixel* at(int x, int y) const {
        if (x < area_.x || y < area_.y || x >= area_.x + area_.width || y >= area_.y + area_.height)
            return nullptr;
        return &pixels_[size_t(y - area_.y) * size_t(area_.width) + size_t(x - area_.x)];
    }

  private:
    PixelRect area_;
    std::span<Pixel> pixels_;
};

}  // namespace easypbr::render
