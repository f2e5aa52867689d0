#include "easypbr/render/primitives/splat_color.h"

#include "easypbr/scene/splat_basis.h"

namespace easypbr::render {

Vec3 splat_color(const float* sh, int degree, const Vec3& direction) {
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

Vec3 splat_color(const DrawItem& item, Eigen::Index splat, const Vec3& direction) {
    const MeshData& mesh = item.mesh();
    if (item.with_colors) return mesh.C.row(splat).head<3>().transpose();
    const Mat3 to_mesh = item.object->T_world_mesh.linear().inverse().cast<float>();
    return splat_color(mesh.splats.sh.data() + splat * mesh.splats.sh.cols(), mesh.splats.degree(),
                       Vec3((to_mesh * direction).normalized()));
}

}  // namespace easypbr::render
