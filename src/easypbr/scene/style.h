// Style: how an object is drawn.
#pragma once

#include <string>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/colormap.h"

namespace easypbr {

enum class DrawMode { mesh, points, surfels, lines, voxels };
enum class PointShape { round, square };
enum class SizeUnit { pixels, world };
enum class ColorBy { solid, vertex, texture, label, scalar, height, normal, uv, intensity };

/// How an object is drawn. An automatic field follows from the data (resolve_style() in scene/draw_style.h).
/// The same struct in the settings overrides the style of every object. Colours are sRGB-encoded.
struct Style {
    Auto<DrawMode> mode;     ///< automatic: natural_mode() in scene/draw_style.h
    Auto<bool> visible;      ///< automatic: yes
    Auto<float> point_size;  ///< diameter in point_size_unit, above 0; automatic: the mean point spacing
    Auto<SizeUnit> point_size_unit;  ///< automatic: pixels
    Auto<PointShape> point_shape;    ///< automatic: round
    Auto<float> surfel_scale;        ///< scale factor of the size of surfels, above 0; automatic: 1
    Auto<float> voxel_size;  ///< edge length, world units, above 0; automatic: the data's, or the spacing
    Auto<float> line_width;  ///< pixels, 0.1 to 1000; automatic: 1.5
    Auto<float> line_dash;   ///< length of dashes and gaps in pixels, 0 to 10000; 0, also automatic: solid
    Auto<Vec3> line_color;   ///< automatic: vertex colours for lines, dark for wireframes, blue for normals
    Auto<bool> show_wireframe;  ///< edges of the faces; automatic: no
    Auto<bool> show_normals;    ///< a line along each vertex normal; automatic: no
    Auto<float> normal_length;  ///< world units, above 0; automatic: 2 % of the object's diagonal
    Auto<bool> show_points;     ///< the vertices as points too; automatic: no
    Auto<bool> two_sided;       ///< no back-face culling; automatic: the material's double_sided
    Auto<bool> flat;            ///< one normal per face; automatic: no
    Auto<bool> lit;             ///< automatic: yes, but for points that are labelled or have no normals
    Auto<bool> overlay;         ///< drawn over all others, without a depth test against them; automatic: no
    Auto<ColorBy> color_by;     ///< automatic: labels, textures, scalars, intensities or the material
    Auto<std::string> scalar;  ///< name of the scalar field that colours; automatic: the first that was added
    Auto<Colormap> colormap;   ///< automatic: grey for intensities, else viridis
    Auto<float> color_min;     ///< value of the first colour; automatic: the minimum or the 1st percentile
    Auto<float> color_max;     ///< value of the last colour; automatic: the maximum or the 99th percentile
    Auto<Vec3> nan_color;      ///< of missing values; automatic: grey, or magenta with the colour map grey
};

}  // namespace easypbr
