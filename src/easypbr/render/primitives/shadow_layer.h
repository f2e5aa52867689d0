// A layer of a shadow map, as kinds of primitives draw it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "easypbr/gl/draw.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/render/frame/shadow_view.h"
#include "easypbr/render/raster/tint_layer.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// What a map holds where there is no caster: before any depth.
inline constexpr float no_shadow_depth = -1e30f;
/// So many of their reaches casters are pushed away from the light at most.
inline constexpr float most_pushed = 5;

/// Items that cast shadows; the parts of an object follow each other.
using Casters = std::vector<const DrawItem*>;

/// The framebuffer of the layer is bound.
struct ShadowLayer {
    const ShadowView& view;
    int resolution = 0;  ///< texels a side
    bool tints =
        false;  ///< draws what weakens light (shaders/shadow_target.glsl); else the depth of what stops it

    Mat4 clip_from_mesh(const DrawItem& item) const {
        return (view.clip_from_world() * item.object->T_world_mesh.matrix()).cast<float>();
    }
    /// The largest depth stays, whatever the order: no depth buffer is needed. Tints add up, and keep the
    /// first and the last caster's depths in alpha.
    gl::DrawState state() const {
        if (!tints) return {.blending = gl::maximum};
        return {.blending = {.source = gl::Factor::one,
                             .target = gl::Factor::one,
                             .color_equation = gl::BlendEquation::add,
                             .alpha_equation = gl::BlendEquation::maximum}};
    }
};

/// Depths of a layer in host memory, for casters that are rasterised natively.
class ShadowDepths {
  public:
    explicit ShadowDepths(DepthBuffer& buffer, int resolution) : buffer_(buffer), resolution_(resolution) {}

    /// Nothing has been asked for yet: the layer holds no caster.
    bool empty() const { return !begun_; }
    int resolution() const { return resolution_; }
    DepthBuffer& buffer() {
        if (!begun_) buffer_.clear(Vec2i(resolution_, resolution_), no_shadow_depth);
        begun_ = true;
        return buffer_;
    }

  private:
    DepthBuffer& buffer_;
    int resolution_;
    bool begun_ = false;
};

/// What the shape of an item's shadow depends on beside its pose and material: revisions and other identities
/// of what it is made of, and lengths.
struct ShadowShape {
    std::array<uint64_t, 5> data{};
    std::array<double, 2> lengths{};
    bool operator==(const ShadowShape&) const = default;
};

}  // namespace easypbr::render
