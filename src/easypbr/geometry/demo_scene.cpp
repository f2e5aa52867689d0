#include <cmath>
#include <string>

#include "easypbr/core/color.h"
#include "easypbr/geometry/primitives.h"

namespace easypbr {

namespace {

/// x to the right and z towards the viewer of the default camera, which stands at an azimuth of 30 degrees.
struct Place {
    float x, z, turn_deg;
};

Eigen::Affine3d pose(const Place& place, float y = 0) {
    const Eigen::AngleAxisd to_camera(radians(30), Vec3d::UnitY());
    return to_camera * Eigen::Translation3d(place.x, y, place.z) *
           Eigen::AngleAxisd(radians(place.turn_deg), Vec3d::UnitY());
}

Material make_material(const std::string& name, const Vec3& srgb, float metallic, float roughness) {
    Material material;
    material.name = name;
    material.base_color = linear_from_srgb(srgb);
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

void show(Scene& scene, const Mesh& shape, const Material& material, const Eigen::Affine3d& T_world_mesh) {
    Mesh mesh = shape.clone();
    mesh.set_material(material);
    mesh.set_T_parent_mesh(T_world_mesh);
    scene.show(mesh, material.name);
}

void show_teapots(Scene& scene) {
    const Mesh teapot = make_teapot(1, 24);
    const auto add = [&](const Material& material, const Place& place) {
        show(scene, teapot, material, pose(place));
    };
    add(make_material("copper teapot", {0.97f, 0.74f, 0.62f}, 1, 0.22f), {-2.15f, -0.95f, 24});
    add(make_material("white teapot", {0.90f, 0.89f, 0.86f}, 0, 0.6f), {0.0f, -1.45f, -32});
    add(make_material("aluminium teapot", {0.91f, 0.92f, 0.92f}, 1, 0.35f), {2.2f, -0.9f, 152});
    add(make_material("red teapot", {0.74f, 0.06f, 0.05f}, 0, 0.08f), {-1.15f, 0.95f, 206});
    add(make_material("gold teapot", {1.00f, 0.85f, 0.57f}, 1, 0.12f), {1.2f, 0.95f, 20});
}

void show_spheres(Scene& scene) {
    const auto add = [&](const Material& material, const Place& place, float radius) {
        show(scene, make_sphere(radius, 96), material, pose(place, radius));
    };
    add(make_material("chrome sphere", {0.76f, 0.77f, 0.78f}, 1, 0.04f), {0.04f, 1.75f, 0}, 0.30f);
    add(make_material("teal sphere", {0.08f, 0.46f, 0.47f}, 0, 0.45f), {-1.42f, 2.15f, 0}, 0.25f);
    add(make_material("blue sphere", {0.10f, 0.20f, 0.55f}, 0, 0.15f), {1.45f, 2.2f, 0}, 0.21f);
}

/// A low cylinder whose top is y = 0.
Mesh make_floor(float radius, float thickness) {
    constexpr int segments = 192;
    Array3f::Dense V(1 + 3 * segments, 3), N(1 + 3 * segments, 3);
    Array3i::Dense F(3 * segments, 3);
    V.row(0).setZero();
    N.row(0) << 0, 1, 0;
    for (int i = 0; i < segments; ++i) {
        const double phi = 2 * pi * i / segments;
        const Vec3 outwards(float(std::sin(phi)), 0, float(std::cos(phi)));
        const int top = 1 + i, wall = 1 + segments + 2 * i, next = (i + 1) % segments;
        V.row(top) = V.row(wall) = radius * outwards.transpose();
        V.row(wall + 1) = (radius * outwards - thickness * Vec3::UnitY()).transpose();
        N.row(top) << 0, 1, 0;
        N.row(wall) = N.row(wall + 1) = outwards.transpose();
        const int next_wall = 1 + segments + 2 * next;
        F.row(3 * i) << 0, top, 1 + next;
        F.row(3 * i + 1) << wall, wall + 1, next_wall + 1;
        F.row(3 * i + 2) << wall, next_wall + 1, next_wall;
    }
    MeshData data;
    data.name = "floor";
    data.V = std::move(V);
    data.N = std::move(N);
    data.F = std::move(F);
    return Mesh(std::move(data));
}

}  // namespace

Scene make_demo_scene() {
    Scene scene;
    show(scene, make_floor(4.2f, 0.07f), make_material("floor", {0.66f, 0.65f, 0.64f}, 0, 0.6f),
         Eigen::Affine3d::Identity());
    show_teapots(scene);
    show_spheres(scene);
    return scene;
}

}  // namespace easypbr
