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
    /// Albedo, normal, depth and element of a primitive of the item at a point of the picture in normalised
    /// device coordinates. `depth` is that in the visibility buffer.
    virtual SurfacePixel at(uint32_t primitive, double ndc_x, double ndc_y, float depth) const = 0;
    /// Writes the surfaces of some pixels of row `y` at once; false leaves them to at().
    virtual bool resolve(const Frame&, const DrawItem&, std::span<const native::VisiblePixel>, int /*y*/,
                         SurfaceWriter&) const {
        return false;
    }
    /// Of points at the same depth the one with the larger content is seen.
    virtual uint64_t content(uint32_t) const { return 0; }
};

class VisibleSurfaces {
  public:
    /// Nothing is visible in a rectangle of a picture.
    void clear(Vec2i size, const PixelRect& area);

    /// Whether so many primitives more can be told apart.
    bool has_room(int64_t count) const { return next_id_ + count < int64_t(UINT32_MAX); }
    /// Adds an item of so many primitives; returns the id of the first, to be drawn into buffer().
    uint32_t add(const DrawItem& item, uint32_t count, std::unique_ptr<VisibleItem> visible);
    VisibilityBuffer& buffer() { return buffer_; }
    uint64_t content(uint32_t id) const;
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
    void resolve_row(const Frame& frame, int y, std::vector<native::VisiblePixel>& run,
                     SurfaceWriter& writer) const;
    /// Pixels of one item.
    void resolve_run(const Frame& frame, const Entry& entry, std::span<const native::VisiblePixel> run, int y,
                     SurfaceWriter& writer) const;

    VisibilityBuffer buffer_;
    std::vector<Entry> items_;  ///< in the order of their ids
    int64_t next_id_ = 0;
};

}  // namespace easypbr::render
