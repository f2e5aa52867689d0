#include "easypbr/render/primitives/overlay_depths.h"

#include <algorithm>
#include <utility>

#include "easypbr/core/parallel.h"

namespace easypbr::render {

std::vector<float> read_depths(const gl::Texture& depth) {
    std::vector<float> depths(size_t(depth.width()) * size_t(depth.height()));
    gl::Framebuffer({&depth}).read(0, gl::Format::r32f, 0, 0, depth.width(), depth.height(),
                                   std::as_writable_bytes(std::span(depths)));
    return depths;
}

std::vector<float> whole_depths(const Target& depth) {
    std::vector<float> depths(size_t(depth.width()) * size_t(depth.height()));
    const PixelRect& area = depth.area();
    const std::span<const float> held = depth.pixels<float>();
    parallel_for(size_t(area.height), 64, [&](size_t y) {
        std::copy_n(held.data() + y * size_t(area.width), area.width,
                    depths.data() + (size_t(area.y) + y) * size_t(depth.width()) + size_t(area.x));
    });
    return depths;
}

void widen_by_a_pixel(std::vector<float>& depths, Vec2i size) {
    const std::vector<float> own = depths;
    parallel_for(size_t(size.y()), 16, [&](size_t row) {
        const int y = int(row);
        for (int x = 0; x < size.x(); ++x) {
            float& depth = depths[row * size_t(size.x()) + size_t(x)];
            if (depth > 0) continue;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.y() - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.x() - 1); ++u)
                    depth = std::max(depth, own[size_t(v) * size_t(size.x()) + size_t(u)]);
        }
    });
}

}  // namespace easypbr::render
