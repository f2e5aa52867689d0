#include "easypbr/render/primitives/splats/splat_projection.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/primitives/splats/splat_color.h"

namespace easypbr::render {
namespace {

/// Variance that training adds to every splat, in square pixels (Kerbl et al. 2023).
constexpr double low_pass = 0.3;
/// The projection is replaced by its derivative, which is far off outside of the picture: beyond this part
/// of its half size the derivative is that at the border (Kerbl et al. 2023).
constexpr double derivative_limit = 1.3;
/// Standard deviation of the depth of a flat splat, in its depth: a rounding.
constexpr double least_deviation = 1e-6;

/// A centre in normalised device coordinates of the frame, kept to what the whole picture shows and a little
/// more: the same for all tiles of a picture.
double limited(double ndc, int size, int origin, int picture_size) {
    const double pixel = (ndc + 1) / 2 * size + origin, middle = picture_size / 2.0,
                 reach = derivative_limit * middle;
    return (std::clamp(pixel, middle - reach, middle + reach) - origin) / size * 2 - 1;
}

}  // namespace

SplatView view_of(const Frame& frame) {
    return {.view_from_world = frame.camera.view(),
            .clip_from_view = frame.clip_from_view,
            .size = frame.size,
            .picture_size = frame.picture_size,
            .origin = frame.origin,
            .orthographic = frame.orthographic(),
            .near = frame.camera.near};
}

SplatView view_of(const ShadowView& view, int resolution) {
    const Vec2i size(resolution, resolution);
    return {.view_from_world = Mat4d::Identity(),
            .clip_from_view = view.clip_from_world(),
            .size = size,
            .picture_size = size,
            .origin = Vec2i(0, 0),
            .orthographic = !view.perspective,
            .near = view.near,
            .keeps_light = true};
}

SplatProjector::SplatProjector(const SplatView& view, const DrawItem& item)
    : view_(view), item_(item), mesh_(item.mesh()), degree_(mesh_.splats.degree()) {
    const Mat4d view_from_mesh = view.view_from_world * item.object->T_world_mesh.matrix();
    view_from_mesh_ = view_from_mesh.topRows<3>();
    turn_ = view_from_mesh_.leftCols<3>().cast<float>();
    const Mat3d inverse = view_from_mesh_.leftCols<3>().inverse();
    eye_ = view.orthographic ? Vec3d(inverse * Vec3d(0, 0, -1)) : Vec3d(-inverse * view_from_mesh_.col(3));
    least_width_ = view.orthographic ? 0.5f : float(view.near);
}

bool SplatProjector::project(Eigen::Index i, ProjectedSplat& splat) const {
    splat.opacity = mesh_.splats.opacities(i);
    if (splat.opacity < least_splat_alpha) return false;
    Mat3 axes;
    if (!place(mesh_.V.row(i).transpose().cast<double>(), splat, axes)) return false;
    const auto& q = mesh_.splats.rotations;
    const Eigen::Quaternionf rotation(q(i, 0), q(i, 1), q(i, 2), q(i, 3));
    const Mat3 turned = turn_ * rotation.normalized().toRotationMatrix();
    axes = Mat3(axes * turned) * mesh_.splats.scales.row(i).transpose().asDiagonal();
    if (!widen(axes, splat)) return false;
    splat.index = uint32_t(i);
    return true;
}

void SplatProjector::color(Eigen::Index i, ProjectedSplat& splat) const {
    const Vec3 seen = color_of(i);
    splat.red = seen.x();
    splat.green = seen.y();
    splat.blue = seen.z();
}

bool SplatProjector::place(const Vec3d& mean, ProjectedSplat& splat, Mat3& derivative) const {
    const Mat4d& P = view_.clip_from_view;
    const Eigen::Vector4d clip = P * (view_from_mesh_ * mean.homogeneous()).homogeneous();
    if (!(clip.w() >= double(least_width_))) return false;
    const Vec2d ndc = clip.head<2>() / clip.w();
    splat.depth = float(clip.z() / clip.w());
    if (!(splat.depth > 0 && splat.depth <= 1)) return false;
    const Vec2d half = view_.size.cast<double>() / 2;
    splat.x = float((1 + ndc.x()) * half.x());
    splat.y = float((1 - ndc.y()) * half.y());
    // Rows count downwards.
    const double x = limited(ndc.x(), view_.size.x(), view_.origin.x(), view_.picture_size.x()),
                 y = -limited(-ndc.y(), view_.size.y(), view_.origin.y(), view_.picture_size.y());
    const Eigen::RowVector3d w = P.block<1, 3>(3, 0);
    derivative.row(0) = (half.x() / clip.w() * (P.block<1, 3>(0, 0) - x * w)).cast<float>();
    derivative.row(1) = (-half.y() / clip.w() * (P.block<1, 3>(1, 0) - y * w)).cast<float>();
    derivative.row(2) = ((P.block<1, 3>(2, 0) - clip.z() / clip.w() * w) / clip.w()).cast<float>();
    return true;
}

bool SplatProjector::widen(const Mat3& axes, ProjectedSplat& splat) const {
    const Mat3d own = axes.cast<double>();
    const double own_xx = own.row(0).squaredNorm(), own_yy = own.row(1).squaredNorm(),
                 own_xy = own.row(0).dot(own.row(1));
    const double xx = own_xx + low_pass, yy = own_yy + low_pass, area = xx * yy - own_xy * own_xy;
    if (!(area > 0) || !std::isfinite(area)) return false;
    if (item_.style.splat_antialias || view_.keeps_light)
        splat.opacity *= float(std::sqrt(std::max(0.0, own_xx * own_yy - own_xy * own_xy) / area));
    if (splat.opacity < least_splat_alpha) return false;
    const double per_area = 1 / area;
    splat.xx = float(yy * per_area);
    splat.xy = float(-own_xy * per_area);
    splat.yy = float(xx * per_area);
    // The mean of a Gaussian's depth where column and row are given.
    const double x_depth = own.row(0).dot(own.row(2)), y_depth = own.row(1).dot(own.row(2));
    splat.depth_x = float((yy * x_depth - own_xy * y_depth) * per_area);
    splat.depth_y = float((xx * y_depth - own_xy * x_depth) * per_area);
    // What is left of its variance.
    const double along =
        own.row(2).squaredNorm() - double(splat.depth_x) * x_depth - double(splat.depth_y) * y_depth;
    splat.sharpness =
        float(1 / std::max(std::sqrt(std::max(0.0, along)), double(splat.depth) * least_deviation));
    // Where its opacity falls to the least that is seen.
    const float farthest = 2 * std::log(splat.opacity / least_splat_alpha);
    splat.half_width = std::sqrt(farthest * float(xx));
    splat.half_height = std::sqrt(farthest * float(yy));
    return splat.x + splat.half_width > 0 && splat.x - splat.half_width < float(view_.size.x()) &&
           splat.y + splat.half_height > 0 && splat.y - splat.half_height < float(view_.size.y());
}

Vec3 SplatProjector::color_of(Eigen::Index i) const {
    if (item_.with_colors) return mesh_.C.row(i).head<3>().transpose();
    const ArrayXf& sh = mesh_.splats.sh;
    const float* const own = sh.data() + i * sh.cols();
    if (degree_ == 0) return splat_color(own, 0, Vec3(0, 0, 1));
    const Vec3d mean = mesh_.V.row(i).transpose().cast<double>();
    const Vec3d direction = view_.orthographic ? eye_ : Vec3d(mean - eye_);
    return splat_color(own, degree_, direction.normalized().cast<float>());
}

}  // namespace easypbr::render
