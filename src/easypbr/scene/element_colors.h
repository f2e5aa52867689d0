// What colours an object: the one place where Style::color_by becomes colours.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "easypbr/core/color.h"
#include "easypbr/scene/scene.h"

namespace easypbr {

enum class ColorSource {
    material,     ///< the material's colour, with its textures and the vertex colours as ColorPlan says
    colors,       ///< a colour for each element
    values,       ///< a value for each vertex: to be interpolated before it is mapped to a colour
    coordinates,  ///< the texture coordinates: to be interpolated before they repeat and become colours
};

/// What colours an object, decided. Cheap to make: what is of the size of the data comes with
/// element_colors().
struct ColorPlan {
    ColorBy by = ColorBy::solid;
    ColorSource source = ColorSource::material;
    bool textured = true;                     ///< the material's base colour texture counts
    bool vertex_colors = true;                ///< MeshData::C counts
    DrawMode mode = DrawMode::mesh;           ///< what they colour
    PerElement element = PerElement::vertex;  ///< what has the colours or values
    /// The colours are those of a table and mean something: labels, scalars, heights, intensities. Where they
    /// are not lit they reach the picture exactly.
    bool exact = false;

    std::string scalar;  ///< name of the scalars
    Colormap colormap;
    ColorScale scale = ColorScale::linear;
    int steps = 0;                  ///< bands; 0: continuous
    std::optional<float> min, max;  ///< true values; nothing: from the values
    Vec3 nan_color{0.5f, 0.5f, 0.5f};
    /// Its product with (x, y, z, 1) of a vertex is the height above `base`.
    Eigen::Vector4d height = Eigen::Vector4d::Zero();
    /// Of heights on a linear scale: that of the scene's origin, in the coordinates that meshes were given;
    /// else 0. plan_values() and the range are relative to it (see ValueRange).
    double base = 0;
    Mat3d normal_to_world = Mat3d::Identity();

    /// Equal keys, equal element_colors(): revisions of the arrays, choices, and the pose where it counts.
    /// Empty for ColorSource::material.
    std::string key;
};

/// Decides by the overrides, else the object's own style, else its data: labels, else textures and vertex
/// colours, else scalars, else the intensities of what is drawn without faces, else the material. A style
/// that names scalars chooses them. `T_world_mesh` and the world's `up` count for heights and normals,
/// `origin` (SceneSnapshot::origin) for heights, which are those in the coordinates that meshes were given.
///
/// Overrides stand for all objects: where the data lack what they ask for, the object's own style decides
/// (see require_colors()). Throws ArgumentError where the data lack what the object's own style asks for,
/// NameError when they have no scalars of that name.
ColorPlan plan_colors(const MeshData& mesh, const Style& overrides, DrawMode mode,
                      const Eigen::Affine3d& T_world_mesh, const Vec3d& up,
                      const Vec3d& origin = Vec3d::Zero());

/// Throws ArgumentError or NameError when overrides ask for labels, scalars or others that no object has.
void require_colors(const SceneSnapshot& scene, const Style& overrides);

/// One of these by ColorPlan::source; for `material` and `coordinates` all are empty.
struct ElementColors {
    std::vector<Rgba8> colors;  ///< sRGB, one for each vertex or face
    Array1f values;             ///< one for each vertex; NaN: no value
    /// Of `values`, and of the colours made from values (for colour bars). A value has the colour
    /// table[color_index(value, range)], NaN has nan_color.
    ValueRange range;
    std::array<Rgba8, 256> table{};
    Rgba8 nan_color{};
};

/// Parallel, and the same for any number of threads. Labels of vertices on faces: see face_label(), so
/// that no colour is a mixture. Values of faces where vertices are drawn: a vertex has the mean of its faces'
/// values, the label of its first face.
ElementColors element_colors(const MeshData& mesh, const ColorPlan& plan);

/// The label of a face of a mesh with labels: its own, else that of most of its corners, the first one's when
/// all differ. What pictures, ground truth and picks say alike.
int32_t face_label(const MeshData& mesh, Eigen::Index face);

/// A label for each vertex of a mesh with labels: those of faces as element_colors() hands them on.
Array1i vertex_labels(const MeshData& mesh);

/// The values that a plan maps to colours (scalars, heights or intensities), one for each element of the
/// array they come from, relative to the plan's base. NaN for those that have no place on the plan's scale.
Array1f plan_values(const MeshData& mesh, const ColorPlan& plan);

/// The range and the colours of such values.
ValueRange plan_range(const Array1f& values, const ColorPlan& plan);
std::array<Rgba8, 256> plan_table(const ColorPlan& plan);

}  // namespace easypbr
