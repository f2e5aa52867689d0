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
        const auto column = unsigned(x - area_.x), row = unsigned(y - area_.y);
        if (column >= unsigned(area_.width) || row >= unsigned(area_.height)) return nullptr;
        return &pixels_[size_t(row) * size_t(area_.width) + column];
    }

  private:
    PixelRect area_;
    std::span<Pixel> pixels_;
};

}  // namespace easypbr::render
