// Mesh: a handle to matrices (vertices, faces, attributes), materials, a style, a pose and children.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/label_map.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/mesh_data.h"
#include "easypbr/scene/style.h"

namespace easypbr {

/// Deepest hierarchy of children that is followed.
inline constexpr int max_mesh_depth = 250;
/// Throws ArgumentError beyond max_mesh_depth: a mesh is its own descendant.
void require_mesh_depth(int depth);

/// A shared object: copying or moving a handle shares it, clone() copies it. All members may be called from
/// any thread.
class Mesh {
  public:
    /// An empty mesh.
    Mesh();

    /// Reads a file (see io/mesh/mesh_io.h for formats and errors).
    explicit Mesh(const std::filesystem::path& path);
    explicit Mesh(const char* path);

    /// Vertices (n x 3) and triangles (m x 3). Throws ArgumentError as validate() does.
    Mesh(Array3f V, Array3i F);
    /// The same of vertices in double precision, or of integers: far from zero they are recentred as
    /// set_positions() does.
    template <class Derived>
    requires(!std::is_same_v<typename Derived::Scalar, float>)
        Mesh(const Eigen::DenseBase<Derived>& V, Array3i F)
        : Mesh(recentred(Array3d(V.derived()), F)) {}

    explicit Mesh(MeshData data);

    // Moving copies: a handle always has its object.
    Mesh(const Mesh& other) = default;
    Mesh& operator=(const Mesh& other) = default;

    /// The data as they are now; never changes afterwards.
    std::shared_ptr<const MeshData> snapshot() const;

    /// Changes a copy of the data and puts it in place, whole or (when `change` throws or the result is not
    /// valid) not at all. Readers that hold a snapshot keep theirs. No lock is held meanwhile: `change` may
    /// read this mesh, and is called again with newer data when another thread's edit came first. Throws
    /// ArgumentError when `change` edits this mesh itself: it changes the data that it is given.
    void edit(const std::function<void(MeshData&)>& change);

    Array3f V() const;
    Array3f N() const;
    ArrayXf C() const;
    Array2f UV() const;
    Array3f T() const;
    Array1f B() const;
    Array3i F() const;
    Array2i E() const;
    Array1i L() const;
    Array1f I() const;

    /// Local positions; the offset stays.
    void set_V(Array3f V);
    /// Those of another type than float, as set_positions() takes them: local, so that what is subtracted is
    /// added to the offset that the mesh has. Where V are whole coordinates again, call
    /// set_offset({0, 0, 0}) first.
    template <class Derived>
    requires(!std::is_same_v<typename Derived::Scalar, float>) void set_V(
        const Eigen::DenseBase<Derived>& V) {
        set_positions(Array3d(V.derived()));
    }
    /// Local positions in double precision. Where float32 would lose what matters they are recentred:
    /// what is subtracted from them is added to the offset, so that offset + V does not move.
    void set_positions(
        const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>& positions);
    /// The same of a matrix with a dynamic number of columns. Throws ArgumentError unless there are 3.
    template <class Derived>
    requires(Derived::ColsAtCompileTime ==
             Eigen::Dynamic) void set_positions(const Eigen::DenseBase<Derived>& positions) {
        set_positions(Array3d(positions.derived()));
    }
    Vec3d offset() const;
    void set_offset(const Vec3d& offset);
    void set_N(Array3f N);
    /// sRGB-encoded colours, n x 3 or n x 4 (alpha last), 0 to 1: codes of 8 bits must be divided by 255.
    /// Numbers outside of it and NaN are not refused, and what they look like is undefined.
    void set_C(ArrayXf C);
    void set_UV(Array2f UV);
    void set_F(Array3i F);

    void set_L(Array1i L);
    /// Both at once, when the labels are of another map than before.
    void set_labels(Array1i L, std::shared_ptr<const LabelMap> label_map);
    std::shared_ptr<const LabelMap> label_map() const;
    void set_label_map(std::shared_ptr<const LabelMap> label_map);
    void set_label_map(LabelMap label_map);

    /// The scalars of that name. Throws NameError with the nearest name.
    Array1f scalar(const std::string& name) const;
    /// Adds scalars, or replaces those of the same name.
    void add_scalar(const std::string& name, Array1f values);
    /// The same from any Eigen expression of doubles, which become floats: a warning says where that takes
    /// what tells them apart, as time stamps and IDs.
    template <class Derived>
    requires std::is_same_v<typename Derived::Scalar, double>
    void add_scalar(const std::string& name, const Eigen::DenseBase<Derived>& values) {
        add_doubles(name, Array1d(values));
    }
    /// As add_scalar(), all of them or none.
    void add_scalars(const std::vector<ScalarArray>& scalars);
    /// Throws NameError with the nearest name.
    void remove_scalar(const std::string& name);

