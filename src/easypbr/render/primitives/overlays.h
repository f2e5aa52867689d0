// The overlays of all kinds of primitives, between the layers of what light passes.
#pragma once

#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

/// The steps are those of Primitive. Without items none of them does anything.
class Overlays {
  public:
    /// The primitives must outlive this.
    explicit Overlays(const Primitives& primitives) : primitives_(primitives) {}

    void begin(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
               const gl::Texture& opaque);
    void draw_behind(const Frame& frame, const ItemsByKind& items, const GBuffer& targets,
                     const GBuffer& layer);
    void draw_rest(const Frame& frame, const ItemsByKind& items, const GBuffer& targets);
    void draw_over(const Frame& frame, const ItemsByKind& items, const GBuffer& targets);
    void shade(const Frame& frame, const ItemsByKind& items, const GBuffer& targets, Transfers& transfers);

  private:
    const Primitives& primitives_;
};

}  // namespace easypbr::render
