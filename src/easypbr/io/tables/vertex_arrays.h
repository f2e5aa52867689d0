// The arrays of a file's vertices or points, and which property of the file goes into which.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "easypbr/io/tables/element_table.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

/// A scalar property of a file's vertices and where its values will go.
struct VertexField {
    Property property;
    Column* column;
};

/// Colours while they are read: a field for each part, or all parts packed into one of four bytes, "rgb" or
/// "rgba", as PCL and ROS have them.
class ColorArrays {
  public:
    ColorArrays() = default;
    /// Makes room for `count` rows and sets the fields' columns.
    ColorArrays(const std::vector<VertexField>& fields, size_t count);

    /// Colours in 0 .. 1, without rows where there are none. Leaves none here.
    ArrayXf::Dense take();

  private:
    ArrayXf::Dense C_;
    std::vector<int> ranged_;     ///< columns whose values tell their range; the types of others do
    std::vector<uint32_t> bits_;  ///< of packed colours
    Eigen::Index packed_parts_ = 0;
};

/// Recognises fields by their names, whatever the case: positions, normals, colours, texture coordinates,
/// labels, intensities, tangents and bitangent lengths; every other field becomes scalars of its name ("_",
/// "" and packed colours beside others are skipped). "scalar_" before a name, as CloudCompare writes it, is
/// left out.
class VertexArrays {
  public:
    /// Makes room for `count` rows and sets the fields' columns.
    VertexArrays(const std::vector<VertexField>& fields, size_t count);
    VertexArrays() = default;

    /// Which of the fields are x, y, z; nothing without all three.
    const std::optional<std::array<size_t, 3>>& position() const { return position_; }

    /// Lets the position columns subtract what offset_of_samples() finds.
    void recentre(std::vector<Vec3d> samples);

    /// The same after reading, for positions that float32 holds as the file has them.
    void recentre_positions();

    /// Throws FormatError when a position is not finite.
    void check(const Source& source) const { check_positions(source, V_); }
    Eigen::Index count() const { return V_.rows(); }

    /// Fills the mesh, with attributes in the ranges that MeshData promises: colours of other types than
    /// uint8 and uint16 may be 0 .. 1, 0 .. 255 or 0 .. 65535. Leaves nothing here.
    /// Warns where float32 takes what tells the values of scalars or intensities apart.
    void move_into(MeshData& mesh, const Source& source);

  private:
    struct Scalar {
        std::string name;
        Property property;
        Array1f::Dense values;
        std::unique_ptr<Rounding> rounding;  ///< null where float32 has all values of the type
    };

    void plan_scalars(const std::vector<VertexField>& fields, size_t count);

    std::optional<std::array<size_t, 3>> position_;
    std::array<Column*, 3> position_columns_{};
    Vec3d offset_ = Vec3d::Zero();
    ColorArrays colors_;
    Array3f::Dense V_, N_, T_;
    Array2f::Dense UV_;
    Array1i::Dense L_;
    Array1f::Dense I_, B_;
    std::unique_ptr<Rounding> intensity_rounding_;  ///< as Scalar::rounding
    std::vector<Scalar> scalars_;
};

/// Warns that values of a file's faces are left out, such as "the labels", and says why.
void warn_of_left_out_values(const Source& source, std::string_view values, std::string_view why);

/// The same of scalars that have the name of others.
void warn_of_taken_name(const Source& source, const std::string& name);

/// Colours, labels and scalars of a file's faces.
class FaceArrays {
  public:
    FaceArrays() = default;
    /// Makes room for what no column is there for yet: colours, labels, and scalars of any other name but
    /// those of normals.
    explicit FaceArrays(ElementPlan& plan);

    /// The colours of the polygons, 0 .. 1, without rows where they have none. Leaves none here.
    ArrayXf::Dense take_colors() { return colors_.take(); }

    /// Gives each triangle the values of its polygon; those that the vertices have too are left out, with a
    /// warning. Where they would pass for values of the vertices, a vertex is added
    /// (tell_faces_from_vertices).
    void move_into(MeshData& mesh, const Source& source);

    /// Warns of labels and scalars, which are left out.
    void leave_out(const Source& source, std::string_view why) const;

  private:
    struct Scalar {
        std::string name;
        Array1f::Dense values;
        std::unique_ptr<Rounding> rounding;  ///< null where float32 has all values of the type
    };

    ColorArrays colors_;
    Array1i::Dense L_;
    std::vector<Scalar> scalars_;
};

/// Whether a field of this name is recognised, not just kept as scalars.
bool is_known_field(std::string_view name);

/// Whether it is one of those of positions.
bool is_position_field(std::string_view name);

/// What scalars of this name are called in a file: with '_' before it where something else would be seen in
/// it.
std::string scalar_field_name(const std::string& name);
/// The name of the scalars of a field; without that '_', and without "scalar_".
std::string scalar_name(const std::string& field);

/// Names for a field of several values: those of the parts of a position, normal, colour or texture
/// coordinate when it is called so and has as many, else NAME_0, NAME_1, ...
std::vector<std::string> names_of_parts(const std::string& name, size_t count);

/// Leaves out the points of a cloud (a mesh without faces and edges) whose positions are not finite, with a
/// warning that counts them; source_vertex leads back to the file's points. Throws FormatError when none is
/// left.
void drop_points_without_position(const Source& source, MeshData& mesh);

}  // namespace easypbr::io
