// The plane that the content stands on: a surface, or only the shadows on it.
#pragma once

#include <optional>

#include "easypbr/render/frame/frame.h"
#include "easypbr/render/frame/gbuffer.h"
#include "easypbr/render/frame/programs.h"
#include "easypbr/render/frame/screen_shader.h"
#include "easypbr/render/lighting/mirrored_ground.h"

namespace easypbr::render {

/// An endless plane at settings.ground.height, seen from above only. It receives shadows and occlusion, and
/// casts none. In mode shadow it adds black with alpha = strength (1 - lit / unshadowed), where both are what
/// lights and environment send to the plane; in mode plane it is lit like any surface and fades out.
///
///     draw(frame, targets);          // after the other opaque surfaces
///     begin_light(frame, targets);   // mode shadow: LightingPass::draw_caught() into light() for each block
///     finish(frame, targets, ...);   // once targets.radiance is lit
///
/// Natively: shade(), LightingPass::shade_caught() into caught_light(), shade_finish().
class GroundPass {
  public:
    static bool is_on(const ResolvedSettings& resolved);
    static bool is_shadow_catcher(const ResolvedSettings& resolved);

    /// Whether a frame's camera is on the side from which the ground is seen. From the other side nothing is
    /// there: surfaces are lit and reflect as without it.
    static bool is_seen(const Frame& frame);

    /// An orthographic camera whose depth holds all of the ground that is in the picture, as far as 30 radii.
    static void widen_depth(Camera& camera, const ResolvedSettings& resolved, const Box3d& bounds);

    /// None where the ground is not seen, for a catcher before anything but a background of one colour, and
    /// for one that the camera sees from within the content. `bounds`: of the content.
    static std::optional<MirroredGround> mirrored(const Frame& frame, const Box3d& bounds);

    /// Writes the plane into the G-buffer where it is nearer than what is there.
    void draw(const Frame& frame, const GBuffer& targets);
    /// Empties light().
    void begin_light(const Frame& frame, const GBuffer& targets);
    /// RGBA32F: light that reaches the ground, and light that would without anything on it.
    const gl::Framebuffer& light() const { return light_framebuffer_; }
    /// `bounds`: of the content.
    void finish(const Frame& frame, const GBuffer& targets, const Box3d& bounds);

    /// The same in host memory, where the targets hold the whole frame.
    void shade(const Frame& frame, const GBuffer& targets);
    /// RGBA32F: see light(). It has to be written before it is added to, in each frame.
    const Target& caught_light(const Frame& frame) { return light_of(frame, gl::Format::rgba32f); }
    /// R32F, in its place: the part of the light that arrives.
    const Target& caught_part(const Frame& frame) { return light_of(frame, gl::Format::r32f); }
    /// Releases caught_light() and caught_part(), whichever was asked for last, unless caught() is needed.
    void shade_finish(const Frame& frame, const GBuffer& targets, const Box3d& bounds, Transfers& transfers);

    /// What the frame's shadow is made of, until the next frame: caught_light() or, R32F, caught_part().
    /// Null where nobody asks: only the codes of a transparent picture tell shadows from surfaces.
    const Target* caught(const ResolvedSettings& resolved) const;
    /// What shaders/common_caught.glsl reads of it.
    static void set_caught(ShaderInputs& values, const ResolvedSettings& resolved, const Target& caught);

  private:
    const Target& light_of(const Frame& frame, gl::Format format);
    ShaderInputs finish_inputs(const Frame& frame, const GBuffer& targets, const Box3d& bounds) const;

    Target light_;
    gl::Framebuffer light_framebuffer_;
    ProgramVariants surface_{"screen_triangle.vert", "geometry_ground.frag"};
    ScreenShader finish_{"ground_finish.frag", native::Shader::ground_finish};
};

}  // namespace easypbr::render
