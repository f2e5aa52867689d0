// Splats while a reader fills them, row by row, from a format that packs them.
#pragma once

#include "easypbr/io/source/source.h"
#include "easypbr/scene/mesh_data.h"

namespace easypbr::io {

struct SplatRows {
    /// Charges for the memory. Throws FormatError for none, or more than 2^31 - 1.
    SplatRows(const Source& source, size_t count, int degree);

    size_t count() const { return size_t(V.rows()); }
    /// Sets the colour that all directions see, sRGB-encoded.
    void set_color(Eigen::Index row, const Vec3& encoded);

    /// The mesh; leaves nothing here. Throws FormatError for values that are not finite, a scale below 0, and
    /// a rotation of length 0.
    MeshData finish(const Source& source, const Vec3d& up);

    Array3f::Dense V, scales;
    Array4f::Dense rotations;  ///< w, x, y, z
    Array1f::Dense opacities;
    ArrayXf::Dense sh;
};

/// Sets the three columns of a quaternion other than `largest`, and that one so that its length is 1: how
/// formats store rotations in three numbers.
void complete_rotation(Array4f::Dense& rotations, Eigen::Index row, Eigen::Index largest, const Vec3& others);

}  // namespace easypbr::io
