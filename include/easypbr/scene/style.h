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

/// How an object is drawn. A field that is automatic follows from the data (see resolve_style() in
/// scene/draw_style.h). The same struct in the settings overrides every object's own. Unit, range and
/// documentation of each field stand in the one table, scene/fields_table.cpp.
struct Style {
    Auto<DrawMode> mode;
    Auto<bool> visible;
    Auto<float> point_size;  ///< diameter, in point_size_unit
    Auto<SizeUnit> point_size_unit;
    Auto<PointShape> point_shape;
    Auto<float> surfel_scale;
    Auto<float> voxel_size;  ///< edge of a cube, world units
    Auto<float> line_width;  ///< pixels
    Auto<float> line_dash;   ///< pixels, 0: solid
    Auto<Vec3> line_color;   ///< sRGB
    Auto<bool> show_wireframe;
    Auto<bool> show_normals;
    Auto<float> normal_length;  ///< world units
    Auto<bool> show_points;
    Auto<bool> two_sided;
    Auto<bool> flat;
    Auto<bool> lit;
    Auto<bool> overlay;
    Auto<ColorBy> color_by;
    Auto<std::string> scalar;  ///< name of the scalars that colour
    Auto<Colormap> colormap;
    Auto<float> color_min;  ///< value of the colormap's first colour
    Auto<float> color_max;  ///< value of its last one
    Auto<Vec3> nan_color;   ///< sRGB
};

}  // namespace easypbr
