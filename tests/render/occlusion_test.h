// Sessions and measures for tests of ambient occlusion.
#pragma once

#include <cmath>
#include <functional>

#include "gpu_rounding.h"
#include "ray_caster.h"
#include "render_test.h"

#include "easypbr/scene/settings.h"

namespace easypbr {

inline constexpr float far_beyond_the_scene = 1e4f;

/// What a session draws and what it is compared with, per pixel.
struct Occlusion {
    Image visibility, depth, normal;
    Camera camera;
    Mat4d view_from_clip;

    explicit Occlusion(app::Session& session) {
        auto layers = session.render_layers({"ambient_occlusion", "depth", "normal_world"});
        visibility = std::move(layers["ambient_occlusion"]);
        depth = std::move(layers["depth"]);
        normal = std::move(layers["normal_world"]);
        camera = session.camera();
        view_from_clip = camera.projection_matrix(double(depth.width()) / depth.height()).inverse();
    }

    bool covered(int x, int y) const { return depth.at<float>(x, y)[0] > 0; }
    float at(int x, int y) const { return visibility.at<float>(x, y)[0]; }
    Vec3 normal_at(int x, int y) const { return Vec3(Eigen::Map<const Vec3>(normal.at<float>(x, y))); }

    Vec3d world(int x, int y) const {
        const double z = depth.at<float>(x, y)[0];
        const Mat4d P = view_from_clip.inverse();
        const double ndc_x = (x + 0.5) / depth.width() * 2 - 1, ndc_y = 1 - (y + 0.5) / depth.height() * 2;
        const bool flat = camera.projection == Projection::orthographic;
        const Vec3d view(flat ? (ndc_x - P(0, 3)) / P(0, 0) : (ndc_x + P(0, 2)) / P(0, 0) * z,
                         flat ? (ndc_y - P(1, 3)) / P(1, 1) : (ndc_y + P(1, 2)) / P(1, 1) * z, -z);
        return camera.T_world_cam * view;
    }

    /// Whether the surfaces of two neighbouring pixels are not joined: one rises from the other by more than
    /// the pixels are apart.
    bool is_step(int x, int y, int other_x, int other_y) const {
        if (!covered(other_x, other_y)) return true;
        const Vec3d to = world(other_x, other_y) - world(x, y);
        const double pixel = 2 * camera.projection_matrix(1).inverse()(1, 1) / depth.height() *
                             (camera.projection == Projection::orthographic ? 1 : depth.at<float>(x, y)[0]);
        return std::abs(normal_at(x, y).cast<double>().dot(to)) > 3 * pixel;
    }

    /// Whether the surface goes on without a step or a border of the picture within some pixels.
    bool off_silhouettes(int x, int y, int margin) const {
        if (x < margin || y < margin || x + margin + 1 >= depth.width() || y + margin + 1 >= depth.height())
            return false;
        for (int j = y - margin; j <= y + margin; ++j)
            for (int i = x - margin; i <= x + margin; ++i)
                if (!covered(i, j) || is_step(i, j, i + 1, j) || is_step(i, j, i, j + 1)) return false;
        return true;
    }
};

/// Visibility of the surroundings of a point, weighted by the cosine; occluders count less over the outer
/// `falloff` of the radius, as those of the setting ssao.falloff do. `count` rays in a spiral.
inline double ray_cast_visibility(const RayCaster& caster, const Vec3& position, const Vec3& normal,
                                  float radius, float falloff, int count = 512) {
    const Vec3 n = normal.normalized(), t = n.unitOrthogonal(), b = n.cross(t);
    // Off the surface by more than the rounding of its position.
    const Vec3 from = position + n * (1e-3f * radius);
    double open = 0;
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt((i + 0.5) / count), angle = i * pi * (3 - std::sqrt(5.0));
        const Vec3 d =
            t * float(r * std::cos(angle)) + b * float(r * std::sin(angle)) + n * float(std::sqrt(1 - r * r));
        const float distance = caster.distance(from, d);
        open += 1 - std::clamp((1 - distance / radius) / falloff, 0.0f, 1.0f);
    }
    return open / count;
}

struct Difference {
    double max = 0, rmse = 0, mean = 0;
    int count = 0;
};

/// Differences from `expected` (NaN: not compared) where the picture shows a surface.
inline Difference difference(const Occlusion& o, const std::function<double(int, int)>& expected,
                             int step = 1) {
    Difference result;
    double squares = 0, sum = 0;
    for (int y = 0; y < o.depth.height(); y += step)
        for (int x = 0; x < o.depth.width(); x += step) {
            const double want = o.covered(x, y) ? expected(x, y) : std::nan("");
            if (std::isnan(want)) continue;
            const double d = o.at(x, y) - want;
            result.max = std::max(result.max, std::abs(d));
            squares += d * d;
            sum += d;
            ++result.count;
        }
    result.rmse = std::sqrt(squares / result.count);
    result.mean = sum / result.count;
    return result;
}

inline app::Session occlusion_session(const Scene& scene, int size = 256) {
    app::Session session = plain_session(scene, size);
    session.settings().ssao.enabled = true;
    session.settings().rays.enabled = false;
    return session;
}

/// Quadrilateral from four corners.
inline Mesh quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    Array3f::Dense V(4, 3);
    V << a.transpose(), b.transpose(), c.transpose(), d.transpose();
    Array3i::Dense F(2, 3);
    F << 0, 1, 2, 0, 2, 3;
    return Mesh{Array3f(V), Array3i(F)};
}

inline Mesh floor_quad(float half) {
    return quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
}

inline Scene sphere_on_floor() {
    Scene scene;
    scene.show(floor_quad(40), "floor");
    Mesh sphere = make_sphere(1, 128);
    sphere.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0, 1, 0)));
    scene.show(sphere, "sphere");
    return scene;
}

inline Scene teapot_on_floor() {
    Scene scene;
    scene.show(make_teapot(1), "teapot");
    scene.show(floor_quad(1.2f), "floor");
    return scene;
}

/// A box and a sphere in the corner of two walls.
inline Scene corner_with_objects() {
    Scene scene;
    scene.show(floor_quad(1), "floor");
    scene.show(quad({-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}), "back");
    scene.show(quad({-1, 0, 1}, {-1, 0, -1}, {-1, 1, -1}, {-1, 1, 1}), "side");
    Mesh box = make_box(Vec3(0.5f, 0.4f, 0.3f));
    box.set_T_parent_mesh(Eigen::Translation3d(-0.2, 0.2, -0.4) * Eigen::AngleAxisd(0.5, Vec3d::UnitY()));
    scene.show(box, "box");
    Mesh sphere = make_sphere(0.2f, 128);
    sphere.set_T_parent_mesh(Eigen::Affine3d(Eigen::Translation3d(0.4, 0.2, 0.2)));
    scene.show(sphere, "sphere");
    return scene;
}

/// Directions and steps in which what is left is the error of the method, not of sampling it.
inline void raise_quality(app::Session& session) {
    SsaoSettings& ssao = session.settings().ssao;
    ssao.resolution = OcclusionResolution::full;
    ssao.directions = 16;
    ssao.steps = 16;
}

inline void place(app::Session& session, const Vec3d& position, const Vec3d& target, float fov_y_deg,
                  double ortho_height = 1) {
    CameraSettings& camera = session.settings().camera;
    camera.position = position;
    camera.target = target;
    camera.fov_y_deg = fov_y_deg;
    camera.ortho_height = ortho_height;
}

}  // namespace easypbr
