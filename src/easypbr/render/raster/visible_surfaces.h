// Surfaces whose nearest primitive is found natively for each pixel first, and its surface then, once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "easypbr/native/shaders.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/raster/surface_writer.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// An item with all that its pixels need.
class VisibleItem {
  public:
    virtual ~VisibleItem() = default;
    /// Writes the surfaces of some pixels.
    virtual void resolve(const Frame& frame, const DrawItem& item,
                         std::span<const native::VisiblePixel> pixels, SurfaceWriter& writer) const = 0;
    /// Which of the points at the same depth is seen. The number is that of a vertex.
    virtual PointRank rank(uint32_t primitive) const { return {0, primitive}; }
};

class VisibleSurfaces {
  public:
    /// Nothing is visible in a rectangle of a picture.
    void clear(Vec2i size, const PixelRect& area);

    /// Gives the memory back: clear() comes next.
    void release();

    /// Whether so many primitives more can be told apart.
    bool has_room(int64_t count) const { return next_id_ + count < int64_t(UINT32_MAX); }
    /// Adds an item of so many primitives; returns the id of the first, to be drawn into buffer().
    uint32_t add(const DrawItem& item, uint32_t count, std::unique_ptr<VisibleItem> visible);
    VisibilityBuffer& buffer() { return buffer_; }
    /// Of a primitive by its id. Numbers of different items differ.
    PointRank rank(uint32_t id) const;
    bool empty() const { return items_.empty(); }

    /// Shrinks the area to what is covered.
    const PixelRect& crop();
    /// Writes the area: what is visible, and nothing elsewhere.
    void resolve(const Frame& frame, SurfaceWriter& writer) const;

  private:
    struct Entry {
        uint32_t first_id;
        const DrawItem* item;
        std::unique_ptr<VisibleItem> visible;
    };
    const Entry& entry_of(uint32_t id) const;
    /// `run` is room to work in.
    void resolve_block(const Frame& frame, const PixelRect& block, std::vector<native::VisiblePixel>& run,
                       SurfaceWriter& writer) const;

    VisibilityBuffer buffer_;
    std::vector<Entry> items_;  ///< in the order of their ids
    int64_t next_id_ = 0;
};

}  // namespace easypbr::render
