// Surfaces that light passes, over the lit picture: one layer after the other, from the farthest to the
// nearest.
#pragma once

#include "easypbr/gl/query.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/lighting/lighting_pass.h"

namespace easypbr::render {

/// Depth peeling (Everitt 2001) from behind. Each layer has a G-buffer of its own, which is filled with
/// peel() and lit like any other:
///
///     begin(frame, targets, opaque, extensions, with_overlay);
///     while (open_layer(frame)) {
///         ... the layered items are drawn into layer() with peel() ...
///         if (!close_layer()) break;
///         if the layer is transmissive: keep_picture(frame, targets, ...);
///         if it holds volumes: open_exits(frame);
///             ... the volumes are drawn into exits() with peel() ...
///             close_exits();
///         ... layer() is lit, with transmission() ...
///         blend(frame, targets, eye_dome);
///     }
///
/// So the result depends neither on the order in which surfaces are drawn nor on how they intersect. Surfaces
/// at exactly the same depth count as one.
class TransparencyPass {
  public:
    /// The picture in `targets` is complete but for the layers, whose surfaces have these extensions. Nothing
    /// behind `opaque` (R32F, reversed depth, 0 infinitely far) is drawn, which stays as it is.
    /// `with_overlay`: something is in the overlay, or may come into it.
    void begin(const Frame& frame, const GBuffer& targets, const gl::Texture& opaque, ExtensionSet extensions,
               bool with_overlay);
    /// Makes the next layer ready for drawing; false when the last allowed one has been drawn.
    bool open_layer(const Frame& frame);
    /// Whether anything was drawn since open_layer().
    bool close_layer();
    /// Keeps the picture as it is for transmissive surfaces, blurred too where `rough` is set. There is no
    /// geometry farther than `reach` from the camera.
    void keep_picture(const Frame& frame, const GBuffer& targets, bool rough, double reach);
    /// Makes the targets ready for the volumes' back faces behind the layer.
    void open_exits(const Frame& frame);
    void close_exits();
    /// Puts the lit layer over the picture. `eye_dome`: the shade of points without normals, where there are
    /// any.
    void blend(const Frame& frame, const GBuffer& targets, const gl::Texture* eye_dome);

    const GBuffer& layer() const { return layer_; }
    const GBuffer& exits() const { return exits_; }
    /// The layer that is open.
    const Peel& peel() const { return peel_; }
    /// What is seen through it; null where nothing has been kept.
    const TransmissionInputs* transmission() const { return kept_ ? &transmission_ : nullptr; }
    /// Whether the last frame had layers.
    bool has_layers() const { return count_ > 0; }

  private:
    void merge_overlay(const Frame& frame, const GBuffer& targets);
    void blend_radiance(const Frame& frame, const GBuffer& targets);
    void blend_overlay(const Frame& frame, const gl::Texture* eye_dome);
    /// Of what is drawn where the layer holds something.
    gl::DrawState layer_state(const Frame& frame, const gl::Blending& blending) const;
    void bind_layer(const gl::Program& program, const Frame& frame) const;

    GBuffer layer_, exits_;
    gl::Texture limit_;
    gl::Framebuffer radiance_, overlay_;  ///< the picture's targets with the layer's depth test
    gl::OcclusionQuery query_;
    Peel peel_;
    TransmissionInputs transmission_;
    bool kept_ = false;  ///< transmission_ is of the open layer
    ExtensionSet extensions_ = 0;
    bool with_overlay_ = false;
    gl::Texture picture_;  ///< of what is behind, with mip levels
    std::vector<gl::Framebuffer> levels_;
    int count_ = 0;
    ProgramVariants programs_{"screen_triangle.vert", "transparency_blend.frag"};
    ProgramVariants merge_{"screen_triangle.vert", "transparency_behind.frag"};
    ProgramVariants downsample_{"screen_triangle.vert", "downsample_picture.frag"};
};

}  // namespace easypbr::render
