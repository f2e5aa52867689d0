#include "easypbr/app/picking.h"

#include <cmath>

#include "easypbr/app/view_point.h"
#include "easypbr/core/parallel.h"

namespace easypbr::app {
namespace {

std::array<Vec3d, 3> corners_of(const MeshData& mesh, int face, const Eigen::Affine3d& T_cv_mesh) {
    std::array<Vec3d, 3> corner;
    for (int k = 0; k < 3; ++k)
        corner[size_t(k)] = T_cv_mesh * Vec3(mesh.V.row(mesh.F(face, k))).cast<double>();
    return corner;
}

PixelRay ray_of_slope(const Vec2d& slope) {
    return {Vec3d::Zero(), {slope.x(), slope.y(), 1}};
}

Eigen::Affine3d cv_from_world(const Camera& camera) {
    return Eigen::Affine3d(camera.opencv_T_world_cam()).inverse(Eigen::Isometry);
}

}  // namespace

PixelRay PickBuffer::ray_through(Vec2d pixel) const {
    const Eigen::Affine3d T_cv_world = cv_from_world(camera_);
    const auto on_ray = [&](double depth) {
        return Vec3d(T_cv_world * point_at(camera_, pixel, size(), depth));
    };
    return {on_ray(0), on_ray(1) - on_ray(0)};
}

double PickBuffer::depth_along(const PixelRay& ray, size_t drawn) const {
    const DrawnPixel pixel{double(frame_.depth[drawn]), ray_of_drawn(drawn)};
    const SceneSnapshot::Object& seen = frame_.scene.objects[frame_.object[drawn] - 1];
    const Eigen::Affine3d T_cv_mesh = cv_from_world(camera_) * seen.T_world_mesh;
    if (!frame_.is_face[drawn]) return depth_on_vertex(frame_, drawn, T_cv_mesh, ray, pixel);
    const int face = int(frame_.element[drawn]) - 1;
    return depth_on_face(corners_of(*seen.mesh, face, T_cv_mesh), ray, pixel);
}

std::optional<PixelRay> PickBuffer::ray_of_drawn(size_t drawn) const {
    if (lens_->is_identity()) return {};
    return ray_of_slope(lens_->drawn_slope(drawn));
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
    pick.depth = depth_along(ray_through(centre), at);
    pick.position = point_at(camera_, centre, size(), pick.depth);
    return pick;
}

Image PickBuffer::depths() const {
    Image image(size().x(), size().y(), 1, PixelType::f32);
    float* to = image.pixels<float>().data();
    parallel_for(size_t(size().y()), 4, [&](size_t row) {
        for (int x = 0; x < size().x(); ++x) {
            const size_t at = row * size_t(size().x()) + size_t(x), drawn = lens_->nearest(at);
            if (frame_.object[drawn] == 0) continue;
            // The map has the inverse of the lens already.
            const PixelRay ray = lens_->is_identity() ? ray_through(Vec2d(x + 0.5, double(row) + 0.5))
                                                      : ray_of_slope(lens_->slopes[at].cast<double>());
            to[at] = float(depth_along(ray, drawn));
        }
    });
    return image;
}

}  // namespace easypbr::app
