// Shaders that run on the CPU: the text of shaders/, translated by scripts/native_shaders.py and compiled for
// several instruction sets, of which the best that the processor has is chosen when the first one runs.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/native/kernels.h"

namespace easypbr::native {

/// Names of the instruction sets that the library was built for and the processor has, the best first.
/// `$EASYPBR_ISA` names the one that is used, "v2", "avx2" or "avx512".
std::vector<std::string_view> instruction_sets();
/// The one in use. Throws ArgumentError when $EASYPBR_ISA names none of instruction_sets().
std::string_view instruction_set();
/// Chooses another one. Throws ArgumentError when it is none of instruction_sets().
void use_instruction_set(std::string_view name);

/// What a shader reads: features that are on, and values by the names of its uniforms. A uniform that is not
/// given is 0. Pictures must live until the shader has run.
struct Inputs {
    using Bytes = std::span<const std::byte>;
    using Value = std::variant<int, float, Vec2, Vec3, Vec4, Mat3, View, Cube, Panorama, Layers, Layers4,
                               MipPicture, Texture, Bytes>;

    std::vector<std::string_view> features;
    std::vector<std::pair<std::string_view, Value>> values;

    template <class T>
    void set(std::string_view name, const T& value) {
        values.emplace_back(name, value);
    }
};

/// The uniforms of mesh_resolve, for VisibleTriangles::shader. Throws Error when a value is not of the
/// uniform's type.
std::shared_ptr<const void> surface_uniforms(const Inputs& inputs);
/// The same of mesh_extended, for triangles that are `extended`.
std::shared_ptr<const void> extended_uniforms(const Inputs& inputs);
/// The same of shadow_depth, for casters_of_triangles().
std::shared_ptr<const void> caster_uniforms(const Inputs& inputs);
/// Writes the surfaces of pixels. On the calling thread.
void resolve_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> pixels);
/// The opacity of pixels by the triangles' shader, before it is compared with a cutoff. On the calling
/// thread.
void alpha_of_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> pixels,
                        std::span<float> alpha);

/// What casters leave of light at texels of a shadow map, by the triangles' shader shadow_depth: four values
/// for each, what is absorbed of each channel (-ln(transmittance)), and the opacity. On the calling thread.
void casters_of_triangles(const VisibleTriangles& triangles, std::span<const VisiblePixel> texels,
                          std::span<float> values);

/// Evaluates the triangles' shader where rays have met them, with HitSurfaces::extensions where it is the
/// extended one. The arrays have room for a multiple of
/// stream_alignment hits. On the calling thread.
void shade_hits(const VisibleTriangles& triangles, std::span<const ElementHit> hits,
                const HitSurfaces& surfaces);

/// The uniforms of a stream's shader. Throws Error when a value is not of the uniform's type.
std::shared_ptr<const void> stream_uniforms(Stream shader, const Inputs& inputs);
// Shade a stream by the shader of its name. On the calling thread.
#define EASYPBR_RUN(name) void run(const void* uniforms, const name##_stream& stream, int count);
EASYPBR_STREAMS(EASYPBR_RUN)
#undef EASYPBR_RUN

/// Lines that are drawn alike, and count once in a pixel.
struct Stroke {
    Inputs inputs;
    std::vector<ScreenLine> lines;
};

/// Draws strokes by overlay_lines over a region, which holds rows up to y1: by their depths, in their order
/// where these agree; with DEPTH_ONLY, which all have or none, nothing but the nearest depth. On all cores.
/// Throws Error when a value is not of the uniform's type, Interrupted.
void draw_lines(std::span<const Stroke> strokes, const Region& region, int y1);

/// Blends splats into a tile, from the nearest on. On the calling thread.
void blend_splats(const SplatPixels& tile, std::span<const ScreenSplat> splats,
                  std::span<const uint32_t> places);

/// Projects the vertices of a cluster; see ProjectCluster. On the calling thread.
bool project_cluster(const ClusterFaces& faces, ClusterScreen& screen);

/// Finds which faces of a projected cluster may cover the centre of a pixel; see SetUpCluster. On the calling
/// thread.
int set_up_cluster(const ClusterFaces& faces, ClusterScreen& screen);

/// Projects the points of a batch and finds which are inside of what is drawn. On the calling thread.
int set_up_points(const PointBatch& points, PointScreen& screen);

/// Projects the ellipses of a batch and finds which are seen, as project_ellipse(). On the calling thread.
int set_up_ellipses(const EllipseBatch& ellipses, EllipseScreen& screen);

/// Places in equirectangular maps and directions, as FindMapPlaces and FindMapDirections. On the calling
/// thread.
void find_map_places(const float (&rotation)[3][3], const float* const (&directions)[3], int count, float* u,
                     float* v);
void find_map_directions(const float (&rotation)[3][3], const float* u, const float* cosines,
                         const float* sines, int count, float* const (&directions)[3]);

/// Adds a frame's pixels to those of a tile, as AddNoisyRow. On the calling thread.
bool add_noisy_row(const NoisyRow& row, int y, NoisyTile& tile, BesideNoisy& beside);

/// The places that pixels show and their surfaces, as FindPlaces. On the calling thread.
void find_places(const CameraRays& rays, const PixelSurfaces& pixels, int count, const CameraPlaces& places);

/// The points of a dimension of paths, as SamplePaths. On the calling thread.
void sample_paths(const uint32_t* seeds, const uint32_t* reversed_samples, uint32_t dimension, int count,
                  float* xs, float* ys);

/// Points of few emitters, as SampleEmitters, and what the chances of points are, as ChancesOfEmitters. On
/// the calling thread.
void sample_emitters(const FewEmitters& emitters, const EmitterPlaces& places, int count,
                     const EmitterPoints& points);
void chances_of_emitters(const FewEmitters& emitters, const float* const (&from)[3], const int32_t* chosen,
                         int count, float* chances);

/// Shades rows [y0, y1) of a region, on all cores. Throws Error when a value is not of the uniform's type,
/// Interrupted.
void shade(Shader shader, const Inputs& inputs, const Region& region, int y0, int y1);

}  // namespace easypbr::native
