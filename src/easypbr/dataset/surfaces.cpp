#include "easypbr/dataset/surfaces.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "easypbr/app/element_depth.h"
#include "easypbr/core/parallel.h"

namespace easypbr::dataset {
namespace {

using app::DrawnPixel, app::PixelRay;

PixelRay ray_of(const Surfaces& s, size_t pixel) {
    const Vec2d slope = s.slopes[pixel].cast<double>();
    if (s.camera.projection == Projection::orthographic)
        return {Vec3d(slope.x(), slope.y(), 0), Vec3d::UnitZ()};
    return {Vec3d::Zero(), Vec3d(slope.x(), slope.y(), 1)};
}

std::vector<Vec2> slopes_of(const Camera& camera, Vec2i size, const app::LensMap& lens) {
    if (!lens.is_identity()) return lens.slopes;
    std::vector<Vec2> slopes(size_t(size.x()) * size_t(size.y()));
    const RaySlopes rays = ray_slopes(camera, size);
    parallel_for(size_t(size.y()), 16, [&](size_t row) {
        for (int x = 0; x < size.x(); ++x) {
            const Vec2d ndc(2 * (x + 0.5) / size.x() - 1, 1 - 2 * (double(row) + 0.5) / size.y());
            slopes[row * size_t(size.x()) + size_t(x)] = rays.at(ndc);
        }
    });
    return slopes;
}

/// Weights that may be a little outside of the face are brought to its border.
Vec3 inside(const Vec3d& weights) {
    const Vec3d positive = weights.cwiseMax(0.0);
    const double sum = positive.sum();
    return sum > 0 ? Vec3((positive / sum).cast<float>()) : Vec3(Vec3::Constant(1.0f / 3));
}

DrawnPixel drawn_pixel(const app::LensMap& lens, size_t drawn, double depth) {
    if (lens.is_identity()) return {depth, std::nullopt};
    const Vec2d slope = lens.drawn_slope(drawn);
    return {depth, PixelRay{Vec3d::Zero(), {slope.x(), slope.y(), 1}}};
}

void meet_face(Surfaces& s, size_t pixel, const Eigen::Affine3d& T_cv_mesh, const DrawnPixel& drawn) {
    const MeshData& mesh = s.mesh_of(pixel);
    const int32_t* f = mesh.F.data() + 3 * s.element_of(pixel);
    std::array<Vec3d, 3> corner;
    for (size_t k = 0; k < 3; ++k) corner[k] = T_cv_mesh * Vec3(mesh.V.row(f[k])).cast<double>();
    const PixelRay ray = ray_of(s, pixel);
    const double depth = app::depth_on_face(corner, ray, drawn);
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const Vec3d point = ray.origin + depth * ray.direction;
    const double area = normal.squaredNorm();
    Vec3d weights = Vec3d::Constant(1.0 / 3);
    if (area > 0)
        for (size_t k = 0; k < 3; ++k)
            weights[Eigen::Index(k)] =
                normal.dot((corner[(k + 2) % 3] - corner[(k + 1) % 3]).cross(point - corner[(k + 1) % 3])) /
                area;
    s.position[pixel] = point.cast<float>();
    s.barycentrics[pixel] = inside(weights);
}

}  // namespace

RaySlopes ray_slopes(const Camera& camera, Vec2i size) {
    const Mat4d P = camera.projection_matrix(double(size.x()) / size.y());
    const bool orthographic = camera.projection == Projection::orthographic;
    return {orthographic ? Vec2d(-P(0, 3), -P(1, 3)) : Vec2d(P(0, 2), P(1, 2)),
            Vec2d(1 / P(0, 0), -1 / P(1, 1))};
}

Eigen::Affine3d cv_from_mesh(const Camera& camera, const SceneSnapshot::Object& object) {
    return Eigen::Affine3d(camera.opencv_T_world_cam()).inverse(Eigen::Isometry) * object.T_world_mesh;
}

Eigen::Affine3d inverse_pose(const Eigen::Affine3d& T) {
    const Eigen::CompleteOrthogonalDecomposition<Mat3d> linear(T.linear());
    if (linear.rank() == 3) return T.inverse();
    Eigen::Affine3d inverse = Eigen::Affine3d::Identity();
    inverse.linear() = linear.pseudoInverse();
    inverse.translation() = -inverse.linear() * T.translation();
    return inverse;
}

Vec2d project(const Camera& camera, Vec2i size, const Vec3d& p) {
    if (camera.projection == Projection::orthographic) {
        const double scale = size.y() / camera.ortho_height;
        return {p.x() * scale + (size.x() - 1) / 2.0, p.y() * scale + (size.y() - 1) / 2.0};
    }
    const Mat3d K = camera.opencv_K(size.x(), size.y());
    Vec2d slopes(p.x() / p.z(), p.y() / p.z());
    if (camera.distortion) slopes = camera.distortion->distort(slopes);
    return {K(0, 0) * slopes.x() + K(0, 1) * slopes.y() + K(0, 2), K(1, 1) * slopes.y() + K(1, 2)};
}

double lens_reach(const Camera& camera) {
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    if (!camera.distortion) return unlimited;
    constexpr double step = 1.01, largest = 100;
    constexpr int directions = 16;
    double least = unlimited;
    for (int k = 0; k < directions; ++k) {
        const double angle = 2 * std::numbers::pi * k / directions;
        const auto reached = [&](double slope) {
            return camera.distortion->distort(slope * Vec2d(std::cos(angle), std::sin(angle))).norm();
        };
        double slope = 1e-3, before = 0;
        for (; slope < largest; slope *= step) {
            const double now = reached(slope);
            if (!(now > before)) break;
            before = now;
        }
        if (!(slope < largest)) continue;
        // The fold lies in the last two steps: the largest value by thirds.
        double low = slope / (step * step), high = slope;
        for (int i = 0; i < 50; ++i) {
            const double third = (high - low) / 3;
            if (reached(low + third) < reached(high - third))
                low += third;
            else
                high -= third;
        }
        least = std::min(least, low);
    }
    return least;
}

bool is_projected(const Camera& camera, double lens_reach, const Vec3d& p) {
    if (camera.projection == Projection::orthographic) return true;
    return p.z() > 0 && p.head<2>().norm() < lens_reach * p.z();
}

Surfaces surfaces_of(render::SurfaceFrame frame, const Camera& camera, const app::LensMap& lens) {
    Surfaces s;
    s.size = lens.size;
    s.camera = camera;
    s.slopes = slopes_of(camera, s.size, lens);
    s.scene = frame.scene;
    s.only_faces = std::move(frame.only_faces);
    s.voxel_sizes = std::move(frame.voxel_sizes);
    const size_t count = s.slopes.size();
    s.object.resize(count);
    s.element.resize(count);
    s.part.resize(count);
    s.is_face.resize(count);
    s.position.assign(count, Vec3::Zero());
    s.barycentrics.assign(count, Vec3::Zero());
    std::vector<Eigen::Affine3d> T_cv_mesh;
    for (const auto& object : s.scene.objects) T_cv_mesh.push_back(cv_from_mesh(camera, object));
    parallel_for(count, 1 << 12, [&](size_t i) {
        const size_t drawn = lens.nearest(i);
        s.object[i] = frame.object[drawn];
        s.element[i] = frame.element[drawn];
        s.part[i] = frame.part[drawn];
        s.is_face[i] = frame.is_face[drawn];
        if (!s.covered(i)) return;
        const Eigen::Affine3d& T = T_cv_mesh[s.object[i] - 1];
        const DrawnPixel pixel = drawn_pixel(lens, drawn, frame.depth[drawn]);
        if (s.on_face(i)) return meet_face(s, i, T, pixel);
        const PixelRay ray = ray_of(s, i);
        const double depth = app::depth_on_vertex(frame, drawn, T, ray, pixel);
        s.position[i] = Vec3d(ray.origin + depth * ray.direction).cast<float>();
    });
    return s;
}

}  // namespace easypbr::dataset
