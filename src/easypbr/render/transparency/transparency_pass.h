// Surfaces that light passes, over the lit picture: one layer after the other, from the farthest to the
// nearest.
#pragma once

#include "easypbr/gl/query.h"
#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"

namespace easypbr::render {

/// Depth peeling (Everitt 2001) from behind. Each layer has a G-buffer of its own, which the geometry passes
/// fill while frame.peel is set, and which is lit like any other:
///
///     begin(frame, targets, opaque);
///     while (open_layer(frame)) {
///         ... geometry passes draw the layered items into layer() ...
///         if (!close_layer(frame)) break;
///         if light goes through the layer: look_behind(frame, targets, ...);
///         if it goes through volumes: open_exits(frame);
///             ... geometry pass draws the volumes into exits() ...
///             close_exits(frame);
///         ... lighting of layer() ...
///         blend(frame, targets, eye_dome);
///     }
///     end(frame);
///
/// So the result depends neither on the order in which surfaces are drawn nor on how they intersect. Surfaces
/// at exactly the same depth count as one.
class TransparencyPass {
  public:
    /// The picture in `targets` is finished but for the layers.
    /// Nothing behind `opaque` (R32F, reversed depth, 0 infinitely far) is drawn, which stays as it is.
    void begin(Frame& frame, const GBuffer& targets, const gl::Texture& opaque);
    /// Makes the next layer ready for drawing; false when the last allowed one has been drawn.
    bool open_layer(Frame& frame);
    /// Whether anything was drawn since open_layer().
    bool close_layer(Frame& frame);
    /// Keeps the picture as it is for surfaces through which it is seen, blurred too where `rough` is set.
    /// There is no geometry farther than `reach` from the camera.
    void look_behind(Frame& frame, const GBuffer& targets, bool rough, double reach);
    /// Makes the targets ready for the volumes' back faces behind the layer.
    void open_exits(Frame& frame);
    void close_exits(Frame& frame);
    /// Puts the lit layer over the picture. `eye_dome`: the shade of points without normals, where there are
    /// any.
    void blend(const Frame& frame, const GBuffer& targets, const gl::Texture* eye_dome);
    void end(Frame& frame);

    const GBuffer& layer() const { return layer_; }
    const GBuffer& exits() const { return exits_; }

  private:
    void merge_overlay(const Frame& frame, const GBuffer& targets);
    void blend_radiance(const Frame& frame, const GBuffer& targets);
    void blend_overlay(const Frame& frame, const gl::Texture* eye_dome);
    void bind_layer(const gl::Program& program, const Frame& frame) const;

    GBuffer layer_, exits_;
    gl::Texture limit_;
    gl::Framebuffer radiance_, overlay_;  ///< the picture's targets with the layer's depth test
    uint32_t radiance_id_ = 0, overlay_id_ = 0;
    gl::OcclusionQuery query_;
    Peel peel_;
    TransmissionInputs behind_;
    gl::Texture picture_;  ///< of what is behind, with mip levels
    std::vector<gl::Framebuffer> levels_;
    int count_ = 0;
    ProgramVariants programs_{"screen_triangle.vert", "transparency_blend.frag"};
    ProgramVariants merge_{"screen_triangle.vert", "transparency_behind.frag"};
    ProgramVariants downsample_{"screen_triangle.vert", "downsample_picture.frag"};
};

}  // namespace easypbr::render
