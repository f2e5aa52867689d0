#include "easypbr/geometry/camera_shapes.h"

#include <array>

#include "easypbr/geometry/require.h"

namespace easypbr {

using geometry::require_positive;

namespace {

/// Corners of the picture in the camera's frame, counter-clockwise from the lower left, as the camera sees
/// them.
using Corners = std::array<Vec3, 4>;

Corners picture_corners(const Camera& camera, const Vec2i& size, double depth) {
    double left, right, bottom, top;
    if (camera.projection == Projection::orthographic) {
        top = camera.ortho_height / 2;
        right = top * size.x() / size.y();
        left = -right;
        bottom = -top;
    } else {
        const Mat3d K = camera.opencv_K(size.x(), size.y());
        // Pixel centres are at integers, so the picture's border is half a pixel outside of the first and
        // last.
        left = (-0.5 - K(0, 2)) / K(0, 0) * depth;
        right = (size.x() - 0.5 - K(0, 2)) / K(0, 0) * depth;
        bottom = -(size.y() - 0.5 - K(1, 2)) / K(1, 1) * depth;
        top = -(-0.5 - K(1, 2)) / K(1, 1) * depth;
    }
    return {Vec3d(left, bottom, -depth).cast<float>(), Vec3d(right, bottom, -depth).cast<float>(),
            Vec3d(right, top, -depth).cast<float>(), Vec3d(left, top, -depth).cast<float>()};
}

/// Four starts of the rays, the corners, and the tip of the roof.
MeshData outline(const Corners& corners, bool parallel) {
    Array3f::Dense V(9, 3);
    for (int i = 0; i < 4; ++i) {
        const Vec3 start = parallel ? Vec3(corners[size_t(i)].x(), corners[size_t(i)].y(), 0) : Vec3(0, 0, 0);
        V.row(i) = start.transpose();
        V.row(4 + i) = corners[size_t(i)].transpose();
    }
    const Vec3 up = corners[3] - corners[0];
    V.row(8) = ((corners[2] + corners[3]) / 2 + up / 4).transpose();
    MeshData data;
    data.V = std::move(V);
    data.E = Array2i::Dense{{0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {7, 8}, {8, 6}};
    return data;
}

Mesh picture(const Corners& corners, const Image& image) {
    Array3f::Dense V(4, 3);
    for (int i = 0; i < 4; ++i) V.row(i) = corners[size_t(i)].transpose();
    MeshData data;
    data.name = "image";
    data.V = std::move(V);
    data.N = Array3f::Dense(Vec3::UnitZ().transpose().replicate(4, 1));
    data.UV = Array2f::Dense{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    data.F = Array3i::Dense{{0, 1, 2}, {0, 2, 3}};
    Material material;
    material.name = "image";
    material.base_color.setOnes();
    material.unlit = true;
    material.double_sided = true;
    material.base_color_texture.image = std::make_shared<const Image>(image);
    material.base_color_texture.wrap_u = material.base_color_texture.wrap_v = Wrap::clamp;
    data.materials = {material};
    data.style.lit = false;  // the image's own colours, past exposure and tone curve
    return Mesh(std::move(data));
}

}  // namespace

Mesh make_camera_frustum(const Camera& camera, const Vec2i& size, double depth, const Image& image) {
    require_positive("camera frustum: depth", depth);
    require_positive("camera frustum: width", size.x());
    require_positive("camera frustum: height", size.y());
    const bool parallel = camera.projection == Projection::orthographic;
    require_positive(parallel ? "camera frustum: ortho_height" : "camera frustum: fov_y_deg",
                     parallel ? camera.ortho_height : camera.fov_y_deg);
    const Corners corners = picture_corners(camera, size, depth);
    MeshData data = outline(corners, parallel);
    data.name = "camera";
    data.T_parent_mesh = camera.T_world_cam;
    if (!image.empty()) data.children = {picture(corners, image)};
    return Mesh(std::move(data));
}

Mesh make_camera_frustum(const Mat3d& K, const Mat4d& T_world_cam, const Vec2i& size, double depth,
                         const Image& image) {
    return make_camera_frustum(Camera::from_opencv(K, T_world_cam, size.x(), size.y()), size, depth, image);
}

namespace {

constexpr int pieces_per_stretch = 32, cameras_of_orbit = 12;

std::vector<double> camera_times(const CameraPath& path) {
    return path.circle() ? path.times(cameras_of_orbit) : path.key_times_s();
}

/// Times of the curve's vertices: those of the cameras and between them, and of a closed path its end.
std::vector<double> curve_times(const CameraPath& path) {
    std::vector<double> stretches = camera_times(path);
    if (path.is_closed()) stretches.push_back(path.duration_s());
    std::vector<double> times{stretches.front()};
    for (size_t i = 0; i + 1 < stretches.size(); ++i)
        for (int k = 1; k <= pieces_per_stretch; ++k)
            times.push_back(stretches[i] + (stretches[i + 1] - stretches[i]) * k / pieces_per_stretch);
    return times;
}

}  // namespace

Mesh make_camera_path(const CameraPath& path, const Vec2i& size, double fov_y_deg,
                      std::optional<double> depth) {
    const std::vector<double> times = curve_times(path);
    const auto count = Eigen::Index(times.size());
    Array3f::Dense V(count, 3);
    Array2i::Dense E(count - 1, 2);
    for (Eigen::Index i = 0; i < count; ++i)
        V.row(i) = path.pose(times[size_t(i)]).translation().cast<float>().transpose();
    for (Eigen::Index i = 0; i + 1 < count; ++i) E.row(i) << int(i), int(i + 1);
    const Vec3 extent = (V.colwise().maxCoeff() - V.colwise().minCoeff()).transpose();
    const double length = depth.value_or(extent.norm() > 0 ? double(extent.norm()) / 10 : 1);
    MeshData data;
    data.name = "camera path";
    data.V = std::move(V);
    data.E = std::move(E);
    Camera like;
    like.fov_y_deg = fov_y_deg;
    for (const double time : camera_times(path))
        data.children.push_back(make_camera_frustum(path.camera(time, like), size, length));
    return Mesh(std::move(data));
}

}  // namespace easypbr
