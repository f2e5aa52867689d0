// Native shaders as the instruction sets export them. Plain data only.
#pragma once

#include <cstddef>

#include "easypbr/native/ellipse_projection.h"
#include "easypbr/native/views.h"
#include "native/shader_list.h"

namespace easypbr::native {

// Arrays of the shaders that shade one element after the other, by the names of what they read and write. Of
// vectors each component is an array.
#include "native/shader_streams.h"

/// What all arrays of streams have room for is a multiple of this many elements.
inline constexpr int stream_alignment = 16;

/// What becomes of a pixel.
enum class Store {
    replace,
    add_light,  ///< colours are added, alpha stays
    add,        ///< all channels are added
    multiply,   ///< all channels are multiplied
    under,      ///< what the pixel holds is premultiplied, and lies over what is written
    over,       ///< what is written is premultiplied, and lies over what the pixel holds
    mix         ///< between what is written and, by Region::kept, what the pixel holds
};
/// Of a format with 8 or 16 bits a channel values are rounded; only floats can be blended.
enum class Pixels { rgba8, rgba16, rgba16f, rgba32f, rg8, rg16, r16, r16f, r32f };
/// The pixels that are shaded.
enum class Where {
    everywhere,
    covered,  ///< where `depth` is not 0; with Store::replace other pixels and discarded ones become 0
    empty     ///< where it is 0
};

/// Pixels of one output of a shader, row by row.
struct Output {
    std::byte* data = nullptr;  ///< null: this output is not written
    Pixels pixels = Pixels::rgba32f;
};
inline constexpr int most_outputs = 4;

/// Pixels that are written, and which of them.
struct Region {
    Output outputs[most_outputs];  ///< by the location of the shader's outputs; all hold the same rectangle
    int x = 0, y = 0, width = 0;   ///< first pixel that they hold, and of how many columns
    Store store = Store::replace;
    float kept = 0;  ///< for Store::mix
    Where where = Where::everywhere;
    R32f depth = {};
    int depth_channels = 1;  ///< of the pixels of `depth`, which is the first
    int x0 = 0, x1 = 0;      ///< columns that are shaded
};

/// Shades rows [y0, y1) of a region; `uniforms` are those of the shader.
using ShadeRows = void (*)(const void* uniforms, const Region& region, int y0, int y1);

/// Values of the corners that a shader interpolates; null where it reads none.
struct TriangleAttributes {
    const float* uvs = nullptr;          ///< of vertices, u v
    const float* colors = nullptr;       ///< of vertices, linear r g b a
    const int16_t* tangents = nullptr;   ///< of corners, x y z w of 1/32767
    float tangent_from_mesh[3][3] = {};  ///< to world space
};

/// Triangles whose nearest one is known for each pixel, and the targets that their surfaces are written to.
struct VisibleTriangles {
    const float *V = nullptr, *N = nullptr;  ///< vertices and their normals, x y z
    const int32_t* F = nullptr;              ///< three indices a face
    uint32_t first_face = 0;                 ///< faces of pixels count from here
    double clip_from_mesh[4][4] = {};
    float normal_from_mesh[3][3] = {};         ///< to world space
    bool flat = false;                         ///< normals of faces in place of N
    bool two_sided = false;                    ///< normals are on the side that is seen
    bool normals_agree = false;                ///< the winding tells the side of N
    bool mirrored = false;                     ///< front faces are clockwise
    double pixel_width = 0, pixel_height = 0;  ///< in normalised device coordinates
    uint64_t albedo = 0;                       ///< of all pixels, in the formats of the targets
    uint32_t material = 0, id = 0;
    /// Uniforms of mesh_resolve, or of casters those of shadow_depth; null: albedo and material are
    /// constants.
    const void* shader = nullptr;
    bool extended = false;          ///< uniforms of mesh_extended instead
    TriangleAttributes attributes;  ///< for the shader

