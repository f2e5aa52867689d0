// The overlays of all kinds of primitives, between the layers of what light passes.
#pragma once

#include <vector>

#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

/// The steps are those of OverlayStep. Without items none of them does anything.
class Overlays {
  public:
    /// The primitives must outlive this.
    explicit Overlays(const Primitives& primitives) : primitives_(primitives) {}

    /// Items, targets and `opaque` stay as they are until draw_over(). See OverlayStep::opaque. `host` is
    /// given for native drawing: until draw_over() from and to host memory, which holds the layers too.
    void begin(const Frame& frame, const ItemsByKind& items, const GBuffer& targets, const Target& opaque,
               Transfers* host, bool by_gpu);
    /// Adds what lies behind a layer, or all that is left.
    void draw(const Frame& frame, const ItemsByKind& items, const GBuffer& targets, const GBuffer* next);
    void draw_over(const Frame& frame, const ItemsByKind& items, const GBuffer& targets);
    /// Primitive::nearest_lines() of these items, since the beginning.
    const Target* nearest_lines(const ItemsByKind& items) const;

  private:
    void run(const Frame& frame, const ItemsByKind& items, const GBuffer& targets, OverlayStep step);
    void find_others(const ItemsByKind& items);

    const Primitives& primitives_;
    Transfers* host_ = nullptr;  ///< OverlayStep::host, since the beginning
    bool by_gpu_ = false;        ///< OverlayStep::by_gpu, since the beginning
    std::vector<float> others_;  ///< OverlayStep::others, since the beginning
};

}  // namespace easypbr::render
