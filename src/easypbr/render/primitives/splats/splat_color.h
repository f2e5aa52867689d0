// The colour of a splat from a direction: real spherical harmonics up to degree 3.
#pragma once

#include "easypbr/core/math.h"
#include "easypbr/render/drawables/draw_list.h"
#include "easypbr/scene/splat_basis.h"

namespace easypbr::render {

/// sRGB-encoded, 0 or more. `sh` holds (degree + 1)^2 times red, green, blue (see SplatArrays::sh);
/// `direction` is a unit vector from the camera to the splat in the frame of the splats. Basis and signs are
/// those of Kerbl et al. 2023.
inline Vec3 splat_color(const float* sh, int degree, const Vec3& direction) {
    float basis[16];
    spherical_harmonics(direction, degree, basis);
    const int count = (degree + 1) * (degree + 1);
    float red = 0.5f, green = 0.5f, blue = 0.5f;
    for (int k = 0; k < count; ++k, sh += 3) {
        red += basis[k] * sh[0];
        green += basis[k] * sh[1];
        blue += basis[k] * sh[2];
    }
    return Vec3(red, green, blue).cwiseMax(0.0f);
}

/// The colour of a splat of an item, sRGB-encoded, to a ray of this unit direction in the world.
inline Vec3 splat_color(const DrawItem& item, Eigen::Index splat, const Vec3& direction) {
    const MeshData& mesh = item.mesh();
    if (item.with_colors) return mesh.C.row(splat).head<3>().transpose();
    const Mat3 to_mesh = item.object->T_world_mesh.linear().inverse().cast<float>();
    return splat_color(mesh.splats.sh.data() + splat * mesh.splats.sh.cols(), mesh.splats.degree(),
                       Vec3((to_mesh * direction).normalized()));
}

}  // namespace easypbr::render
