// A session with exact conditions: no environment, no studio lights, exposure 1, no tone curve.
#pragma once

#include <gtest/gtest.h>

#include "easypbr/app/session.h"
#include "easypbr/geometry/primitives.h"
#include "easypbr/scene/settings.h"

namespace easypbr {

inline app::Session plain_session(const Scene& scene, int size = 64) {
    app::Session session(scene);
    Settings& s = session.settings();
    s.image.size = Vec2i(size, size);
    s.image.samples = 1;
    s.image.antialias = Antialias::none;
    s.environment.enabled = false;
    s.environment.sun = false;
    s.shadows.enabled = false;
    s.ssao.enabled = false;
    for (StudioLight* light : {&s.lights.key, &s.lights.fill, &s.lights.rim}) light->enabled = false;
    s.tonemap.tone_operator = ToneOperator::none;
    s.tonemap.exposure = 1.0f;
    s.background.mode = BackgroundMode::transparent;
    return session;
}

inline Image render_linear(app::Session& session, int samples = 1) {
    return session.render({std::nullopt, samples, app::Encoding::scene_linear});
}

/// An environment of constant radiance.
inline Environment constant_environment(float radiance) {
    Image image(16, 8, 3, PixelType::f32);
    for (float& v : image.pixels<float>()) v = radiance;
    return Environment(image);
}

/// A square of the given half width in the plane z = 0 that faces +z.
inline Mesh facing_square(float half = 1, const Material& material = {}) {
    Array3f::Dense V(4, 3);
    V << -half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0;
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    Array2f::Dense UV(4, 2);
    UV << 0, 0, 1, 0, 1, 1, 0, 1;
    Mesh mesh{Array3f(V), Array3i(F)};
    mesh.set_UV(Array2f(UV));
    mesh.set_material(material);
    return mesh;
}

/// A line from a to b.
inline Mesh segment(const Vec3& a, const Vec3& b) {
    Array3f::Dense V(2, 3);
    V << a.transpose(), b.transpose();
    Array2i::Dense E(1, 2);
    E << 0, 1;
    MeshData data;
    data.V = Array3f(V);
    data.E = Array2i(E);
    return Mesh(data);
}

inline void look_from(app::Session& session, const Vec3d& position, float fov_y_deg = 30) {
    session.settings().camera.position = position;
    session.settings().camera.target = Vec3d(0, 0, 0);
    session.settings().camera.fov_y_deg = fov_y_deg;
}

}  // namespace easypbr
