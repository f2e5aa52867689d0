// Things of glass, and rays through them.
#pragma once

#include <cmath>
#include <functional>

#include "easypbr/scene/settings.h"
#include "render_test.h"

namespace easypbr::transmission_test {

inline Material glass(const std::function<void(Material&)>& change = {}) {
    Material m;
    m.base_color = Vec3::Ones();
    m.roughness = 0;
    m.transmission = 1;
    if (change) change(m);
    return m;
}

inline Material glowing(const Vec3& color) {
    Material m;
    m.base_color = color;
    m.unlit = true;
    return m;
}

inline Mesh moved(Mesh mesh, const Vec3d& by) {
    mesh.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(by)));
    return mesh;
}

inline Mesh ball(const Material& material) {
    Mesh sphere = make_sphere(1, 256);
    sphere.set_material(material);
    return sphere;
}

inline constexpr int size = 96;

struct Ray {
    Vec3d origin, direction;
};

inline Ray ray_of(const Camera& camera, int x, int y) {
    const Mat4d p = camera.projection_matrix(1);
    const double nx = (x + 0.5) / size * 2 - 1, ny = 1 - (y + 0.5) / size * 2;
    const Vec3d view = Vec3d(nx / p(0, 0), ny / p(1, 1), -1).normalized();
    return {camera.position(), camera.T_world_cam.linear() * view};
}

inline app::Session session_of(Scene& scene, const Vec3d& from = Vec3d(0.5, 0.8, 4)) {
    app::Session session = plain_session(scene, size);
    look_from(session, from, 30);
    return session;
}

/// Snell; the direction and the normal on its side.
inline Vec3d refracted(const Vec3d& d, const Vec3d& n, double eta) {
    const double c = -d.dot(n), k = 1 - eta * eta * (1 - c * c);
    return eta * d + (eta * c - std::sqrt(k)) * n;
}

}  // namespace easypbr::transmission_test
