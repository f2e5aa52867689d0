// 3D Gaussians as the fields of a table, as the reference implementation of Kerbl et al. 2023 writes them:
// f_dc_0 to 2 and f_rest_0 to 44 (spherical harmonics, the latter channel by channel), opacity before the
// sigmoid, logarithms of scale_0 to 2, and the quaternion rot_0 to 3 (w, x, y, z). Of 2D Gaussians (Huang et
// al., "2D Gaussian Splatting", 2024) there is no scale_2: they are flat.
#pragma once

#include <vector>

#include "easypbr/io/tables/vertex_arrays.h"
#include "easypbr/io/tables/vertex_rows.h"

namespace easypbr::io {

class SplatColumns {
  public:
    SplatColumns() = default;
    /// Sets the columns of the fields, if they are those of splats; else it stays empty. Throws FormatError
    /// where some of them are missing.
    SplatColumns(const Source& source, const std::vector<VertexField>& fields, size_t count);

    bool empty() const { return scales_.size() == 0; }
    /// What was read, as MeshData has it; leaves nothing here. Throws FormatError for what is not finite or
    /// no rotation.
    SplatArrays finish(const Source& source);

  private:
    Array3f::Dense scales_;
    Array4f::Dense rotations_;
    Array1f::Dense opacities_;
    ArrayXf::Dense sh_;
    bool is_flat_ = false;
};

/// The same for writing: all but the positions.
std::vector<RowPart> splat_row_parts(const SplatArrays& splats);

/// The spherical harmonic of degree 0 that gives an sRGB-encoded value.
float constant_of_color(float encoded);

/// Where the k-th harmonic after the first of a channel stands among the columns of SplatArrays::sh.
Eigen::Index harmonic_column(size_t k, size_t channel);

/// Scenes are trained on the cameras of COLMAP, whose y axis points down; files do not say.
inline const Vec3d splat_up(0, -1, 0);

}  // namespace easypbr::io
