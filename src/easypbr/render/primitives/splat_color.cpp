#include "easypbr/render/primitives/splats/splat_color.h"

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

}  // namespace easypbr::render
