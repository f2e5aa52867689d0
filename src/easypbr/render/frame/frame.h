// What every pass of one frame needs to know: the camera in the shaders' terms.
#pragma once

#include <vector>

#include "easypbr/gl/draw.h"
#include "easypbr/gl/program.h"
#include "easypbr/render/frame/surface_outputs.h"
#include "easypbr/render/frame/target.h"
#include "easypbr/scene/motion.h"
#include "easypbr/scene/scene.h"

namespace easypbr {
struct ResolvedSettings;
}

namespace easypbr::render {

class ShaderInputs;

/// A picture that is drawn whole sees all of itself.
inline constexpr double unlimited_reach = 1e9;

/// What all frames of an accumulated picture share.
struct Shot {
    const SceneSnapshot* scene = nullptr;
    const ResolvedSettings* resolved = nullptr;
    Vec2i size{0, 0};
    Vec2i picture_size{0, 0};  ///< what the camera sees: all of it, or `size` pixels of it from `origin` on
    Vec2i origin{0, 0};
    double reach = unlimited_reach;  ///< screen-space effects look no farther than this, in pixels
    int sample_count = 1;
    const Motion* motion = nullptr;  ///< the frames are of different times, where something moved
    bool through_lens = false;       ///< the frames look through different places of the lens
    bool through_centres = false;    ///< all frames look through the pixels' centres
    /// Paths light all surfaces: their light is noisy, and frames are averaged before the tone curve.
    bool averages_radiance = false;
    /// The picture may end with fewer frames, by its noise or its time.
    bool may_end_early = false;
};

/// One frame of an accumulated picture, as every pass sees it.
struct Frame : Shot {
    Camera camera = {};  ///< the resolved one, moved where the picture is sampled over lens or shutter
    int sample_index = 0;
    double time = 1;                           ///< see shutter_time()
    Mat4d clip_from_view = Mat4d::Identity();  ///< jittered
    PixelRect covered = {};                    ///< all surfaces and lines are inside

    bool orthographic() const { return camera.projection == Projection::orthographic; }
    PixelRect whole() const { return {0, 0, size.x(), size.y()}; }
    /// The same frame, of which only a rectangle is covered.
    Frame covering(const PixelRect& area) const {
        Frame frame = *this;
        frame.covered = area;
        return frame;
    }
};

/// Sub-pixel offset of a sample in [-0.5, 0.5): points of the Halton sequence in bases 2 and 3, moved so that
/// the mean of the first `count` is the pixel's centre. One sample is the centre itself.
Vec2d jitter_of(int index, int count);

/// The same of a picture that may end after any of its samples: opposite points of the R2 sequence (Roberts
/// 2018) in pairs, so that the mean is the pixel's centre after each even number, and after all of them.
Vec2d paired_jitter_of(int index, int count);

/// Where on the lens, in parts of its radius, a sample looks through: points of a spiral (Vogel 1979), which
/// cover the disc evenly whatever their number. Their mean is the centre.
Vec2d lens_position(int index, int count);

/// When a sample is taken, from 0 (the picture before) to 1: evenly within the part of the time before 1 that
/// the shutter is open.
double shutter_time(int index, int count, double shutter);

/// Where a camera that moved was in one of the shot's frames.
Camera camera_of(const Shot& shot, int sample_index);

/// A frame seen from `camera`, which is moved to its place on the lens. The covered rectangle follows from
/// the bounds of all geometry; it is the whole frame where splats or lines reach beyond the vertices.
Frame make_frame(const Shot& shot, int sample_index, const Camera& camera, const Box3d& bounds,
                 bool reaches_beyond);

/// Place in view space of a pixel's centre at the depth that GBuffer::depth holds, above 0.
Vec3d view_position(const Frame& frame, Vec2i pixel, double depth);

/// First pixel of the frame, for shaders/common_noise.glsl: patterns lie on the picture, not on its tiles.
void set_noise_uniforms(const gl::Program& program, const Frame& frame);
void set_noise_uniforms(ShaderInputs& inputs, const Frame& frame);

/// Sets the uniforms of shaders/common_camera.glsl.
void set_camera_uniforms(const gl::Program& program, const Frame& frame);
void set_camera_uniforms(ShaderInputs& inputs, const Frame& frame);

/// Macros that shaders with the camera depend on.
std::vector<std::string> camera_defines(const Frame& frame);

/// The state of draws of geometry: the nearest, or what the layer asks for.
gl::DrawState geometry_state(const SurfaceOutputs& outputs);

/// The state of screen passes that touch a rectangle only.
gl::DrawState screen_state(const PixelRect& area, const gl::Blending& blending = gl::replace);

/// For a program with shaders/common_peel.glsl: sets its uniforms and binds the limit to a texture unit.
void set_peel_uniforms(const gl::Program& program, const Peel& peel, unsigned unit);

}  // namespace easypbr::render
