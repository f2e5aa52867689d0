#include <algorithm>
#include <cmath>
#include <mutex>

#include "easypbr/core/parallel.h"
#include "easypbr/core/triangle.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/world_elements.h"

namespace easypbr::detail {
namespace {

/// Radius of a light that says nothing, in radii of the content.
constexpr double plain_light_part = 0.05;
/// The same at most, of the way to the nearest surface: all of the emitter is clear of it.
constexpr double clear_part = 0.5;
/// Elements that have a box in common.
constexpr size_t elements_per_box = 4096;

/// Shortens the ways from places to elements `begin` to `end`, which reach farther than their corners say.
void shorten(const WorldElements& elements, size_t begin, size_t end, double reach,
             const std::vector<Vec3d>& places, std::vector<double>& ways) {
    std::vector<WorldElements::Corners> all;
    Box3d box;
    for (size_t i = begin; i < end; ++i) {
        const WorldElements::Corners corners = elements.corners(i);
        if (!are_finite(corners)) continue;
        for (const Vec3d& corner : corners) box.extend(corner);
        all.push_back(corners);
    }
    if (all.empty()) return;
    for (size_t k = 0; k < places.size(); ++k) {
        if (std::sqrt(box.squaredExteriorDistance(places[k])) - reach >= ways[k]) continue;
        for (const auto& [a, b, c] : all) {
            const double way = (nearest_on_triangle(places[k], a, b, c) - places[k]).norm() - reach;
            ways[k] = std::min(ways[k], std::max(way, 0.0));
        }
    }
}

/// How far surfaces are from places: `farthest` where there is none within it.
std::vector<double> clear_ways(const SceneSnapshot& scene, const std::vector<Vec3d>& places,
                               double farthest) {
    std::vector<double> ways(places.size(), farthest);
    std::mutex mutex;
    for (const SceneSnapshot::Object& object : scene.objects) {
        const WorldElements elements(object);
        const double reach = object.point_radius + object.half_voxel * object.T_world_mesh.linear().norm();
        parallel_chunks(elements.count(), elements_per_box, [&](size_t begin, size_t end) {
            std::vector<double> own(places.size(), farthest);
            shorten(elements, begin, end, reach, places, own);
            const std::lock_guard lock(mutex);
            for (size_t k = 0; k < ways.size(); ++k) ways[k] = std::min(ways[k], own[k]);
        });
    }
    return ways;
}

}  // namespace

double clear_way(const Content& content, const Vec3d& place, double farthest) {
    return clear_ways(content.scene(), {place}, farthest).front();
}

std::vector<float> plain_light_radii(const Content& content, const std::vector<Light>& lights) {
    if (lights.empty()) return {};
    const double most = plain_light_part * content.radius(), farthest = most / clear_part;
    std::vector<float> radii(lights.size(), float(most));
    std::vector<Vec3d> places;
    std::vector<size_t> indices;
    for (size_t i = 0; i < lights.size(); ++i) {
        if (is_area(lights[i].type) || content.bounds().isEmpty()) continue;
        if (content.bounds().squaredExteriorDistance(lights[i].position) >= farthest * farthest) continue;
        places.push_back(lights[i].position);
        indices.push_back(i);
    }
    if (places.empty()) return radii;
    const std::vector<double> ways = clear_ways(content.scene(), places, farthest);
    for (size_t k = 0; k < ways.size(); ++k) radii[indices[k]] = float(clear_part * ways[k]);
    return radii;
}

}  // namespace easypbr::detail
