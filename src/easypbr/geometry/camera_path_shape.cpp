#include "easypbr/geometry/camera_shapes.h"

#include "easypbr/geometry/require.h"

namespace easypbr {
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