    int x = 0, y = 0, width = 0;  ///< first pixel that the targets hold, and of how many columns
    uint64_t* albedos = nullptr;
    uint32_t *normals = nullptr, *materials = nullptr, *ids = nullptr, *elements = nullptr;
    float* depths = nullptr;       ///< ids and elements: null where they are not asked for
    float* emission = nullptr;     ///< r g b a; null where nothing emits
    uint32_t* extensions[2] = {};  ///< four values a pixel; null where they are not asked for
};

/// A pixel that a primitive, as a triangle, was found in.
struct VisiblePixel {
    int32_t x = 0, y = 0;
    uint32_t face = 0;
    float depth = 0;  ///< of the visibility buffer
};

/// Writes the surfaces of pixels.
using ResolveTriangles = void (*)(const VisibleTriangles& triangles, const VisiblePixel* pixels, int count);
/// The opacity of pixels by the triangles' shader.
using AlphaOfTriangles = void (*)(const VisibleTriangles& triangles, const VisiblePixel* pixels, int count,
                                  float* alpha);

/// What casters absorb of light, r g b, and their opacity, by the triangles' shader.
using CastersOfTriangles = void (*)(const VisibleTriangles& triangles, const VisiblePixel* texels, int count,
                                    float* values);

/// A place on a face or another element of a mesh that a ray has met.
struct ElementHit {
    uint32_t element = 0;  ///< face or vertex
    float u = 0, v = 0;    ///< weights of a face's second and third corner
    float normal[3] = {};  ///< unit, of the element itself, towards where the ray comes from; world space
    float footprint = 0;   ///< width of the part of the surface that the ray stands for, world units
};

/// What glTF's material extensions add to surfaces that rays have met, as shaders/path_extended.glsl names
/// it; an array for each component.
struct HitExtensions {
    float *dielectric[4] = {}, *coat[4] = {}, *sheen[4] = {}, *film[4] = {}, *tangent[4] = {};
    float *volume[3] = {}, *absorption[3] = {};
};

/// Surfaces that rays have met; an array for each component.
struct HitSurfaces {
    float* normal[3] = {};  ///< world, interpolated and mapped, on the side that the ray comes from
    float* face[3] = {};    ///< world, of the element itself, likewise
    float* albedo[3] = {};
    float* parameters[2] = {};  ///< metallic, roughness
    float* emission[3] = {};    ///< radiance
    float* kind = nullptr;      ///< code of the surface's
    HitExtensions extensions;   ///< of surfaces that have them
};

/// Evaluates the triangles' shader where rays have met them.
using ShadeHits = void (*)(const VisibleTriangles& triangles, const ElementHit* hits, int count,
                           const HitSurfaces& surfaces);
/// Shades elements [0, count) of a stream and at most stream_alignment - 1 more.
using ShadeStream = void (*)(const void* uniforms, const void* stream, int count);

/// Shaders of streams: those of cmake/native.cmake.
enum class Stream {
#define EASYPBR_NAME(name) name,
    EASYPBR_STREAMS(EASYPBR_NAME)
#undef EASYPBR_NAME
};

/// A line segment on the screen, in pixels; row 0 is the top.
struct ScreenLine {
    float start[2] = {}, along[2] = {1, 0};  ///< unit direction
    float length = 0;
    float depths[2] = {};                          ///< reversed, of its ends
    float start_color[4] = {}, end_color[4] = {};  ///< linear r g b a, of the whole segment's ends
    float parts[2] = {0, 1};                       ///< of the whole segment, at the ends of what is drawn
    float ws[2] = {1, 1};                          ///< of the clip space there
    float places[2] = {};                          ///< of values in their table, as start_color
    float row = 0;                                 ///< of the table
    /// Where dashes are at the start, in pixels from the first of them, and their direction along the line.
    float dash[2] = {0, 1};
};

/// Lines that are drawn alike, and count once in a pixel: `chosen` of them, in this order.
struct LineStroke {
    const void* uniforms = nullptr;  ///< of overlay_lines
    const ScreenLine* lines = nullptr;
    const uint32_t* chosen = nullptr;
    int count = 0;
};

/// Arrays of a number for each pixel that DrawLines works in: of the stroke that is drawn and of those before
/// it, the colour, the depth and, of the first, the rank.
inline constexpr int line_arrays = 11;

/// Draws strokes by overlay_lines over rows [y0, y1) of a region, one over the other by their depths. `work`
/// has room for line_arrays of y1 - y0 rows of x1 - x0 + stream_alignment numbers. With is_depth_only, which
/// all strokes have or none, the region is of r32f, and keeps the nearest depth.
using DrawLines = void (*)(const LineStroke* strokes, int count, const Region& region, int y0, int y1,
                           float* work);

/// Nothing that is less opaque is drawn of Gaussian splats (Kerbl et al. 2023).
inline constexpr float least_splat_alpha = 1.0f / 255;
/// No splat hides what is behind it altogether.
inline constexpr float most_splat_alpha = 0.99f;
/// Where less light than this comes through, nothing behind is seen (Kerbl et al. 2023).
inline constexpr float least_splat_transmittance = 1e-4f;

/// Standard deviations from where a splat is densest along a ray, beyond which there is nothing of it:
/// 1/4000.
inline constexpr float splat_reach = 3.5f;
/// Surfaces of smaller reversed depths are as far away as these.
inline constexpr float least_splat_limit = 1e-30f;
/// To first order a large splat reaches behind the camera or beyond all: its depth is at least this part of
/// the mean's.
inline constexpr float farthest_splat_part = 0.1f;
/// The same for the part of first order of a depth that is exact.
inline constexpr float farthest_straight_part = 1e-3f;
/// With so many standard deviations along the ray between camera and mean the depth to first order changes
/// what a limit cuts off by less than a code: 2 p / 100 deviations where the opacity is exp(-p).
inline constexpr float flat_splat_deviations = 100;

/// A Gaussian splat on the screen. Its opacity at a pixel's centre p is
/// opacity * exp(-(xx dx^2 + 2 xy dx dy + yy dy^2) / 2), d = p - centre, and what is seen of it there is
/// where it is densest along the pixel's ray. To first order that is at s = depth + depth_x dx + depth_y dy
/// (Zwicker et al. 2002), as it is in an orthographic view. In a perspective one it is at s + 2 p /
/// (sharpness^2 s), -p being the power above: of the ray o + t d and the inverse covariance P about the mean
/// m, 1 / t is (d P d) / (d P m), s the part of it that is linear in the pixel, and p / sharpness^2 what is
/// left of the square. The standard deviation along the ray grows by the root of the quotient of both. A
/// cache line.
struct alignas(64) ScreenSplat {
    float x, y;                     ///< centre, in pixels of the frame
    float xx, xy, yy;               ///< inverse of the covariance, per square pixel
    float opacity;                  ///< at the centre
    float red, green, blue;         ///< sRGB-encoded, 0 or more
    float depth;                    ///< of its mean, reversed
    float depth_x, depth_y;         ///< change of the depth, per pixel
    float half_width, half_height;  ///< of the box, in pixels, outside of which it is not seen
    /// Inverse of the standard deviation of its density along a pixel's ray, per unit of depth, at the mean.
    float sharpness;
    uint32_t index;  ///< of the vertex
};

/// The pixels of a tile of the screen that splats are blended into, row by row.
struct SplatPixels {
    static constexpr int size = 16;

