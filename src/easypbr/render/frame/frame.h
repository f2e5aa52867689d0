// What every pass of one frame needs to know: the camera in the shaders' terms.
#pragma once

#include <vector>

#include "easypbr/core/picture.h"
#include "easypbr/gl/buffer.h"
#include "easypbr/gl/program.h"
#include "easypbr/gl/texture.h"
#include "easypbr/render/frame/extensions.h"
#include "easypbr/scene/motion.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {

using easypbr::PixelRect;

/// One layer of depth peeling: of what is nearer than the limit the farthest, or else the nearest.
struct Peel {
    const gl::Texture* limit = nullptr;  ///< R32F, reversed depth
    bool first = true;  ///< the limit is the opaque surfaces' depth; else a pixel with 0 takes no more
    bool farthest = true;
    bool backs = false;  ///< instead the nearest back faces that lie behind the limit
};

/// What is seen through a layer.
struct TransmissionInputs {
    const gl::Texture* picture = nullptr;  ///< radiance of all that is farther, with mip levels
    int levels = 1;
    const gl::Texture* depth = nullptr;        ///< of the opaque surfaces
    const gl::Texture* exit_depth = nullptr;   ///< of volumes' back faces
    const gl::Texture* exit_normal = nullptr;  ///< of volumes' back faces
    double reach = 0;                          ///< there is no geometry farther from the camera
};

/// What a frame shows once its passes have run.
struct LitPicture {
    const gl::Texture* radiance = nullptr;  ///< as GBuffer::radiance
    const gl::Texture* overlay = nullptr;   ///< as GBuffer::overlay, where there is one
    const gl::Texture* glow = nullptr;      ///< of BloomPass, where there is one
};

struct TracedLight;

/// A picture that is drawn whole sees all of itself.
inline constexpr double unlimited_reach = 1e9;

/// One frame of an accumulated picture.
struct Frame {
    const SceneSnapshot* scene = nullptr;
    const ResolvedSettings* resolved = nullptr;
    Camera camera;  ///< of this frame: the resolved one, moved where a still is sampled over lens or shutter
    Vec2i size{0, 0};
    Vec2i picture_size{0, 0};  ///< what the camera sees: all of it, or `size` pixels of it from `origin` on
    Vec2i origin{0, 0};
    double reach = unlimited_reach;  ///< screen-space effects look no farther than this, in pixels
    const Motion* motion = nullptr;  ///< the frames of a still are of different times, where something moved
    double time = 1;                 ///< of this frame, see shutter_time()
    bool through_lens = false;       ///< the frames of a still look through different places of the lens
    int sample_index = 0;
    int sample_count = 1;
    bool with_ids = false;
    bool with_overlay = false;                   ///< something is shown past light and tone curve
    bool with_exact = false;                     ///< colours of tables, which nothing may mix with others
    bool with_ground = false;                    ///< a plane under the content belongs to the picture
    ExtensionSet extensions = 0;                 ///< of the surfaces that are drawn and lit now
    bool spreads = false;                        ///< light may fall beyond `covered`
    bool partly_covered = false;                 ///< the radiance may hold coverages between 0 and 1
    const Peel* peel = nullptr;                  ///< set while a layer is drawn
    const TransmissionInputs* behind = nullptr;  ///< set while a layer is lit through which light goes
    const TracedLight* traced = nullptr;       ///< set while surfaces are lit whose sky rays have looked for
    Mat4d clip_from_view = Mat4d::Identity();  ///< jittered
    PixelRect covered;                         ///< all surfaces and lines are inside

    bool orthographic() const { return camera.projection == Projection::orthographic; }
};

/// Sub-pixel offset of a sample in [-0.5, 0.5): points of the Halton sequence in bases 2 and 3, moved so that
/// the mean of the first `count` is the pixel's centre. One sample is the centre itself.
Vec2d jitter_of(int index, int count);

/// Where on the lens, in parts of its radius, a sample looks through: points of a spiral (Vogel 1979), which
/// cover the disc evenly whatever their number. Their mean is the centre.
Vec2d lens_position(int index, int count);

/// When a sample is taken, from 0 (the picture before) to 1: evenly within the part of the time before 1 that
/// the shutter is open.
double shutter_time(int index, int count, double shutter);

/// Moves the camera to its place on the lens, and fills in the jittered projection and, from the bounds of
/// all geometry, the covered rectangle; the whole picture where splats or lines reach beyond the vertices.
void prepare_frame(Frame& frame, const Box3d& bounds, bool reaches_beyond);

/// First pixel of the frame, for shaders/common_noise.glsl: patterns lie on the picture, not on its tiles.
void set_noise_uniforms(const gl::Program& program, const Frame& frame);

/// Sets the uniforms of shaders/common_camera.glsl.
void set_camera_uniforms(const gl::Program& program, const Frame& frame);

/// Sets the uniforms of shaders/common_bloom.glsl.
void set_bloom_uniforms(const gl::Program& program, const Frame& frame);

/// Side of a texel of a glow, in pixels.
inline constexpr int glow_texel = 4;

/// Macros that shaders with the camera depend on.
std::vector<std::string> camera_defines(const Frame& frame);

/// Depth test of geometry: the nearest, or what the layer asks for.
void test_geometry_depth(const Frame& frame);

/// For a program with shaders/common_peel.glsl: sets its uniforms and binds the limit to a texture unit.
void set_peel_uniforms(const gl::Program& program, const Peel& peel, unsigned unit);

/// Draws shaders/screen_triangle.vert; the program is in use and the framebuffer bound.
void draw_screen_triangle();

}  // namespace easypbr::render
