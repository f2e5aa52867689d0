#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "easypbr/app/animation_player.h"
#include "easypbr/app/orbit_grid.h"
#include "easypbr/app/recorded_content.h"
#include "easypbr/app/recorder.h"
#include "easypbr/app/session.h"
#include "easypbr/core/error.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/offset.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

/// What a thing sweeps out as it turns: a cylinder around `axis` through `center`.
struct Cylinder {
    Vec3d center, axis;
    double radius = 0, half_height = 0;
};

Cylinder swept(const SceneSnapshot& scene, const Vec3d& axis) {
    const Box3d box = scene.bounds();
    Cylinder swept{box.isEmpty() ? Vec3d(Vec3d::Zero()) : Vec3d(box.center()), axis};
    if (!box.isEmpty()) swept.half_height = std::abs(axis.dot(box.sizes())) / 2;
    for (const SceneSnapshot::Object& object : scene.objects)
        for (Eigen::Index i = 0; i < object.mesh->V.rows(); ++i) {
            const Vec3d arm =
                object.T_world_mesh * object.mesh->V.row(i).transpose().cast<double>() - swept.center;
            swept.radius = std::max(swept.radius, (arm - axis * axis.dot(arm)).norm());
        }
    return swept;
}

/// The part of a picture that content is to stay in, per unit of depth, or of half an orthographic picture's
/// height: where its middle is from the optical axis, and half of its sides.
struct FreePart {
    Vec2d middle, half;
};

bool is_orthographic(const Camera& camera) {
    return camera.projection == Projection::orthographic;
}

FreePart free_part(const Camera& lens, double margin, const Vec2i& size, const Insets& insets) {
    const double aspect = double(size.x()) / size.y(),
                 tangent = is_orthographic(lens) ? 1 : std::tan(radians(lens.fov_y_deg) / 2);
    const detail::Edges e = detail::edges_of({aspect, insets}, margin);
    const auto across = [&](double part) { return tangent * part * size.x() / size.y(); };
    return {{across((e.right - e.left) / 2), tangent * ((e.top - e.bottom) / 2)},
            {across((e.right + e.left) / 2), tangent * ((e.top + e.bottom) / 2)}};
}

bool is_automatic(const CameraSettings& camera) {
    const bool has_free_size =
        camera.projection == Projection::perspective || !camera.ortho_height.is_pinned();
    return camera.pose.empty() && !camera.position.is_pinned() && !camera.target.is_pinned() &&
           camera.intrinsics.empty() && has_free_size;
}

/// What a camera is turned around, and how far away it is for all of its directions.
struct Round {
    ResolvedSettings resolved;
    Cylinder content;
    Camera camera;
    bool fits = false;  ///< the distance, or the height of an orthographic picture, is free
    FreePart part;
};

/// `content`: what the settings were resolved for.
Round round_of(Session& session, ResolvedSettings resolved, const SceneSnapshot& content, const Vec2i& size) {
    Round round{std::move(resolved), {}, {}, false, {}};
    round.content = swept(content, parse_up(round.resolved.settings.camera.up));
    round.camera = round.resolved.camera;
    round.fits =
        is_automatic(session.settings().camera) && round.content.radius + round.content.half_height > 0;
    if (round.fits)
        round.part = free_part(round.camera, round.resolved.settings.camera.margin, size,
                               session.annotation_strip(size));
    return round;
}

Round round_of(Session& session, const Vec2i& size) {
    return round_of(session, session.resolve(size), session.scene().snapshot(), size);
}

/// The distance from which a camera sees all of the cylinder, whose middle is seen in the middle m of the
/// part, or half of the height of an orthographic picture of it: a point p (from the cylinder's middle, in
/// the camera's axes) is in the part, h to each side, from d >= |x + m z| / h + z on; in an orthographic
/// picture from |x| / h on.
double reach_for(const Round& round, const Camera& camera) {
    constexpr int directions = 256;
    const Cylinder& cylinder = round.content;
    const FreePart& part = round.part;
    const Vec3d side = cylinder.axis.unitOrthogonal(), other = cylinder.axis.cross(side);
    const Mat3d R_cam_world = camera.T_world_cam.linear().transpose();
    const bool converges = !is_orthographic(camera);
    double reach = 0;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * pi * i / directions;
        const Vec3d rim = cylinder.radius * (std::cos(angle) * side + std::sin(angle) * other);
        for (const double end : {-1.0, 1.0}) {
            const Vec3d p = R_cam_world * (rim + end * cylinder.half_height * cylinder.axis);
            const double z = converges ? p.z() : 0;
            for (int axis = 0; axis < 2; ++axis)
                reach = std::max(reach, std::abs(p[axis] + part.middle[axis] * z) / part.half[axis] + z);
        }
    }
    return reach;
}

