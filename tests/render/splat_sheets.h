// Sheets of 3D Gaussian splats, which look the same all over, for tests of their light.
#pragma once

#include <vector>

#include "render_test.h"

namespace easypbr {

/// Of degree 0 of the spherical harmonics.
inline constexpr double constant_harmonic = 0.28209479177387814;

/// Flat splats of one opacity in planes across z, each far larger than the scene: of the same opacity all
/// over.
inline Mesh sheets(const std::vector<float>& heights, float opacity, const Vec3& color = Vec3::Constant(0.5f),
                   float scale = 300) {
    const auto n = Eigen::Index(heights.size());
    MeshData mesh;
    Array3f::Dense V(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) V.row(i) << 0, 0, heights[size_t(i)];
    mesh.V = std::move(V);
    mesh.splats.scales = Array3f::Dense(Eigen::RowVector3f(scale, scale, 0).replicate(n, 1));
    mesh.splats.rotations = Array4f::Dense(Eigen::RowVector4f(1, 0, 0, 0).replicate(n, 1));
    mesh.splats.opacities = Array1f::Dense::Constant(n, opacity);
    mesh.splats.sh = ArrayXf::Dense(
        ((color.array() - 0.5f) / float(constant_harmonic)).matrix().transpose().replicate(n, 1));
    return Mesh(mesh);
}

/// A mirror in the plane z = 0 with a sheet of splats behind the camera, seen straight on.
inline app::Session before_mirror(bool paths, float opacity, const Vec3& color, float behind) {
    Material mirror;
    mirror.base_color = Vec3::Ones();
    mirror.metallic = 1;
    mirror.roughness = 0;
    Scene scene;
    scene.show(facing_square(0.5f, mirror), "mirror");
    scene.show(sheets({behind}, opacity, color), "sheet");
    scene.set_environment(constant_environment(1));
    app::Session session = plain_session(scene, 32);
    session.settings().environment.enabled = true;
    session.settings().path.enabled = paths;
    session.settings().rays.enabled = !paths;
    session.settings().ssao.enabled = !paths;
    look_from(session, Vec3d(0, 0, 3), 10);
    return session;
}

}  // namespace easypbr
