#include "easypbr/render/raster/frustum.h"

namespace easypbr::render {

Frustum::Frustum(const Mat4& m, Vec2i size, const PixelRect& area, float pixels, float pixels_times_w) {
    const Vec2 half = size.cast<float>() / 2;
    // In normalised device coordinates.
    const float left = (float(area.x) - pixels) / half.x() - 1,
                right = (float(area.x + area.width) + pixels) / half.x() - 1,
                top = 1 - (float(area.y) - pixels) / half.y(),
                bottom = 1 - (float(area.y + area.height) + pixels) / half.y();
    const Vec4 x = m.row(0), y = m.row(1), w = m.row(3);
    const Vec4 across = Vec4(Vec4::Unit(3)) * (pixels_times_w / half.x()),
               along = Vec4(Vec4::Unit(3)) * (pixels_times_w / half.y());
    const Vec4 planes[] = {x - left * w + across, right * w - x + across, y - bottom * w + along,
                           top * w - y + along, w - Vec4(m.row(2))};
    for (size_t i = 0; i < planes_.size(); ++i) planes_[i] = {planes[i], planes[i].head<3>().norm()};
}

}  // namespace easypbr::render
