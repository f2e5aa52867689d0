// From an object's data and styles to how it is drawn, with nothing left to infer but what needs the camera.
#pragma once

#include <optional>

#include "easypbr/scene/scene.h"

namespace easypbr {

/// A style with every choice made. See Style for the fields.
struct DrawStyle {
    DrawMode mode = DrawMode::mesh;
    bool visible = true;
    std::optional<float> point_size;  ///< nothing: from the spacing of the points
    SizeUnit point_size_unit = SizeUnit::pixels;
    PointShape point_shape = PointShape::round;
    float surfel_scale = 1;
    bool splat_antialias = false;
    std::optional<float> voxel_size;  ///< nothing: from the spacing of the points
    float line_width = 1.5f;
    float line_dash = 0;
    std::optional<Vec3> line_color;  ///< sRGB; nothing: what suits the kind of line
    bool show_wireframe = false;
    bool show_normals = false;
    std::optional<float> normal_length;  ///< nothing: from the object's size
    bool show_points = false;
    std::optional<bool> two_sided;  ///< nothing: the material's choice
    bool flat = false;
    std::optional<bool> lit;  ///< nothing: by what is drawn, see render/draw_list.h
    bool overlay = false;
};

/// What the data are drawn as when nobody says: voxels where they have a voxel size, splats where they have
/// those, faces as a mesh, normals with tangents as surfels, edges as lines, vertices alone as points.
DrawMode natural_mode(const MeshData& mesh);

/// Whether vertices are drawn as elliptic discs in the planes of their normals: surfels.
bool draws_discs(DrawMode mode);

/// The overrides' choice, else the object's own, else what follows from the data.
DrawStyle resolve_style(const MeshData& mesh, const Style& overrides);

/// The kind of primitive that a mesh is drawn as in a style: voxels are meshes, surfels without normals
/// points, and so are vertices that are to be splats and have none.
DrawMode primitive_of(const MeshData& mesh, const DrawStyle& style);

/// Sets how far what is drawn of an object reaches beyond its vertices.
void set_reach(SceneSnapshot::Object& object, const Style& overrides);

/// Whether overrides may change that.
bool changes_reach(const Style& overrides);

}  // namespace easypbr