/// `reach`: see reach_for().
void place_at(Camera& camera, const Round& round, double reach) {
    const Mat3d axes = camera.T_world_cam.linear();
    const Vec2d aside = round.part.middle * reach;
    double distance = reach;
    if (is_orthographic(camera)) {
        camera.ortho_height = 2 * reach;
        // Anywhere before all of it.
        distance = 2 * std::hypot(round.content.radius, round.content.half_height);
    }
    camera.T_world_cam.translation() =
        round.content.center + axes.col(2) * distance - axes.leftCols<2>() * aside;
}

CameraPath turn_around(const Round& round, double duration_s) {
    Camera camera = round.camera;
    if (round.fits) place_at(camera, round, reach_for(round, camera));
    return CameraPath::orbit(camera, round.content.center, round.content.axis, 360, duration_s);
}

/// The camera turned up about the content's middle, in the vertical plane that it stands in.
Camera raised(const Round& round, double up_deg) {
    Camera camera = round.camera;
    const Vec3d back = camera.T_world_cam.linear().col(2), side = round.content.axis.cross(back);
    const Vec3d right =
        side.norm() > 1e-9 ? Vec3d(side.normalized()) : Vec3d(camera.T_world_cam.linear().col(0));
    const Eigen::AngleAxisd turn(-radians(up_deg), right);
    camera.T_world_cam.linear() = turn.toRotationMatrix() * round.camera.T_world_cam.linear();
    camera.T_world_cam.translation() =
        round.content.center + turn * (round.camera.T_world_cam.translation() - round.content.center);
    return camera;
}

constexpr double steepest_deg = 85;

/// The number of steps to the lowest row, 0 or below: as many rows to each side as there is room for.
int lowest_step(double elevation_deg, int rows, double step_deg) {
    int lowest = -(rows - 1) / 2;
    while (lowest > 1 - rows && elevation_deg + (lowest + rows - 1) * step_deg > steepest_deg) --lowest;
    while (lowest < 0 && elevation_deg + lowest * step_deg < -steepest_deg) ++lowest;
    return lowest;
}

}  // namespace

CameraPath turntable(Session& session, double duration_s) {
    return turn_around(round_of(session, session.settings().image.size), duration_s);
}

CameraPath turntable(Session& session, double duration_s, const SceneSnapshot& content) {
    const Vec2i size = session.settings().image.size;
    return turn_around(round_of(session, resolve_for(session, content, size), content, size), duration_s);
}

CameraPath turntable(Session& session, double duration_s, AnimationPlayer& player) {
    const double ahead_s = player.seconds_ahead(duration_s);
    if (!(ahead_s > 0)) return turntable(session, duration_s);
    const auto put = [&](double seconds) { player.look_ahead(seconds); };
    return turntable(session, duration_s, content_until(session.scene(), ahead_s, put));
}

void check_orbit_grid(int columns, int rows, double row_step_deg) {
    if (columns < 1 || columns > 360)
        throw ArgumentError(fmt::format("orbit: expected 1 to 360 columns, got {}", columns));
    if (rows < 1 || rows > 60) throw ArgumentError(fmt::format("orbit: expected 1 to 60 rows, got {}", rows));
    if (!(row_step_deg > 0) || (rows - 1) * row_step_deg > 160)
        throw ArgumentError(fmt::format(
            "orbit: expected a step above 0 and rows within 160 degrees, got {} rows {} degrees apart", rows,
            row_step_deg));
}

OrbitGrid orbit_grid(Session& session, int columns, int rows, double row_step_deg,
                     std::optional<Vec2i> size) {
    check_orbit_grid(columns, rows, row_step_deg);
    const Round round = round_of(session, size.value_or(session.settings().image.size));
    const double sine = round.content.axis.dot(round.camera.T_world_cam.linear().col(2));
    const double elevation = std::asin(std::clamp(sine, -1.0, 1.0)) * 180 / pi;
    OrbitGrid grid{columns, {}, -lowest_step(elevation, rows, row_step_deg), {}};
    std::vector<Camera> firsts;
    double reach = 0;
    for (int row = 0; row < rows; ++row) {
        const double up = (row - grid.start_row) * row_step_deg;
        grid.elevations_deg.push_back(elevation + up);
        firsts.push_back(raised(round, up));
        if (round.fits) reach = std::max(reach, reach_for(round, firsts.back()));
    }
    for (Camera& first : firsts) {
        if (round.fits) place_at(first, round, reach);
        const CameraPath path = CameraPath::orbit(first, round.content.center, round.content.axis, 360, 1);
        for (int column = 0; column < columns; ++column)
            grid.cameras.push_back(path.camera(double(column) / columns, first));
    }
    return grid;
}

}  // namespace easypbr::app