    int left = 0, top = 0;                                    ///< first pixel
    float *red = nullptr, *green = nullptr, *blue = nullptr;  ///< sRGB-encoded, premultiplied
    float* through = nullptr;  ///< the part of the light from behind that still comes through
    /// Splats are seen from `farthest` to before `nearest`, reversed depths or infinite; null: all are.
    const float *farthest = nullptr, *nearest = nullptr;
    /// Of a splat that a limit passes through the part on its side is seen; else all or nothing, by the depth
    /// where it is densest along the pixel's ray.
    bool is_soft = false;
    uint32_t* median =
        nullptr;  ///< place of the splat behind which less than half of the light comes through
    /// Sum of the splats' z in view space, weighed by what each adds to the pixel; null: it is not asked for.
    float* positions = nullptr;
    float axis[4] = {};  ///< of reversed depths: (axis[0] z + axis[1]) / (axis[2] z + axis[3])
};

/// Blends splats, of which `places` are those of the tile from the nearest on, behind what it holds, until
/// nothing comes through.
using BlendSplats = void (*)(const SplatPixels& tile, const ScreenSplat* splats, const uint32_t* places,
                             size_t count);

/// Faces that share vertices, on their way to the screen.
struct ClusterFaces {
    static constexpr int most_vertices = 255, most_faces = 256;
    static constexpr int subpixel_bits = 8, half_pixel = 1 << (subpixel_bits - 1);
    /// Pixels beyond which vertices are not drawn without being clipped.
    static constexpr float guard_band = 1 << 15;