    std::string name() const;

    /// Material `index`; the default material when the mesh has none. Throws NameError when out of range.
    Material material(int index = 0) const;
    /// Replaces material `index`, or adds it when it is the next free one. Throws NameError beyond that.
    void set_material(const Material& material, int index = 0);

    Style style() const;
    void set_style(const Style& style);

    Eigen::Affine3d T_parent_mesh() const;
    /// Throws ArgumentError when T is not finite or its last row is not 0 0 0 1.
    void set_T_parent_mesh(const Eigen::Affine3d& T);

    /// Pose in the world: those of all parents, applied to T_parent_mesh.
    Eigen::Affine3d T_world_mesh() const;
    /// Chooses T_parent_mesh so that the pose in the world is T. Throws ArgumentError when T is not finite,
    /// its last row is not 0 0 0 1 or a parent's pose cannot be inverted.
    void set_T_world_mesh(const Eigen::Affine3d& T);

    // Steps of motion, in the parent's frame, which is the world for a mesh without a parent; children move
    // along. They throw ArgumentError for what is not finite and for an axis without length. Computed in
    // double; a rotation stays one to the last bits, however many steps are made.

    /// Moves by `step`.
    void translate(const Vec3d& step);
    /// Turns about the mesh's own origin, counter-clockwise seen against the axis.
    void rotate_axis_angle(const Vec3d& axis, double angle_deg);
    /// Turns about the line through `center` along the axis: the mesh goes around it and turns with it.
    void orbit(const Vec3d& axis, const Vec3d& center, double angle_deg);
    /// Scales along the mesh's own axes about its own origin. Throws ArgumentError for a factor that is 0.
    void scale(const Vec3d& factors);
    void scale(double factor);

    /// Adds a child, whose pose becomes relative to this mesh. With `keep_world_pose` its T_parent_mesh
    /// changes so that its world pose is kept. Does nothing if it is a child already.
    /// Throws ArgumentError when it is this mesh or contains it, or is the child of another mesh.
    void add_child(const Mesh& child, bool keep_world_pose = false);
    /// Removes a child; with `keep_world_pose` its world pose is kept. Throws ArgumentError if it is no child
    /// of this mesh.
    void remove_child(const Mesh& child, bool keep_world_pose = false);
    std::vector<Mesh> children() const;
    /// The parent mesh. Of several, which only copies of MeshData give, the first.
    std::optional<Mesh> parent() const;

    /// A deep copy, children included; arrays are shared until one of the two is assigned others.
    Mesh clone() const;

    /// Writes the format of the extension, one of io::writable_extensions() (io/mesh/mesh_io.h). Throws
    /// FileError, FormatError.
    void save(const std::filesystem::path& path) const;

    /// The same object (not: equal data).
    bool operator==(const Mesh& other) const { return shared_ == other.shared_; }
    /// Equal for handles to the same object, and different from those of all others, also of those that are
    /// gone. Never 0.
    uint64_t identity() const;

  private:
    struct Shared;
    static MeshData recentred(const Array3d& V, const Array3i& F);
    void add_doubles(const std::string& name, const Array1d& values);
    explicit Mesh(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

    /// Puts `next` in place if the data are still the `expected` ones. Throws ArgumentError when a child of
    /// it contains this mesh.
    bool replace(const std::shared_ptr<const MeshData>& expected, std::shared_ptr<const MeshData> next);
    bool exchange(const std::shared_ptr<const MeshData>& expected, std::shared_ptr<const MeshData> next);
    /// Makes this mesh known to its children as their parent. The hierarchies' mutex must be held.
    void adopt(const std::vector<Mesh>& children) const;
    void disown(const std::vector<Mesh>& children) const;
    /// Whether this mesh is among its own descendants, or would be as a parent of `children`.
    bool is_below(const std::vector<Mesh>& children, int depth = 0) const;

    std::shared_ptr<Shared> shared_;
};

/// Calls visit(data, T_world_mesh) for the mesh and all its descendants, parents first. The poses are those
/// of V + offset.
void for_each_node(
    const Mesh& root,
    const std::function<void(const std::shared_ptr<const MeshData>&, const Eigen::Affine3d&)>& visit);

}  // namespace easypbr
