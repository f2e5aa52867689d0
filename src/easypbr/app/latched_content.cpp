#include "easypbr/app/latched_content.h"

#include <algorithm>
#include <limits>

#include "easypbr/scene/auto_parameters.h"

namespace easypbr::app {
namespace {

/// Content that reaches less far out of the old bounds, as a part of their diagonal, does not count as
/// larger.
constexpr double slack = 0.01;

bool is_larger(const Box3d& now, const Box3d& before) {
    if (now.isEmpty()) return false;
    const Vec3d margin = Vec3d::Constant(slack * before.diagonal().norm());
    return !Box3d(Vec3d(before.min() - margin), Vec3d(before.max() + margin)).contains(now);
}

}  // namespace

std::vector<LatchedContent::Placed> LatchedContent::placed(const SceneSnapshot& scene) {
    std::vector<Placed> all;
    all.reserve(scene.objects.size());
    for (const SceneSnapshot::Object& object : scene.objects)
        all.push_back({object.mesh->V.revision(), object.T_world_mesh.matrix(), object.half_voxel,
                       object.point_radius});
    return all;
}

bool LatchedContent::has_new_names(const SceneSnapshot& scene) const {
    return std::ranges::any_of(scene.objects,
                               [&](const auto& object) { return !names_.contains(object.name); });
}

bool LatchedContent::release_outgrown(const SceneSnapshot& scene, Settings& settings) {
    if (names_.empty() || !has_new_names(scene) || !is_larger(scene.bounds(), bounds_)) return false;
    release(settings);
    names_.clear();
    return true;
}

LatchedContent::AnnotationAsked LatchedContent::asked(const BasicAnnotationSettings<Inferred>& annotation) {
    if (annotation.legend || annotation.colorbar) return annotation;
    return {};
}

void LatchedContent::release_camera(Settings& settings) const {
    const AnnotationSettings& now = settings.annotation;
    CameraSettings& camera = settings.camera;
    if (names_.empty() || !camera.pose.empty() || camera.position.is_pinned()) return;
    if (annotation_ == asked({now.legend.value_or(false), now.colorbar.value_or(false), now.title, now.corner,
                              now.text_size}))
        return;
    camera.position.release();
    camera.target.release();
    camera.ortho_height.release();
    camera.near.release();
}

void LatchedContent::follow(const SceneSnapshot& scene, const Settings& settings,
                            ResolvedSettings& resolved) {
    if (std::vector<Placed> now = placed(scene); now != placed_) {
        placed_ = std::move(now);
        placed_bounds_ = scene.bounds();
    }
    lower_ground(settings, resolved);
    bring_near_plane(settings, resolved);
}

void LatchedContent::lower_ground(const Settings& settings, ResolvedSettings& resolved) const {
    const auto& given = settings.ground.height;
    auto& ground = resolved.settings.ground;
    if (ground.mode == GroundMode::none || given.is_pinned() || !given.value() || placed_bounds_.isEmpty())
        return;
    ground.height =
        std::min(ground.height, detail::ground_below(placed_bounds_, parse_up(resolved.settings.camera.up)));
}

void LatchedContent::bring_near_plane(const Settings& settings, ResolvedSettings& resolved) {
    const auto& given = settings.camera.near;
    Camera& camera = resolved.camera;
    if (!given.value()) {
        near_placed_ = placed_;
        near_T_world_cam_ = camera.T_world_cam.matrix();
    }
    const bool is_unmoved = placed_ == near_placed_ && camera.T_world_cam.matrix() == near_T_world_cam_;
    if (given.is_pinned() || is_unmoved || placed_bounds_.isEmpty()) return;
    const Vec3d forward = -camera.T_world_cam.linear().col(2);
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i)
        nearest =
            std::min(nearest, forward.dot(placed_bounds_.corner(Box3d::CornerType(i)) - camera.position()));
    const double distance = (resolved.settings.camera.target - resolved.settings.camera.position).norm();
    camera.near = std::min(camera.near, detail::near_plane(nearest, distance));
    camera.far = std::max(camera.far, 2 * camera.near);
    resolved.settings.camera.near = camera.near;
}

void LatchedContent::keep(const SceneSnapshot& scene, const BasicAnnotationSettings<Inferred>& annotation) {
    annotation_ = asked(annotation);
    if (!names_.empty() && !has_new_names(scene)) return;
    bounds_ = scene.bounds();
    for (const SceneSnapshot::Object& object : scene.objects) names_.insert(object.name);
}

}  // namespace easypbr::app