    const float* vertices = nullptr;   ///< all x, all y, all z
    const uint8_t* corners = nullptr;  ///< vertices of faces: all first corners, all second, all third
    int vertex_count = 0, face_count = 0;
    float clip_from_mesh[4][4] = {};               ///< [column][row]
    float half_width = 0, half_height = 0;         ///< of the picture, pixels
    int left = 0, top = 0, right = 0, bottom = 0;  ///< first and last pixel that is drawn
    bool both_sides = false, mirrored = false;     ///< see render::ScreenTriangles
};

/// Its vertices on the screen, and which faces may cover the centre of a pixel.
struct ClusterScreen {
    /// Lanes beyond the last vertex or face are written, and lanes read what any byte names.
    static constexpr int room = 272;

    alignas(64) int32_t x[room], y[room];  ///< 1/256 of a pixel, y downwards
    alignas(64) float depth[room];         ///< reversed
    alignas(64) int32_t packed[room];
    int32_t left, top, right, bottom;  ///< what the vertices cover, 1/256 of a pixel
    float nearest;                     ///< the largest of the depths
    uint8_t kept[room];                ///< faces, in their order
};

/// Points that are neighbours, on their way to the screen: see render::PointSplats.
struct PointBatch {
    static constexpr int most_points = 256;

    const float* points = nullptr;  ///< all x, all y, all z
    int count = 0;
    float clip_from_mesh[4][4] = {};                 ///< [column][row]
    float half_width = 0, half_height = 0;           ///< of the picture, pixels
    float left = 0, top = 0, right = 0, bottom = 0;  ///< of what is drawn
    float pixels = 1, world_pixels = 0, least_pixels = 1, y_per_x = 1;
    bool round = true;
    /// Pixels of what is drawn, row by row, whose upper halves are the bits of the depth that is seen there:
    /// others may draw meanwhile, but depths only rise. Null: nothing is left out for them.
    const uint64_t* seen = nullptr;
};

/// The points on the screen. Lanes beyond the last are written.
struct PointScreen {
    static constexpr int room = PointBatch::most_points + 16;

    alignas(64) float x[room], y[room], radius[room], depth[room];
    /// Of splats that are as high as wide and less than 2 pixels: a bit for each of the pixels (column,
    /// line), (column + 1, line) and the two below that they cover and are not hidden in. Of others all bits.
    alignas(64) int32_t column[room], line[room], covered[room];
    uint16_t kept[room];  ///< those inside of what is drawn that may be seen, in their order
};

/// Ellipses in space that are neighbours, on their way to the screen.
struct EllipseBatch {
    static constexpr int most_ellipses = 256;
    static constexpr int components = 12;

    const float* vectors = nullptr;  ///< all x of EllipseVectors::p, all y, ... all z of n
    int count = 0;
    const EllipseView* view = nullptr;
};

/// The ellipses on the screen. Lanes beyond the last are written.
struct EllipseScreen {
    static constexpr int room = EllipseBatch::most_ellipses + 16;

