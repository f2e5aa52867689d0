// Draws what a light sees: the depth of the caster that is nearest to it, and what weakens the light on its
// way.
#pragma once

#include <span>

#include "easypbr/gl/texture.h"
#include "easypbr/render/primitives/primitive.h"

namespace easypbr::render {

/// What is drawn into a map.
struct MapCasters {
    const DrawList& list;
    std::span<const SceneSnapshot::Object* const> left_out;  ///< of the list's objects
};

class ShadowPass {
  public:
    /// Both must outlive this.
    ShadowPass(const Primitives& primitives, Transfers& transfers)
        : primitives_(primitives), transfers_(transfers) {}

    /// Fills one layer with the casters that stop light.
    void draw(const ShadowView& view, const MapCasters& casters, gl::Texture& maps, int layer,
              const gl::Framebuffer& framebuffer);

    /// The same in host memory, row by row. What cannot be rasterised natively is drawn and downloaded.
    void draw(const ShadowView& view, const MapCasters& casters, int resolution, std::span<float> layer);

    /// Fills one layer of the tints with the others, see shaders/shadow_target.glsl: what all of them take
    /// from the light, and where. `framebuffer` has both as attachments.
    void draw_tints(const ShadowView& view, const MapCasters& casters, const gl::Framebuffer& framebuffer);

    /// The same in host memory; the casters' kinds has_native_tints().
    void draw_tints(const ShadowView& view, const MapCasters& casters, TintLayer& layer);

    /// Without a GPU, casters are rasterised natively; false leaves them to the driver.
    void allow_native(bool allow) { native_ = allow; }

  private:
    /// Rasterises opaque casters natively; returns those that need the driver, by kind of primitive.
    std::vector<Casters> rasterise(const ShadowView& view, const MapCasters& all, bool native,
                                   ShadowDepths& depths);
    void draw_rest(const ShadowView& view, int resolution, const std::vector<Casters>& left);

    const Primitives& primitives_;
    Transfers& transfers_;
    bool native_ = true;
    DepthBuffer depths_;
};

}  // namespace easypbr::render
