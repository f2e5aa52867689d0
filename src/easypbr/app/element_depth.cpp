#include "easypbr/app/element_depth.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/splats/splat_depth.h"

namespace easypbr::app {
namespace {

/// How far the hit of the drawn pixel's ray may lie from the drawn depth, as a part of it: beyond, the
/// element is seen edge-on or the pixel only touches it.
constexpr double relative_depth_tolerance = 0.01;

struct Plane {
    Vec3d point, normal;
};

/// The depth at which a ray meets a plane, `otherwise` where it does not.
double depth_on_plane(const Plane& plane, const PixelRay& ray, double otherwise) {
    const double slant = plane.normal.dot(ray.direction);
    return slant != 0 ? plane.normal.dot(plane.point - ray.origin) / slant : otherwise;
}

/// That of a disc, in the camera's frame. One without a normal faces the camera.
Plane plane_of_disc(const MeshData& mesh, Eigen::Index vertex, const Eigen::Affine3d& T_cv_mesh,
                    Projection projection) {
    const Vec3d mean = T_cv_mesh * Vec3d(mesh.V.row(vertex).transpose().cast<double>()),
                n = mesh.N.row(vertex).transpose().cast<double>();
    const Mat3d& turn = T_cv_mesh.linear();
    const bool is_orthographic = projection == Projection::orthographic;
    const Vec3d towards = turn.inverse() * (is_orthographic ? Vec3d(Vec3d::UnitZ()) : mean);
    const Vec3d normal = n.squaredNorm() > 0 ? n : towards, along = normal.unitOrthogonal();
    return {mean, (turn * along).cross(turn * normal.cross(along))};
}

}  // namespace

double depth_on_face(const std::array<Vec3d, 3>& corner, const PixelRay& ray, const DrawnPixel& drawn) {
    const Plane plane{corner[0], (corner[1] - corner[0]).cross(corner[2] - corner[0])};
    const double tolerance = relative_depth_tolerance * drawn.depth;
    double depth = depth_on_plane(plane, drawn.ray.value_or(ray), drawn.depth);
    if (!(std::abs(depth - drawn.depth) <= tolerance)) return drawn.depth;
    if (!drawn.ray) return depth;
    // Beside a face that is seen edge-on its plane is somewhere else.
    const auto [nearest, farthest] = std::minmax({corner[0].z(), corner[1].z(), corner[2].z()});
    depth = depth_on_plane(plane, ray, drawn.depth);
    return depth >= nearest - tolerance && depth <= farthest + tolerance ? depth : drawn.depth;
}

double depth_on_vertex(const render::SurfaceFrame& frame, size_t drawn_pixel,
                       const Eigen::Affine3d& T_cv_mesh, const PixelRay& ray, const DrawnPixel& drawn) {
    using Shape = render::VertexShape;
    const size_t object = frame.object[drawn_pixel] - 1;
    const MeshData& mesh = *frame.scene.objects[object].mesh;
    const auto vertex = Eigen::Index(frame.element[drawn_pixel]) - 1;
    if (frame.vertex_shapes[object] == Shape::splat)
        return std::max(render::splat_depth(mesh, vertex, T_cv_mesh, {ray.origin, ray.direction}),
                        frame.camera.near);
    if (frame.vertex_shapes[object] != Shape::disc) return drawn.depth;
    const Plane plane = plane_of_disc(mesh, vertex, T_cv_mesh, frame.camera.projection);
    const auto is_near = [&](double depth) {
        return std::abs(depth - drawn.depth) <= relative_depth_tolerance * drawn.depth;
    };
    if (drawn.ray && !is_near(depth_on_plane(plane, *drawn.ray, drawn.depth))) return drawn.depth;
    const double depth = depth_on_plane(plane, ray, drawn.depth);
    return is_near(depth) ? depth : drawn.depth;
}

}  // namespace easypbr::app
