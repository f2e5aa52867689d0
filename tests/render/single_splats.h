// Single 3D Gaussian splats before a camera, for tests.
#pragma once

#include <utility>
#include <vector>

#include "splat_sheets.h"

namespace easypbr::render::single_splats {

inline constexpr double distance = 4, fov_y_deg = 30;
inline constexpr float code = 1.0f / 255;

struct Splat {
    Vec3d mean{0, 0, 0}, scales{0.1, 0.1, 0.1};
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    double opacity = 0.8;
    Eigen::Matrix<double, Eigen::Dynamic, 3> sh = Eigen::Matrix<double, 1, 3>::Zero();
};

inline Eigen::Matrix<double, 1, 3> sh_of(const Vec3d& color) {
    return (color.transpose().array() - 0.5) / constant_harmonic;
}

inline MeshData mesh_of(const std::vector<Splat>& splats) {
    const auto n = Eigen::Index(splats.size());
    Array3f::Dense V(n, 3), scales(n, 3);
    Array4f::Dense rotations(n, 4);
    Array1f::Dense opacities(n);
    ArrayXf::Dense sh(n, splats.front().sh.size());
    for (Eigen::Index i = 0; i < n; ++i) {
        const Splat& s = splats[size_t(i)];
        V.row(i) = s.mean.transpose().cast<float>();
        scales.row(i) = s.scales.transpose().cast<float>();
        rotations.row(i) << float(s.rotation.w()), float(s.rotation.x()), float(s.rotation.y()),
            float(s.rotation.z());
        opacities(i) = float(s.opacity);
        for (Eigen::Index k = 0; k < s.sh.rows(); ++k)
            for (Eigen::Index c = 0; c < 3; ++c) sh(i, 3 * k + c) = float(s.sh(k, c));
    }
    MeshData mesh;
    mesh.V = std::move(V);
    mesh.splats = {std::move(scales), std::move(rotations), std::move(opacities), std::move(sh)};
    return mesh;
}

inline app::Session session_of(const Scene& scene, int size) {
    app::Session session = plain_session(scene, size);
    look_from(session, Vec3d(0, 0, distance), float(fov_y_deg));
    return session;
}

/// One wide splat whose opacity in the middle of the picture is known.
inline Splat wide_splat(double z) {
    Splat splat;
    splat.mean = Vec3d(0, 0, z);
    splat.scales = Vec3d(5, 5, 0.01);
    splat.opacity = 0.75;
    splat.sh = sh_of(Vec3d(1, 0, 0));
    return splat;
}

inline Mesh unlit_square(const Vec3& color, float opacity = 1) {
    Material material;
    material.unlit = true;
    material.emissive = Vec3::Zero();
    material.base_color = color;
    material.opacity = opacity;
    if (opacity < 1) material.alpha_mode = AlphaMode::blend;
    return facing_square(0.5f, material);
}

inline Eigen::Vector4f middle_of(const Scene& scene, bool native = true, int samples = 1) {
    app::Session session = session_of(scene, 32);
    session.allow_native_geometry(native);
    session.allow_native_shading(native);
    const Image image = render_linear(session, samples);
    return Eigen::Map<const Eigen::Vector4f>(image.at<float>(16, 16));
}

}  // namespace easypbr::render::single_splats
