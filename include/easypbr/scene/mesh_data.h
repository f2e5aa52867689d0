// MeshData: the plain data of a mesh. The handle to them, which programs edit, is Mesh (scene/mesh.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/array.h"
#include "easypbr/scene/label_map.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/style.h"

namespace easypbr {

class Mesh;

/// A range of faces with one material.
struct MeshPart {
    std::string name;
    int first_face = 0;
    int face_count = 0;
    int material = 0;  ///< index into MeshData::materials
};

/// Named values, one for each vertex or one for each face: curvature, temperature, error. NaN: no value.
struct ScalarArray {
    std::string name;  ///< not empty, unique within a mesh
    Array1f values;  ///< n x 1 or m x 1; with as many faces as vertices they belong to the vertices; without
                     ///< rows there are none
    bool from_file = false;  ///< came with a file or data set: colours the mesh only when asked for
};

/// What makes n vertices the means of 3D Gaussians (Kerbl et al., "3D Gaussian Splatting for Real-Time
/// Radiance Field Rendering", 2023): all four arrays, or none.
struct SplatArrays {
    Array3f scales;     ///< n x 3 standard deviations along the Gaussian's own axes, 0 or more
    Array4f rotations;  ///< n x 4 quaternions w, x, y, z of those axes, of any length above 0
    Array1f opacities;  ///< n x 1 opacity at the mean, 0 to 1
    /// n x 3 (degree + 1)^2 spherical harmonics, degree 0 to 3: red, green, blue of the first, then those of
    /// the second, ... The colour is 0.5 + their sum, sRGB-encoded, by the direction from camera to mean in
    /// the mesh's frame; the signs are those of the reference implementation.
    ArrayXf sh;

    bool empty() const { return scales.empty(); }
    /// Of the spherical harmonics.
    int degree() const { return sh.cols() <= 3 ? 0 : sh.cols() <= 12 ? 1 : sh.cols() <= 27 ? 2 : 3; }
};

/// Handles to meshes: a vector, made and destroyed out of line, so that MeshData can be used where only the
/// name of Mesh is known. To look into it, include scene/mesh.h.
class MeshList : public std::vector<Mesh> {
  public:
    MeshList();
    MeshList(std::vector<Mesh> meshes);
    MeshList(std::initializer_list<Mesh> meshes);
    MeshList(const MeshList& other);
    MeshList(MeshList&& other) noexcept;
    MeshList& operator=(const MeshList& other);
    MeshList& operator=(MeshList&& other) noexcept;
    ~MeshList();
};

/// The positions that tell which edges of a mesh are sharp that follows joints or morph targets: its edges do
/// not turn sharp and smooth as it moves.
struct RestShape {
    Array3f V;                ///< n x 3 positions, or empty
    uint64_t F_revision = 0;  ///< of the faces that they are for: with others they count nothing
};

/// The plain data of a mesh: n vertices, m faces, k edges. Copying is cheap (arrays are shared).
struct MeshData {
    std::string name;
    std::filesystem::path source;  ///< the file it was read from, absolute; empty for a mesh made in memory

    /// n x 3 positions, local: offset + V are the coordinates that the mesh was given. Doubles become floats
    /// here: far from zero Mesh(V, F), Mesh::set_V() and set_positions() keep what matters of them.
    Array3f V;
    Array3f N;   ///< n x 3 unit normals, or empty: computed when it is drawn
    ArrayXf C;   ///< n x 3 or n x 4 colours, sRGB-encoded, 0 .. 1 (alpha last), or empty
    Array2f UV;  ///< n x 2 texture coordinates, v upwards, or empty
    /// n x 4 tangents of normal maps and anisotropy: unit direction along u, sign of the bitangent
    /// (sign cross(n, t)); sign 0: computed at this vertex. Empty: all are computed when the mesh is drawn.
    /// An edit of V, N, UV or F drops them.
    Array4f uv_tangents;
    Array3f T;  ///< n x 3 tangent vectors (surfels), or empty
    Array1f B;  ///< n x 1 bitangent lengths (surfels), or empty
    Array3i F;  ///< m x 3 vertex indices of triangles, counter-clockwise seen from outside
    Array2i E;  ///< k x 2 vertex indices of line segments
    Array1i L;  ///< n x 1 or m x 1 labels; with as many faces as vertices those of the vertices
    Array1f I;  ///< n x 1 intensities
    /// Of 3D Gaussians whose means are V, or empty.
    SplatArrays splats;
    std::vector<ScalarArray> scalars;           ///< any number of named values
    std::shared_ptr<const LabelMap> label_map;  ///< what the labels mean; none: generated colours
    /// What was subtracted from positions far from zero, so that float32 holds them. Meshes
    /// of one scene are placed by it: the scene's own frame has an origin (Scene::origin), and a vertex
    /// stands at T_world_mesh * (V + offset - origin).
    Vec3d offset{0, 0, 0};
    /// Direction that points up by the convention of the file's format, in the frame of V; zero: it has none.
    Vec3d up{0, 0, 0};
    /// Direction from the points of a depth image back to its camera, in the frame of V; zero: they are none.
    Vec3d front{0, 0, 0};
    float voxel_size = 0;  ///< edge of the cubes that V are the centres of; 0: V are no voxels

    /// n x 1 index, from 0 on, of the file's vertex that each vertex came from; empty: the same.
    Array1i source_vertex;
    /// m x 1 index, from 0 on, of the file's polygon that each triangle came from; empty: the same.
    Array1i source_face;
    RestShape rest_shape;

    std::vector<Material> materials;  ///< at least one as soon as the mesh is drawn; a default one is added
    std::vector<MeshPart> parts;      ///< cover F without overlap; empty: all faces have material 0

    Style style;
    Eigen::Affine3d T_parent_mesh = Eigen::Affine3d::Identity();
    MeshList children;
};

/// What the rows of labels or scalars belong to.
enum class PerElement { vertex, face };
/// Vertices when there are as many rows as vertices, else faces.
inline PerElement element_of(const MeshData& data, Eigen::Index rows) {
    return rows == data.V.rows() ? PerElement::vertex : PerElement::face;
}

/// The scalars of that name. Throws NameError with the nearest name.
const ScalarArray& scalar_named(const MeshData& data, const std::string& name);

/// Throws ArgumentError that names the array, the expected and the given shape, when arrays do not fit
/// together, when a face or edge index is out of range, when a source is below 0, when parts do not cover
/// the faces or overlap, when a position, offset, direction, pose or voxel size is not finite, when the last
/// row of the pose is not 0 0 0 1, when a label is not in the label map (see LabelMap::accepts), when a
/// material or the style has a value outside of its range, or when the image of a texture is empty.
void validate(const MeshData& data);
/// The same, without reading arrays again that `data` shares with data known to be valid.
void validate(const MeshData& data, const MeshData& valid);

}  // namespace easypbr
