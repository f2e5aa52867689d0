// Writes surfaces that were found natively into a G-buffer in host memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "easypbr/native/kernels.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/surface_kind.h"

namespace easypbr::render {

/// What the G-buffer holds of one pixel.
struct SurfacePixel {
    Vec3 albedo{0, 0, 0};
    Vec3 normal{0, 0, 1};  ///< unit, world, on the side that is seen
    float alpha = 1;       ///< below 1 in layers alone
    float metallic = 0, roughness = 0;
    SurfaceKind kind = SurfaceKind::lit;
    float depth = 0;        ///< reversed; 0: nothing
    uint32_t object = 0;    ///< place in the snapshot
    uint32_t element = 0;   ///< of its object: the face or the vertex
    bool is_point = false;  ///< a vertex
};

/// Pixels of a rectangle in the targets' formats. They are counted row by row; different ones may be written
/// by different threads.
class SurfaceWriter {
  public:
    /// Begins to write a rectangle (GBuffer::write()), whose pixels are undefined.
    SurfaceWriter(const GBuffer& targets, const PixelRect& area, SurfaceContents contents);

    size_t index(int x, int y) const {
        return size_t(y - area_.y) * size_t(area_.width) + size_t(x - area_.x);
    }
    const PixelRect& area() const { return area_; }
    float depth(size_t index) const { return depth_[index]; }
    /// Whether the elements of pixels are asked for.
    bool has_elements() const { return !element_.empty(); }
    void put(size_t index, const SurfacePixel& pixel);
    void put_nothing(size_t index) {
        depth_[index] = 0;
        if (!id_.empty()) id_[index] = element_[index] = 0;
        if (!emission_.empty()) std::fill_n(&emission_[4 * index], 4, 0.0f);
    }
    /// Targets and constants for pixels of one surface: all that a pixel holds but its normal, depth and
    /// element, and what a shader says.
    void set_targets(native::VisibleTriangles& triangles, const SurfacePixel& surface) const;
    /// Nothing in all of the rectangle.
    void clear();

  private:
    PixelRect area_;
    std::span<uint64_t> albedo_;
    std::span<uint32_t> normal_, material_;
    std::span<float> depth_;
    std::span<uint32_t> id_, element_;   ///< empty where they are not asked for
    std::span<float> emission_;          ///< the same
    std::span<uint32_t> extensions_[2];  ///< the same
};

/// Adds one surface to targets in host memory, pixel by pixel, where it is nearer than what they hold.
/// Different pixels may be written by different threads.
class SurfaceFill {
  public:
    SurfaceFill(const GBuffer& targets, const SurfacePixel& surface);

    /// The pixel must be inside of what the targets hold.
    void put(int x, int y, float depth);

  private:
    PixelRect area_;
    std::span<uint64_t> albedo_;
    std::span<uint32_t> normal_, material_;
    std::span<float> depth_;
    std::span<float> emission_;  ///< empty where nothing emits
    uint64_t own_albedo_;
    uint32_t own_normal_, own_material_;
};

}  // namespace easypbr::render
