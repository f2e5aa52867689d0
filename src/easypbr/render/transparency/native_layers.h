// Layers of surfaces that light passes, natively: from and to host memory.
#pragma once

#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// Depth peeling from behind as TransparencyPass does it:
///
///     begin(frame, targets, extensions);
///     while (open_layer(frame)) {
///         if (!close_layer(whether anything of the layered items is drawn into layer() by limits())) break;
///         ... layer() is lit ...
///         blend(targets, with_overlay, transfers);
///     }
class NativeLayers {
  public:
    /// The picture in `targets`, which hold the whole frame, is complete but for the layers, whose surfaces
    /// have these extensions.
    void begin(const Frame& frame, const GBuffer& targets, ExtensionSet extensions);
    /// Makes the next layer ready for drawing; false when the last allowed one has been drawn.
    bool open_layer(const Frame& frame);
    /// `drawn`: whether anything was drawn since open_layer().
    bool close_layer(bool drawn);
    /// Puts the lit layer over the picture.
    void blend(const GBuffer& targets, bool with_overlay, Transfers& transfers);

    /// Its targets hold what is covered of the layer, nothing beyond.
    const GBuffer& layer() const { return layer_; }
    /// Of what is covered of the frame: those of the open layer, and once it is drawn of the next one.
    PeelLimits& limits() { return limits_; }
    /// Whether the last frame had layers.
    bool has_layers() const { return count_ > 0; }

  private:
    GBuffer layer_;
    PeelLimits limits_;
    int count_ = 0;
    ScreenShader blend_{"transparency_layer.frag", native::Shader::transparency_layer};
};

}  // namespace easypbr::render
