// Flat colours over a picture of any pixel type.
#pragma once

#include "easypbr/core/color.h"
#include "easypbr/core/image.h"

namespace easypbr::app {

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// A picture as Session gives it: RGBA, 8 or 16 bits of sRGB with straight alpha, or linear floats with
/// premultiplied alpha. What is outside of the picture is left out.
class Canvas {
  public:
    /// The picture must outlive the canvas.
    explicit Canvas(Image& picture) : picture_(picture) {}

    int width() const { return picture_.width(); }
    int height() const { return picture_.height(); }

    /// Puts a colour over a pixel. Opaque colours are exact: the code, the code times 257, or its linear
    /// value.
    void blend(int x, int y, const Rgb8& color, float alpha);
    void fill(const PixelRect& rect, const Rgb8& color, float alpha = 1);

    /// Mean of what is seen, 0 black to 1 white, encoded as sRGB; white shows through transparent pixels.
    float brightness(const PixelRect& rect) const;

  private:
    template <class T>
    void blend_pixel(T* pixel, const Rgb8& color, float alpha) const;
    PixelRect clipped(const PixelRect& rect) const;

    Image& picture_;
};

}  // namespace easypbr::app
