#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/error.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/draw_style.h"
#include "easypbr/scene/resolve.h"

namespace easypbr {
namespace detail {
namespace {

/// No vertex comes nearer to a fitted camera than this part of the content's radius.
constexpr double nearest_part = 0.01;

/// How far the picture (less insets and margin) reaches to each side, per unit of depth.
struct Slopes {
    double right, left, top, bottom;
};

Slopes slopes_of(const Camera& lens, double margin, const PictureShape& picture) {
    const Mat4d P = lens.projection_matrix(picture.aspect);
    const Edges edges = edges_of(picture, margin);
    return {(edges.right + P(0, 2)) / P(0, 0), (edges.left - P(0, 2)) / P(0, 0),
            (edges.top + P(1, 2)) / P(1, 1), (edges.bottom - P(1, 2)) / P(1, 1)};
}

/// Whether the lens looks along the middle of the picture.
bool is_centred(const Camera& lens, double aspect) {
    const Mat4d P = lens.projection_matrix(aspect);
    return P(0, 2) == 0 && P(1, 2) == 0;
}

/// Rows: what decides about the right, left, upper and lower side of a picture (for slopes of 0: the axes
/// themselves), then backwards and forwards.
SceneSnapshot::Directions frustum_directions(const Mat3d& R_world_cam, const Slopes& slopes) {
    const Eigen::RowVector3d x = R_world_cam.col(0), y = R_world_cam.col(1), z = R_world_cam.col(2);
    SceneSnapshot::Directions directions;
    directions << x + slopes.right * z, -x + slopes.left * z, y + slopes.top * z, -y + slopes.bottom * z, z,
        -z;
    return directions;
}

/// A camera at (c, d) sees a point (x, z) when x - c <= right (d - z) and c - x <= left (d - z). With
/// P = max(x + right z) and Q = max(left z - x) that is P - right d <= c <= left d - Q: possible from
/// d = (P + Q) / (right + left) on, where both sides are touched. Further away the middle of the room is
/// taken.
double centre_of(double P, double Q, double right, double left, double d) {
    return ((P - right * d) + (left * d - Q)) / 2;
}

}  // namespace

namespace {

/// The axis that does not decide about the distance has room to spare. It is centred in the picture where
/// both sides touch narrower slopes, t to each side of the middle m: f(t) = P(t) + Q(t) - 2 t d = 0. f is
/// convex and falls; two secant steps leave a small part of the room. The interval that the full slopes allow
/// is kept in any case.
Vec2d balanced_centre(const Content& content, const Mat3d& R_world_cam, const Slopes& slopes,
                      const SceneSnapshot::Support& support, double d) {
    const double depth =
        std::max(d - R_world_cam.col(2).dot(content.centre()), nearest_part * content.radius());
    const Vec2d right(slopes.right, slopes.top), left(slopes.left, slopes.bottom);
    const Vec2d full = (right + left) / 2, middle = (right - left) / 2;
    const auto excess = [&](const SceneSnapshot::Support& s, const Vec2d& t) {
        return Vec2d(s[0] + s[1] - 2 * t.x() * d, s[2] + s[3] - 2 * t.y() * d);
    };
    const auto support_at = [&](const Vec2d& t) {
        const Vec2d to = middle + t, from = t - middle;
        return content.scene().support(frustum_directions(R_world_cam, {to.x(), from.x(), to.y(), from.y()}));
    };
    const Vec2d f0 = excess(support, full);
    Vec2d t = (full + f0 / (2 * depth)).cwiseMax(0.0);
    SceneSnapshot::Support s = support_at(t);
    const Vec2d f1 = excess(s, t);
    for (int axis = 0; axis < 2; ++axis)
        if (f1[axis] != f0[axis])
            t[axis] = std::clamp(t[axis] - f1[axis] * (t[axis] - full[axis]) / (f1[axis] - f0[axis]), 0.0,
                                 full[axis]);
    s = support_at(t);
    Vec2d centre;
    for (int axis = 0; axis < 2; ++axis) {
        const double low = support[2 * axis] - right[axis] * d, high = left[axis] * d - support[2 * axis + 1];
        const double balanced =
            centre_of(s[2 * axis], s[2 * axis + 1], middle[axis] + t[axis], t[axis] - middle[axis], d);
        centre[axis] = low <= high ? std::clamp(balanced, low, high) : (low + high) / 2;
    }
    return centre;
}

}  // namespace

Content::Content(const SceneSnapshot& scene, const Style& overrides) : scene_(scene), overrides_(overrides) {
    if (!changes_reach(overrides)) return;
    styled_ = scene;
    for (SceneSnapshot::Object& object : styled_->objects) set_reach(object, overrides);
}

bool Content::empty() const {
    return std::all_of(scene_.objects.begin(), scene_.objects.end(),
                       [](const SceneSnapshot::Object& object) { return object.mesh->V.empty(); });
}

const Box3d& Content::bounds() const {
    if (!bounds_) bounds_ = scene().bounds();
    return *bounds_;
}

Vec3d Content::centre() const {
    if (bounds().isEmpty()) return Vec3d::Zero();
    return bounds().center();
}

double Content::radius() const {
    const double half_diagonal = bounds().isEmpty() ? 0 : bounds().diagonal().norm() / 2;
    if (half_diagonal > 0) return half_diagonal;
    const double from_origin = centre().norm();
    return from_origin > 0 ? from_origin : 1;
}

std::pair<double, double> Content::extent_along(const Vec3d& direction) const {
    const double middle = direction.dot(bounds().center());
    const double half = direction.cwiseAbs().dot(bounds().sizes()) / 2;
    return {middle - half, middle + half};
}

double ground_below(const Box3d& content, const Vec3d& up) {
    constexpr double gap_diagonals = 5e-5;
    if (content.isEmpty()) return std::numeric_limits<double>::infinity();
    const double half = up.cwiseAbs().dot(content.sizes()) / 2;
    return up.dot(content.center()) - half - gap_diagonals * content.diagonal().norm();
}

Edges edges_of(const PictureShape& picture, double margin) {
    const Insets& in = picture.insets;
    const double across = margin * (1 - in.left - in.right), along = margin * (1 - in.top - in.bottom);
    return {1 - 2 * in.right - across, 1 - 2 * in.left - across, 1 - 2 * in.top - along,
            1 - 2 * in.bottom - along};
}

Vec3d fitted_position(const Content& content, const Mat3d& R_world_cam, const Camera& lens, double margin,
                      const PictureShape& picture, std::optional<double> ortho_height) {
    if (lens.projection == Projection::orthographic) {
        const SceneSnapshot::Support s = content.scene().support(frustum_directions(R_world_cam, {}));
        const Edges e = edges_of(picture, margin);
        const double needed = 2 * std::max((s[2] + s[3]) / (e.top + e.bottom),
                                           (s[0] + s[1]) / (e.right + e.left) / picture.aspect);
        const double half = ortho_height.value_or(needed) / 2;
        // Centres the content in the rectangle between the insets.
        const double x = (s[0] - s[1]) / 2 - (e.right - e.left) / 2 * half * picture.aspect;
        const double y = (s[2] - s[3]) / 2 - (e.top - e.bottom) / 2 * half;
        return R_world_cam * Vec3d(x, y, s[4] + content.radius());
    }
    const Slopes slopes = slopes_of(lens, margin, picture);
    const SceneSnapshot::Support s = content.scene().support(frustum_directions(R_world_cam, slopes));
    const double d =
        std::max({(s[0] + s[1]) / (slopes.right + slopes.left), (s[2] + s[3]) / (slopes.top + slopes.bottom),
                  s[4] + nearest_part * content.radius()});
    Vec2d centre(centre_of(s[0], s[1], slopes.right, slopes.left, d),
                 centre_of(s[2], s[3], slopes.top, slopes.bottom, d));
    if (is_centred(lens, picture.aspect)) centre = balanced_centre(content, R_world_cam, slopes, s, d);
    return R_world_cam * Vec3d(centre.x(), centre.y(), d);
}

double fitted_distance(const Content& content, const Vec3d& target, const Mat3d& R_world_cam,
                       const Camera& lens, double margin, const PictureShape& picture) {
    const bool orthographic = lens.projection == Projection::orthographic;
    const Slopes slopes = orthographic ? Slopes{} : slopes_of(lens, margin, picture);
    const SceneSnapshot::Directions directions = frustum_directions(R_world_cam, slopes);
    const SceneSnapshot::Support s = content.scene().support(directions) - directions * target;
    double distance = s[4] + (orthographic ? 1 : nearest_part) * content.radius();
    const double sides[] = {slopes.right, slopes.left, slopes.top, slopes.bottom};
    // A side that the optical axis does not reach cannot be cleared by stepping back.
    for (int i = 0; i < 4; ++i)
        if (sides[i] > 0) distance = std::max(distance, s[i] / sides[i]);
    return std::max(distance, nearest_part * content.radius());
}

double fitted_height(const Content& content, const Eigen::Isometry3d& T_world_cam, double margin,
                     const PictureShape& picture) {
    const SceneSnapshot::Directions directions = frustum_directions(T_world_cam.linear(), {});
    const SceneSnapshot::Support s =
        content.scene().support(directions) - directions * T_world_cam.translation();
    const Edges e = edges_of(picture, margin);
    const double sides[] = {e.right * picture.aspect, e.left * picture.aspect, e.top, e.bottom};
    double height = 0;
    for (int i = 0; i < 4; ++i)
        if (sides[i] > 0) height = std::max(height, 2 * s[i] / sides[i]);
    return height > 0 ? height : 2 * content.radius();
}

}  // namespace detail

Mat3d up_frame(const Vec3d& up) {
    const Vec3d front = up.z() > 0.5    ? Vec3d(-Vec3d::UnitY())
                        : up.z() < -0.5 ? Vec3d::UnitY()
                                        : Vec3d::UnitZ();
    Mat3d frame;
    frame << up.cross(front).transpose(), up.transpose(), front.transpose();
    return frame;
}

Mat3d view_rotation(const CameraSettings& settings) {
    const double azimuth = radians(settings.azimuth_deg.value_or(detail::usual_view.azimuth_deg)),
                 elevation = radians(settings.elevation_deg.value_or(detail::usual_view.elevation_deg));
    const Mat3d frame = up_frame(up_direction(settings));
    const Vec3d right = frame.row(0), up = frame.row(1), front = frame.row(2);
    const Vec3d level = std::cos(azimuth) * front + std::sin(azimuth) * right;
    Mat3d R;
    R << std::cos(azimuth) * right - std::sin(azimuth) * front,
        std::cos(elevation) * up - std::sin(elevation) * level,
        std::cos(elevation) * level + std::sin(elevation) * up;
    return R;
}

Camera fit_camera(const SceneSnapshot& scene, const Mat3d& R_world_cam, const CameraSettings& settings,
                  double aspect, const Insets& insets) {
    const detail::Content content(scene, {});
    if (content.empty()) throw ArgumentError("camera: there are no vertices to fit a camera to");
    const detail::PictureShape picture{aspect, insets};
    Camera camera = detail::lens_of(settings);
    camera.T_world_cam.linear() = R_world_cam;
    camera.T_world_cam.translation() =
        detail::fitted_position(content, R_world_cam, camera, settings.margin, picture, std::nullopt);
    if (camera.projection == Projection::orthographic)
        camera.ortho_height = detail::fitted_height(content, camera.T_world_cam, settings.margin, picture);
    return camera;
}

}  // namespace easypbr