    alignas(64) float ellipses[ProjectedEllipse<float>::members][room];  ///< in the order of all()
    uint16_t kept[room];  ///< those that are seen, in their order
};

/// Random numbers of `count` paths and at most stream_alignment - 1 more, in [0, 1): a point of a dimension
/// for each (native/sample_points.h).
using SamplePaths = void (*)(const uint32_t* seeds, const uint32_t* reversed_samples, uint32_t dimension,
                             int count, float* xs, float* ys);

/// The rays of a camera's pixels, in the frame of the places that they end at. Pixels share all but their
/// column and row.
struct CameraRays {
    bool orthographic = false;
    double near = 1, far = 2;
    /// Width of a pixel, in perspective at a distance of 1 along the axis.
    double width = 0;
    /// The way to the pixel in column 0 and row 0 and on to the next ones, in perspective at that distance.
    double first[3] = {}, column[3] = {}, row[3] = {};
    double back[3] = {}, eye[3] = {};  ///< back: the axis, towards the viewer
    float towards[3] = {};             ///< of orthographic cameras: unit, towards the viewer
};

/// What the G-buffer holds at pixels: an array for each number, with room for a multiple of stream_alignment.
struct PixelSurfaces {
    const int32_t *x = nullptr, *y = nullptr;
    const float* depth = nullptr;                           ///< above 0
    const uint32_t *normal = nullptr, *material = nullptr;  ///< as in the targets
    const uint32_t *red_green = nullptr, *blue = nullptr;   ///< albedo; 16 bits each
};

/// What is there: an array for each component.
struct CameraPlaces {
    float *position[3] = {}, *view[3] = {}, *normal[3] = {};  ///< view: unit, towards the viewer
    float* footprint = nullptr;                               ///< width of the pixel there
    float *albedo[3] = {}, *parameters[2] = {};               ///< parameters: metallic, roughness
};

using FindPlaces = void (*)(const CameraRays& rays, const PixelSurfaces& pixels, int count,
                            const CameraPlaces& places);

/// Places in an equirectangular map, 0 to 1 each, of unit directions that `rotation` ([column][row]) turns
/// into the map's. Arrays of a multiple of stream_alignment.
using FindMapPlaces = void (*)(const float (&rotation)[3][3], const float* const (&directions)[3], int count,
                               float* u, float* v);
/// The inverse, turned by `rotation`: of u, and of the cosine and sine of the angle from straight up.
using FindMapDirections = void (*)(const float (&rotation)[3][3], const float* u, const float* cosines,
                                   const float* sines, int count, float* const (&directions)[3]);

/// Noisy light of a square of a picture, with an array for each number, row by row: sums and means over the
/// frames in which a pixel has some. Steps of 1 / 65535 are finer than denoisers tell apart.
struct NoisyTile {
    static constexpr int side = 16, pixels = side * side;
    static constexpr int hue_rows = 8;  ///< of a column, which have one sum of the hue's squares

    /// Of a pixel's sum of the hue's squares, by its place among the pixels.
    static constexpr int hue_place(int place) { return place / (hue_rows * side) * side + place % side; }

    float light[3][pixels] = {};                ///< sum of the radiance, or of the coverage in each channel
    float squares[pixels] = {};                 ///< sum, of the luminance
    float hue_squares[pixels / hue_rows] = {};  ///< sum, of red and of blue
    float alpha[pixels] = {};                   ///< sum, by what overlays leave; 0 where coverage is noisy
    float depth[pixels] = {};                   ///< mean of its log2, of orthographic pictures of itself
    uint32_t frames[pixels] = {};               ///< that have noisy light
    uint16_t normal[3][pixels] = {};            ///< mean world normal, half of 65535 for 0
    uint16_t reflectance[3][pixels] = {};       ///< mean, linear, 65535 for 1
    uint8_t noisy[pixels] = {};                 ///< what is: 0 nothing, 1 radiance, 2 coverage
};
static_assert(2 * sizeof(NoisyTile) == 83 * NoisyTile::pixels, "there is one for each pixel");

/// A frame's pixels of a row of a tile.
struct NoisyRow {
    static constexpr int pixels = NoisyTile::side;

