#include <algorithm>
#include <array>
#include <cmath>

#include "easypbr/core/color.h"
#include "easypbr/scene/auto_parameters.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"
#include "easypbr/scene/world_elements.h"

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

// Of the key in closed content.
/// Its way from the camera, of the distance of what is seen.
constexpr double headlight_part = 0.2;
/// The same, of the way to the nearest surface, at most.
constexpr double headlight_clear_part = 0.5;
/// Its radius, of its way from the camera.
constexpr double headlight_radius_part = 0.5;
/// The reflectance that walls of closed content are taken to have: that of the default material.
constexpr double wall_reflectance = 0.6;
/// What the meter sees in closed content, of what it sees of the lights alone. Those give walls the
/// irradiance E, which is metered as 2 E / (3 pi); walls send back the radiance E r / (1 - r) / pi from all
/// sides.
constexpr double interreflection = 1 + 1.5 * wall_reflectance / (1 - wall_reflectance);

/// Faces of a material that are looked at for what they emit: of more, every n-th stands for n.
constexpr size_t most_emitters = 4096;

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

/// Adds what faces of a radiance send to a place: those of the sides, front or back, that send more.
void add_emitted(const WorldElements& faces, size_t begin, size_t end, double radiance, const Vec3d& place,
                 std::vector<Incidence>& lights) {
    const size_t step = std::max<size_t>(1, (end - begin + most_emitters - 1) / most_emitters);
    std::array<std::vector<Incidence>, 2> sides;
    std::array<double, 2> sums{};
    for (size_t i = begin; i < end; i += step) {
        const auto [a, b, c] = faces.corners(i);
        const Vec3d way = (a + b + c) / 3 - place, normal = (b - a).cross(c - a).normalized();
        const double area = double(step) * (b - a).cross(c - a).norm() / 2, distance = way.norm();
        if (!(area > 0 && distance > 0)) continue;
        // As of a disc of the area, which stays finite where the place is near.
        const double cosine = normal.dot(way) / distance;
        const double irradiance = radiance * area * std::abs(cosine) / (area / pi + distance * distance);
        const size_t side = cosine < 0 ? 0 : 1;
        sides[side].push_back({way / distance, irradiance});
        sums[side] += irradiance;
    }
    const std::vector<Incidence>& shown = sides[sums[0] < sums[1] ? 1 : 0];
    lights.insert(lights.end(), shown.begin(), shown.end());
}

/// What faces that emit send to a place, as if nothing stood between; without those of emissive textures.
std::vector<Incidence> emitted_to(const Content& content, const Vec3d& place) {
    std::vector<Incidence> lights;
    for (const SceneSnapshot::Object& object : content.scene().objects) {
        const WorldElements faces(object);
        for_each_material(*object.mesh, content.overrides(),
                          [&](const Material& material, size_t begin, size_t end) {
                              const double radiance = luminance_weights.dot(material.emissive.cast<double>());
                              if (radiance > 0 && !material.emissive_texture)
                                  add_emitted(faces, begin, end, radiance, place, lights);
                          });
    }
    return lights;
}

/// What a white diffuse surface reflects of a light, by its unit normal.
double reflected(const Incidence& light, const Vec3d& normal) {
    return light.irradiance * std::max(0.0, normal.dot(light.to_light)) / pi;
}

/// The mean of a function of normals over those that face the camera, weighted by the cosine.
template <class Radiance>
double metered(const Camera& camera, const Radiance& radiance) {
    double sum = 0, weights = 0;
    for (int k = 0; k < meter_directions; ++k) {
        const Vec3d in_camera = meter_normal(k);
        sum += radiance(Vec3d(camera.T_world_cam.linear() * in_camera)) * in_camera.z();
        weights += in_camera.z();
    }
    return sum / weights;
}

double metered(const Camera& camera, const std::vector<Incidence>& lights) {
    return metered(camera, [&](const Vec3d& normal) {
        double radiance = 0;
        for (const Incidence& light : lights) radiance += reflected(light, normal);
        return radiance;
    });
}

