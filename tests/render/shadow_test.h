// Scenes and measures for tests of shadows.
#pragma once

#include <cmath>

#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr {

inline Material matt() {
    Material m;
    m.base_color = Vec3::Constant(0.5f);
    m.roughness = 1;
    return m;
}

/// A rectangle from (x0, y0) to (x1, y1) at height z that faces +z.
inline Mesh rectangle(float x0, float y0, float x1, float y1, float z, const Material& material = matt()) {
    Mesh mesh = facing_square(1, material);
    Array3f::Dense V(4, 3);
    V << x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z;
    mesh.set_V(Array3f(V));
    return mesh;
}

inline app::Session shadow_session(const Scene& scene, ShadowMode mode, int size = 64) {
    app::Session session = plain_session(scene, size);
    session.settings().shadows.mode = mode;
    session.settings().camera.up = "+z";
    return session;
}

/// The part of the light that reaches each pixel: the picture with shadows over the one without; -1 where
/// there is no light to lose.
struct LitParts {
    Image parts;
    Image depth;
    Camera camera;

    float at(int x, int y) const { return parts.at<float>(x, y)[0]; }
    /// World position that a pixel sees.
    Vec3d position(int x, int y) const {
        const int w = depth.width(), h = depth.height();
        const Mat4d clip = camera.projection_matrix(double(w) / h);
        const double z = depth.at<float>(x, y)[0], ndc_x = (x + 0.5) / w * 2 - 1,
                     ndc_y = 1 - (y + 0.5) / h * 2;
        const bool orthographic = camera.projection == Projection::orthographic;
        const double scale = orthographic ? 1 : z;
        return camera.T_world_cam * Vec3d(ndc_x / clip(0, 0) * scale, ndc_y / clip(1, 1) * scale, -z);
    }
};

inline LitParts lit_parts(app::Session& session, int samples = 1) {
    session.settings().shadows.enabled = false;
    const Image without = render_linear(session, samples);
    session.settings().shadows.enabled = true;
    const Image with = render_linear(session, samples);
    LitParts result{Image(with.width(), with.height(), 1, PixelType::f32),
                    session.render_layers({"depth"}).at("depth"), session.camera()};
    for (size_t i = 0; i < with.pixel_count(); ++i) {
        const float full = without.pixels<float>()[4 * i + 1], lit = with.pixels<float>()[4 * i + 1];
        result.parts.pixels<float>()[i] = full > 0 && result.depth.pixels<float>()[i] > 0 ? lit / full : -1;
    }
    return result;
}

inline Light directional(const Vec3& direction, float angular_radius_deg = 0) {
    Light light;
    light.type = LightType::directional;
    light.direction = direction;
    light.angular_radius_deg = angular_radius_deg;
    return light;
}

inline Light point(const Vec3& position, float radius = 0) {
    Light light;
    light.position = position.cast<double>();
    light.radius = radius;
    light.intensity = position.squaredNorm();
    return light;
}

}  // namespace easypbr
