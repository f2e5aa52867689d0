#include <algorithm>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::detail {
namespace {

/// Where a studio light stands as seen from the content: azimuth from the camera's side, positive to the
/// camera's right; and the irradiance (in the unit of the environment's radiance times steradian) it gives
/// there.
struct Placement {
    double azimuth_deg, elevation_deg, irradiance;
};

// Three-point lighting: a key at one side, a fill a quarter as strong opposite, a rim from behind. The soft
// boxes of the built-in studio fill and rim already.
constexpr Placement key_placement{-45, 40, 2.0};
constexpr Placement fill_placement{45, 20, 0.5};
constexpr Placement rim_placement{145, 45, 1.6};
/// Distance of the lights in radii of the content.
constexpr double light_distance = 3;
/// Radius of the lights, in radii of the content.
constexpr double studio_light_part = 0.3;

constexpr int meter_directions = 64;
const Vec3d luminance_weights(0.2126, 0.7152, 0.0722);

/// Horizontal direction from the content to the camera.
Vec3d level_direction(const Camera& camera, const Vec3d& up) {
    const auto level = [&](const Vec3d& v) { return Vec3d(v - up * up.dot(v)); };
    const Vec3d back = camera.T_world_cam.linear().col(2), top = camera.T_world_cam.linear().col(1);
    if (level(back).norm() > 1e-6) return level(back).normalized();
    // Straight down, the picture's bottom is the near side; straight up, its top.
    return level(back.dot(up) > 0 ? Vec3d(-top) : top).normalized();
}

Vec3d placed_direction(const Placement& placement, const Vec3d& level, const Vec3d& up) {
    const double azimuth = radians(placement.azimuth_deg), elevation = radians(placement.elevation_deg);
    return std::cos(elevation) * (std::cos(azimuth) * level + std::sin(azimuth) * up.cross(level)) +
           std::sin(elevation) * up;
}

/// What a light sends to a point: irradiance (luminance-weighted) on a surface facing it, and the direction
/// to it.
struct Incidence {
    Vec3d to_light;
    double irradiance;
};

Incidence incidence_at(const ResolvedLight& light, const Vec3d& point) {
    const double power = light.intensity * luminance_weights.dot(light.color.cast<double>());
    if (light.type == LightType::directional) return {-light.direction.cast<double>().normalized(), power};
    const Vec3d to_light = light.position - point;
    const double distance = to_light.norm();
    if (!(distance > 0)) return {Vec3d::Zero(), 0};
    const Vec3d direction = to_light / distance;
    return {direction, power * falloff(light, -direction, distance)};
}

/// Unit normal k of a fixed spiral over the hemisphere around +z, evenly spread (Fibonacci lattice).
Vec3d meter_normal(int k) {
    const double z = 1 - (k + 0.5) / meter_directions;
    const double angle = k * pi * (3 - std::sqrt(5.0)), radius = std::sqrt(1 - z * z);
    return Vec3d(radius * std::cos(angle), radius * std::sin(angle), z);
}

}  // namespace

std::vector<ResolvedLight> resolve_studio_lights(const Content& content, const Camera& camera,
                                                 bool key_by_default, LightsSettings& settings,
                                                 const Vec3d& up) {
    std::vector<ResolvedLight> lights;
    const auto add = [&](StudioLight& studio, const Placement& placement, bool on_by_default) {
        fill(studio.enabled, on_by_default);
        if (!studio.position.value() || !studio.intensity.value()) {
            const double distance = light_distance * content.radius();
            const Vec3d direction = placed_direction(placement, level_direction(camera, up), up);
            fill(studio.position, Vec3d(content.centre() + direction * distance));
            fill(studio.intensity, float(placement.irradiance * distance * distance));
        }
        if (!studio.radius.value()) fill(studio.radius, float(studio_light_part * content.radius()));
        if (!*studio.enabled) return;
        ResolvedLight light;
        light.position = *studio.position;
        light.color = linear_from_srgb(studio.color);
        light.intensity = *studio.intensity * settings.intensity;
        light.casts_shadows = studio.casts_shadows;
        light.radius = *studio.radius;
        lights.push_back(light);
    };
    add(settings.key, key_placement, key_by_default);
    add(settings.fill, fill_placement, false);
    add(settings.rim, rim_placement, false);
    return lights;
}

float metered_exposure(const Content& content, const ResolvedSettings& resolved,
                       float environment_intensity) {
    std::vector<Incidence> incidences;
    for (const ResolvedLight& light : resolved.lights)
        incidences.push_back(incidence_at(light, content.centre()));
    double sum = 0, weights = 0;
    for (int k = 0; k < meter_directions; ++k) {
        const Vec3d in_camera = meter_normal(k);
        const Vec3d normal = resolved.camera.T_world_cam.linear() * in_camera;
        double radiance = 0;
        if (!resolved.environment.empty()) {
            const Vec3 in_environment = resolved.R_env_world * normal.cast<float>();
            radiance =
                environment_intensity *
                luminance_weights.dot(resolved.environment.irradiance_over_pi(in_environment).cast<double>());
        }
        for (const Incidence& light : incidences)
            radiance += light.irradiance * std::max(0.0, normal.dot(light.to_light)) / pi;
        sum += radiance * in_camera.z();
        weights += in_camera.z();
    }
    return sum > 0 ? float(weights / sum) : 1.0f;
}

}  // namespace easypbr::detail
