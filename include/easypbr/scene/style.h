// Style: how an object is drawn.
#pragma once

#include <string>
#include <string_view>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/colormap.h"

namespace easypbr {

enum class DrawMode { mesh, points, surfels, lines, voxels, splats };
enum class PointShape { round, square };
enum class SizeUnit { pixels, world };
enum class ColorBy { solid, vertex, texture, label, scalar, height, normal, uv, intensity };

/// How an object is drawn. An automatic field follows from the data.
/// The same struct in the settings overrides the style of every object. Colours are sRGB-encoded.
struct Style {
    /// Automatic: voxels where the data have a voxel size, splats where they have those, faces as a mesh,
    /// normals with tangents as surfels, edges as lines, vertices alone as points.
    Override<DrawMode> mode;
    Override<bool> visible;      ///< automatic: yes
    Override<float> point_size;  ///< diameter in point_size_unit, above 0; automatic: by their spacing
    Override<SizeUnit> point_size_unit;  ///< automatic: pixels
    Override<PointShape> point_shape;    ///< automatic: round
    Override<float> surfel_scale;        ///< scale factor of the size of surfels, above 0; automatic: 1
    Override<bool> splat_antialias;      ///< splats keep their light where they are small; automatic: no
    Override<float> voxel_size;  ///< edge length, mesh units, above 0; automatic: the data's, or the spacing
    Override<float> line_width;  ///< pixels, 0.1 to 1000; automatic: 1.5
    Override<float> line_dash;  ///< length of dashes and gaps in pixels, 0 to 10000; 0, also automatic: solid
    Override<Vec3> line_color;  ///< automatic: colours of the data or the material of lines, else dark; dark
                                ///< for wireframes, blue for normals
    Override<bool> show_wireframe;  ///< edges of the faces; automatic: no
    Override<bool> show_normals;    ///< a line along each vertex normal; automatic: no
    Override<float> normal_length;  ///< world units, above 0; automatic: 2 % of the object's diagonal
    Override<bool> show_points;     ///< the vertices as points too; automatic: no
    Override<bool> two_sided;       ///< no back-face culling; automatic: the material's double_sided
    Override<bool> flat;            ///< one normal per face; automatic: no
    Override<bool> lit;             ///< automatic: yes, but for points that are labelled or have no normals
    Override<bool> overlay;      ///< drawn over all others, without a depth test against them; automatic: no
    Override<ColorBy> color_by;  ///< automatic: labels, textures, scalars, intensities or the material
    Override<std::string> scalar;  ///< name of the scalar field that colours; automatic: the first one
    Override<Colormap> colormap;   ///< automatic: grey for intensities, else viridis
    Override<float> color_min;  ///< value of the first colour; automatic: the minimum or the 1st percentile
    Override<float> color_max;  ///< value of the last colour; automatic: the maximum or the 99th percentile
    Override<ColorScale> color_scale;  ///< automatic: linear
    Override<int> color_steps;         ///< bands of one colour each, 0 to 256; 0, also automatic: continuous
    Override<Vec3> nan_color;  ///< of missing values; automatic: grey, or magenta with the colour map grey

    bool operator==(const Style&) const = default;
};

/// Throws ArgumentError that names the field and its range, when a value is outside of it. `owner` stands
/// before the field's name: "mesh 'robot': ".
void validate(const Style& style, std::string_view owner);

}  // namespace easypbr