/// What an automatic studio light is.
struct Placed {
    Vec3d position;
    float intensity, radius;
};

Placed placed_around(const Stage& stage, const Placement& placement, const Vec3d& up) {
    const Content& content = stage.content;
    const double distance = light_distance * content.radius();
    const Vec3d direction = placed_direction(placement, level_direction(stage.camera, up), up);
    return {content.centre() + direction * distance, float(placement.irradiance * distance * distance),
            float(studio_light_part * content.radius())};
}

/// The key in closed content: to the upper left of the camera, as near as surfaces demand, and at least as
/// bright as what emits.
Placed headlight(const Stage& stage, const Enclosure& enclosure) {
    // Irradiance E from the camera's side is metered as 2 E / (3 pi).
    const double emitted = metered(stage.camera, emitted_to(stage.content, enclosure.viewed)) * 1.5 * pi;
    const double aside =
        std::min(headlight_part * enclosure.distance, headlight_clear_part * enclosure.clear);
    const Mat3d axes = stage.camera.T_world_cam.linear();
    const Vec3d position = stage.camera.position() + aside * std::sqrt(0.5) * (axes.col(1) - axes.col(0));
    const double irradiance = std::max(key_placement.irradiance, emitted);
    return {position, float(irradiance * (position - enclosure.viewed).squaredNorm()),
            float(headlight_radius_part * aside)};
}

}  // namespace

std::vector<ResolvedLight> resolve_studio_lights(const Stage& stage, bool key_by_default,
                                                 LightsSettings& settings, const Vec3d& up) {
    std::vector<ResolvedLight> lights;
    const auto add = [&](StudioLight& studio, bool on_by_default, const auto& place) {
        fill(studio.enabled, on_by_default);
        if (!studio.position.value() || !studio.intensity.value() || !studio.radius.value()) {
            const Placed placed = place();
            fill(studio.position, placed.position);
            fill(studio.intensity, placed.intensity);
            fill(studio.radius, placed.radius);
        }
        if (!*studio.enabled) return;
        ResolvedLight light;
        light.position = *studio.position;
        light.color = linear_from_srgb(studio.color);
        light.intensity = *studio.intensity * settings.intensity;
        light.casts_shadows = studio.casts_shadows;
        light.radius = *studio.radius;
        lights.push_back(light);
    };
    const auto around = [&](const Placement& placement) {
        return [&] { return placed_around(stage, placement, up); };
    };
    add(settings.key, key_by_default, [&] {
        return stage.enclosure ? headlight(stage, *stage.enclosure) : placed_around(stage, key_placement, up);
    });
    add(settings.fill, false, around(fill_placement));
    add(settings.rim, false, around(rim_placement));
    return lights;
}

float metered_exposure(const Stage& stage, const ResolvedSettings& resolved, float environment_intensity) {
    const std::optional<Enclosure>& enclosure = stage.enclosure;
    const Vec3d place = enclosure ? enclosure->viewed : stage.content.centre();
    std::vector<Incidence> lights;
    for (const ResolvedLight& light : resolved.lights) lights.push_back(incidence_at(light, place));
    const bool has_sky = !resolved.environment.empty() && !enclosure;
    if (enclosure || (lights.empty() && !has_sky)) {
        const std::vector<Incidence> emitted = emitted_to(stage.content, place);
        lights.insert(lights.end(), emitted.begin(), emitted.end());
    }
    double radiance = metered(stage.camera, lights);
    if (enclosure) radiance *= interreflection;
    if (has_sky)
        radiance += environment_intensity * metered(stage.camera, [&](const Vec3d& normal) {
                        const Vec3 in_environment = resolved.R_env_world * normal.cast<float>();
                        const Vec3 sent_back = resolved.environment.irradiance_over_pi(in_environment);
                        return luminance_weights.dot(sent_back.cast<double>());
                    });
    return radiance > 0 ? float(1 / radiance) : 1.0f;
}

}  // namespace easypbr::detail
