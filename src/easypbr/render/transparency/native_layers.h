// Layers of surfaces that light passes, natively: from and to host memory.
#pragma once

#include <vector>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/lighting/lighting_pass.h"
#include "easypbr/render/raster/visibility.h"

namespace easypbr::render {

/// Depth peeling from behind as TransparencyPass does it:
///
///     begin(frame, opaque, extensions);
///     while (open_layer(frame)) {
///         if (!close_layer(whether anything of the layered items is drawn into layer() by limits())) break;
///         if the layer is transmissive: keep_picture(frame, targets, ...);
///         if it holds volumes: open_exits(frame);
///             ... the volumes are drawn into exits() by limits() ...
///             close_exits();
///         ... layer() is lit, with transmission() ...
///         blend(targets, with_overlay, eye_dome, transfers);
///     }
class NativeLayers {
  public:
    /// The picture is complete but for the layers, whose surfaces have these extensions. Nothing behind
    /// `opaque` (R32F, reversed depth, the whole frame) is drawn.
    void begin(const Frame& frame, const Target& opaque, ExtensionSet extensions);
    /// Makes the next layer ready for drawing; false when the last allowed one has been drawn.
    bool open_layer(const Frame& frame);
    /// `drawn`: whether anything was drawn since open_layer().
    bool close_layer(bool drawn);
    /// Makes the picture as it is what transmissive surfaces see, blurred too where `rough` is set. There is
    /// no geometry farther than `reach` from the camera.
    void keep_picture(const Frame& frame, const GBuffer& targets, bool with_overlay, bool rough, double reach,
                      Transfers& transfers);
    /// Makes the targets and the limits ready for the volumes' back faces behind the layer.
    void open_exits(const Frame& frame);
    void close_exits();
    /// Puts the lit layer over the picture. `eye_dome`: the shade of points without normals, where there are
    /// any.
    void blend(const GBuffer& targets, bool with_overlay, const Target* eye_dome, Transfers& transfers);

    /// Its targets hold what is covered of the layer, nothing beyond.
    const GBuffer& layer() const { return layer_; }
    const GBuffer& exits() const { return exits_; }
    /// What is seen through the open layer; null where nothing has been kept.
    const TransmissionInputs* transmission() const { return kept_ ? &transmission_ : nullptr; }
    /// Of what is covered of the frame: those of the open layer, and once it is drawn of the next one.
    PeelLimits& limits() { return limits_; }
    /// Whether the last frame had layers.
    bool has_layers() const { return count_ > 0; }

  private:
    /// The picture that transmissive surfaces see.
    const Target& seen_picture(const GBuffer& targets, bool with_overlay, float exposure,
                               Transfers& transfers);

    GBuffer layer_, exits_;
    PeelLimits limits_;
    int count_ = 0;
    TransmissionInputs transmission_;
    bool kept_ = false;           ///< transmission_ is of the open layer
    std::vector<Target> levels_;  ///< of the picture behind, each half as large as the one before it
    ScreenShader merge_{"transparency_behind.frag", native::Shader::transparency_behind};
    ScreenShader downsample_{"downsample_picture.frag", native::Shader::downsample_picture};
    ScreenShader blend_{"transparency_layer.frag", native::Shader::transparency_layer};
};

}  // namespace easypbr::render