    const float* sample = nullptr;                          ///< r g b a
    const uint32_t *normal = nullptr, *material = nullptr;  ///< as in the targets
    const uint64_t* albedo = nullptr;                       ///< likewise
    const float *depth = nullptr, *open = nullptr;          ///< open: what overlays leave; null: all
    int end_of_lit = 0, catcher = 0;  ///< codes of surfaces: light falls on those below the first
    bool orthographic = false;
    bool over_nothing = false;  ///< of shadow catchers the coverage is noisy
    bool layered = false;       ///< alpha of the albedo is the surfaces' part of the coverage
};

/// What is not noisy of a row, and of which pixels light was taken, as NoisyTile::noisy.
struct BesideNoisy {
    float radiance[4][NoisyRow::pixels];
    int32_t taken[NoisyRow::pixels];
};

/// Adds row y of a tile. Whether BesideNoisy::radiance has anything.
using AddNoisyRow = bool (*)(const NoisyRow& row, int y, NoisyTile& tile, BesideNoisy& beside);

/// Emissive triangles, so few that each place weighs them all: an array for each number, in the frame of the
/// places.
struct FewEmitters {
    static constexpr int room = 64;

    int count = 0;
    float centre[3][room] = {}, normal[3][room] = {};
    /// Of the closed mesh that it belongs to, outside of which back faces are not seen.
    float least[3][room] = {}, most[3][room] = {};
    float area[room] = {}, light[room] = {};  ///< light: relative to the others
    float corner[3][room] = {}, edge1[3][room] = {}, edge2[3][room] = {};
};

/// Places that look for light, and points of the unit square. Arrays of a multiple of stream_alignment.
struct EmitterPlaces {
    const float *from[3] = {}, *u = nullptr, *v = nullptr;
};

/// What becomes of them. `density` is per steradian, 0 where no emitter is seen.
struct EmitterPoints {
    int32_t* chosen = nullptr;
    float *u = nullptr, *v = nullptr;  ///< barycentric: weights of the second and third corner
    float* direction[3] = {};          ///< unit
    float *distance = nullptr, *cosine = nullptr, *density = nullptr;  ///< cosine: negative on the back
};

/// A point of an emitter for each place.
using SampleEmitters = void (*)(const FewEmitters& emitters, const EmitterPlaces& places, int count,
                                const EmitterPoints& points);
/// The chance per area that SampleEmitters chooses a point of an emitter, which each place names.
using ChancesOfEmitters = void (*)(const FewEmitters& emitters, const float* const (&from)[3],
                                   const int32_t* chosen, int count, float* chances);

/// The number of points that are kept.
using SetUpPoints = int (*)(const PointBatch& points, PointScreen& screen);
/// The number of ellipses that are kept.
using SetUpEllipses = int (*)(const EllipseBatch& ellipses, EllipseScreen& screen);

/// Finds all but the faces that are kept; false where a vertex would have to be clipped.
using ProjectCluster = bool (*)(const ClusterFaces& faces, ClusterScreen& screen);
/// Of a cluster that is projected: the number of faces that are kept; negative where it is 128 pixels large.
using SetUpCluster = int (*)(const ClusterFaces& faces, ClusterScreen& screen);

/// Shaders of pictures: those of cmake/native.cmake.
enum class Shader {
#define EASYPBR_NAME(name) name,
    EASYPBR_SHADERS(EASYPBR_NAME)
#undef EASYPBR_NAME
};

#define EASYPBR_ONE(name) +1
inline constexpr int shader_count = EASYPBR_SHADERS(EASYPBR_ONE);
inline constexpr int stream_count = EASYPBR_STREAMS(EASYPBR_ONE);
#undef EASYPBR_ONE

struct Kernels {
    ResolveTriangles resolve_triangles;
    AlphaOfTriangles alpha_of_triangles;
    CastersOfTriangles casters_of_triangles;
    ShadeHits shade_hits;
    DrawLines draw_lines;
    BlendSplats blend_splats;
    ProjectCluster project_cluster;
    SetUpCluster set_up_cluster;
    SetUpPoints set_up_points;
    SetUpEllipses set_up_ellipses;
    AddNoisyRow add_noisy_row;
    FindMapPlaces find_map_places;
    FindMapDirections find_map_directions;
    FindPlaces find_places;
    SamplePaths sample_paths;
    SampleEmitters sample_emitters;
    ChancesOfEmitters chances_of_emitters;
    ShadeRows shade[shader_count];     ///< by Shader
    ShadeStream stream[stream_count];  ///< by Stream
};

}  // namespace easypbr::native
