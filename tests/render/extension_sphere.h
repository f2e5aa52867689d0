// A sphere of a material with extensions, in an environment or under a light, and what its pixels should
// show.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr::sphere {

inline constexpr int size = 96;

inline Material with(const std::function<void(Material&)>& change) {
    Material m;
    m.base_color = Vec3::Ones();
    m.roughness = 0.4f;
    change(m);
    return m;
}

/// A pixel on the unit sphere, in the frame of its normal (z) and of the circle of latitude through it (x).
struct Point {
    Vec3 radiance;
    Vec3d normal, view;  ///< world
    Mat3d frame;         ///< columns: tangent, bitangent, normal

    Vec3d local(const Vec3d& world) const { return frame.transpose() * world; }
    double n_dot_v() const { return normal.dot(view); }
};

/// Pixels of a picture of the unit sphere, not at its outline, where a pixel's centre may lie on a facet's
/// back.
inline std::vector<Point> points_of(const Image& image, const Camera& camera, double least_n_dot_v) {
    std::vector<Point> points;
    const Mat4d p = camera.projection_matrix(1);
    for (int y = 0; y < size; y += 3)
        for (int x = 0; x < size; x += 3) {
            const double nx = (x + 0.5) / size * 2 - 1, ny = 1 - (y + 0.5) / size * 2;
            const Vec3d ray =
                (camera.T_world_cam.linear() * Vec3d(nx / p(0, 0), ny / p(1, 1), -1)).normalized();
            const Vec3d eye = camera.position();
            const double b = eye.dot(ray), c = b * b - eye.squaredNorm() + 1;
            if (c < 0) continue;
            const Vec3d n = eye + ray * (-b - std::sqrt(c));
            if (-ray.dot(n) < least_n_dot_v) continue;
            Point point{Vec3(image.at<float>(x, y)), n, -ray, Mat3d()};
            // Texture coordinates of the sphere run around +y: their tangent is the direction of growing u.
            const Vec3d tangent = Vec3d::UnitY().cross(n).normalized();
            point.frame << tangent, n.cross(tangent), n;
            points.push_back(point);
        }
    return points;
}

inline app::Session session_of(const Material& material, Scene& scene) {
    Mesh sphere = make_sphere(1, 256);
    sphere.set_material(material);
    scene.show(sphere, "sphere");
    app::Session session = plain_session(scene, size);
    look_from(session, Vec3d(0.5, 0.8, 4), 30);
    return session;
}

/// The sphere in an environment of radiance 1.
inline std::vector<Point> in_furnace(const Material& material, double least_n_dot_v = 0.2) {
    Scene scene;
    scene.set_environment(constant_environment(1));
    app::Session session = session_of(material, scene);
    session.settings().environment.enabled = true;
    const Image image = render_linear(session);
    return points_of(image, session.camera(), least_n_dot_v);
}

inline const Vec3d light_direction = Vec3d(0.3, 0.7, 0.6).normalized();  // towards the light

/// The sphere under one directional light of 1 lux.
inline std::vector<Point> under_light(const Material& material, double least_n_dot_v = 0.25) {
    Scene scene;
    Light sun;
    sun.type = LightType::directional;
    sun.direction = -light_direction.cast<float>();
    scene.set_light("sun", sun);
    app::Session session = session_of(material, scene);
    session.settings().shading.multiple_scattering = false;
    const Image image = render_linear(session);
    std::vector<Point> lit;
    for (const Point& point : points_of(image, session.camera(), least_n_dot_v))
        if (point.normal.dot(light_direction) > 0.05) lit.push_back(point);
    return lit;
}

}  // namespace easypbr::sphere
