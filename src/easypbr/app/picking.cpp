#include "easypbr/app/picking.h"

#include <cmath>

#include "easypbr/app/view_point.h"

namespace easypbr::app {
namespace {

std::array<Vec3d, 3> corners_of(const MeshData& mesh, int face, const Eigen::Affine3d& T_cv_mesh) {
    std::array<Vec3d, 3> corner;
    for (int k = 0; k < 3; ++k)
        corner[size_t(k)] = T_cv_mesh * Vec3(mesh.V.row(mesh.F(face, k))).cast<double>();
    return corner;
}

}  // namespace

double PickBuffer::depth_at(Vec2d centre, size_t drawn) const {
    const DrawnPixel pixel{double(frame_.depth[drawn]), ray_of_drawn(drawn)};
    if (!frame_.is_face[drawn]) return pixel.depth;
    const SceneSnapshot::Object& seen = frame_.scene.objects[frame_.object[drawn] - 1];
    const Eigen::Affine3d T_cv_world(Eigen::Affine3d(camera_.opencv_T_world_cam()).inverse(Eigen::Isometry));
    const auto on_ray = [&](double depth) {
        return Vec3d(T_cv_world * point_at(camera_, centre, size(), depth));
    };
    const PixelRay ray{on_ray(0), on_ray(1) - on_ray(0)};
    const int face = int(frame_.element[drawn]) - 1;
    return depth_on_face(corners_of(*seen.mesh, face, T_cv_world * seen.T_world_mesh), ray, pixel);
}

std::optional<PixelRay> PickBuffer::ray_of_drawn(size_t drawn) const {
    if (lens_->is_identity()) return {};
    const Vec2d slope = lens_->drawn_slope(drawn);
    return PixelRay{Vec3d::Zero(), {slope.x(), slope.y(), 1}};
}

std::optional<Pick> PickBuffer::at(Vec2d pixel) const {
    const int x = int(std::floor(pixel.x())), y = int(std::floor(pixel.y()));
    if (x < 0 || y < 0 || x >= size().x() || y >= size().y()) return {};
    size_t at = size_t(y) * size_t(size().x()) + size_t(x);
    if (!lens_->is_identity()) at = lens_->nearest(at);
    if (frame_.object[at] == 0) return {};
    const SceneSnapshot::Object& seen = frame_.scene.objects[frame_.object[at] - 1];
    Pick pick;
    pick.object = seen.name;
    pick.is_face = frame_.is_face[at];
    pick.element = int(frame_.element[at]) - 1;
    if (pick.is_face && !seen.mesh->parts.empty()) {
        pick.part_index = int(frame_.part[at]);
        pick.part = seen.mesh->parts[frame_.part[at]].name;
    }
    const Vec2d centre(x + 0.5, y + 0.5);
    pick.depth = depth_at(centre, at);
    pick.position = point_at(camera_, centre, size(), pick.depth);
    return pick;
}

}  // namespace easypbr::app
