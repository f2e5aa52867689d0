#include "easypbr/render/raytrace/ray_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/luminance.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/raytrace/hit_surfaces.h"
#include "easypbr/render/raytrace/ray_surface.h"
#include "easypbr/render/raytrace/sky_place.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// What rays see of a sky: its light is summed over many of them, so that details only make noise.
constexpr int widest_sky = 128;

Vec3 fresnel(const RaySurface& s, float n_dot_v) {
    const Vec3 grazing = s.f0.cwiseMax(s.f0.isZero() ? 0.0f : 1 - s.roughness);
    return s.f0 + (grazing - s.f0) * std::pow(1 - std::clamp(n_dot_v, 0.0f, 1.0f), 5.0f);
}

RaySurface ground_surface(const RayGround& ground, float dielectric_f0) {
    RaySurface s;
    s.diffuse = ground.color;
    s.f0.setConstant(dielectric_f0);
    s.normal = ground.up.cast<float>();
    s.roughness = ground.roughness;
    return s;
}

/// A point of an area light, seen from a place.
struct AreaPoint {
    Vec3 direction{0, 0, 0};  ///< unit
    double distance = 0;      ///< world units
    double solid_angle = 0;   ///< that the point stands for; 0: it sends nothing there
};

/// Of a sphere one in the cone in which it is seen, else one of its area.
AreaPoint area_point(const ResolvedLight& light, const Vec3d& place, const Vec2& u) {
    const Vec3d centre = light.position - place;
    const double phi = 2 * pi * double(u.y());
    if (light.type == LightType::sphere) {
        const double r2 = double(light.radius) * double(light.radius), d2 = centre.squaredNorm();
        if (!(d2 > r2)) return {};
        const double sine2 = r2 / d2, open = sine2 / (1 + std::sqrt(1 - sine2));
        const double c = 1 - double(u.x()) * open, s = std::sqrt(std::max(0.0, 1 - c * c));
        const RayFrame frame(centre.normalized().cast<float>());
        const Vec3 direction = frame.to_world(Vec3d(s * std::cos(phi), s * std::sin(phi), c).cast<float>());
        return {direction, std::sqrt(d2) * c - std::sqrt(std::max(0.0, r2 - d2 * s * s)), 2 * pi * open};
    }
    const EmitterAxes axes = emitter_axes(light);
    const Vec2d at = light.type == LightType::disc
                         ? Vec2d(std::sqrt(double(u.x())) * Vec2d(std::cos(phi), std::sin(phi)))
                         : Vec2d(2 * u.cast<double>() - Vec2d(1, 1));
    const Vec3d way = centre + axes.x * at.x() + axes.y * at.y();
    const double distance = way.norm(),
                 cosine = -way.dot(light.direction.cast<double>().normalized()) / distance;
    if (!(cosine > 0)) return {};
    return {(way / distance).cast<float>(), distance, emitting_area(light) * cosine / (distance * distance)};
}

bool has_areas(const ResolvedSettings& resolved) {
    return std::ranges::any_of(resolved.lights,
                               [](const ResolvedLight& light) { return is_area(light.type); });
}

/// Irradiance of area lights, divided by pi, by a point of each; `all`: if nothing stood in the way.
Vec3 from_areas(const ResolvedSettings& resolved, const RayScene& scene, const RayHit& hit,
                const Vec3& normal, const Vec2& u, Vec3* all = nullptr) {
    // Rays to a point of an emitter end before it by this part of their length.
    constexpr double before_emitter = 1e-4;
    Vec3 sum = Vec3::Zero();
    const Vec3d place = hit.position.cast<double>() * scene.unit() + scene.centre();
    const Vec3 from = scene.start_at(hit, normal);
    for (const ResolvedLight& light : resolved.lights) {
        if (!is_area(light.type)) continue;
        const AreaPoint point = area_point(light, place, u);
        const double cosine = double(normal.dot(point.direction));
        if (!(point.solid_angle > 0) || cosine <= 0) continue;
        const Vec3 sent = light.color * float(double(light.intensity) * cosine * point.solid_angle / pi);
        if (all) *all += sent;
        const auto reach = float(point.distance * (1 - before_emitter) / scene.unit());
        if (light.casts_shadows && resolved.settings.shadows.enabled &&
            scene.blocked(from, point.direction, reach))
            continue;
        sum += sent;
    }
    return sum;
}

}  // namespace

void RayLight::prepare(const ResolvedSettings& resolved, const RayScene& scene) {
    resolved_ = &resolved;
    scene_ = &scene;
    background_ = background_radiance(resolved);
    if (hash_ == resolved.environment.hash()) return;
    hash_.clear();  // until all is there: it can be interrupted
    sky_ = resolved.environment.image();
    while (sky_.width() > widest_sky) sky_ = half_size(sky_);
    bright_.prepare(sky_);
    hash_ = resolved.environment.hash();
}

Vec3 RayLight::sky(const Vec3& direction) const {
    const Vec2i at = pixel_at(sky_place(resolved_->R_env_world * direction), {sky_.width(), sky_.height()});
    const float* p = sky_.at<float>(at.x(), at.y());
    return resolved_->settings.environment.intensity * Vec3(p[0], p[1], p[2]);
}

Vec3 RayLight::even_sky(const Vec3& normal) const {
    return resolved_->settings.environment.intensity *
           resolved_->environment.irradiance_over_pi(resolved_->R_env_world * normal);
}

float RayLight::bright_density(const Vec3& direction) const {
    return bright_.texel(sky_place(resolved_->R_env_world * direction)).w();
}

Vec3 RayLight::bright_direction(const Vec2& u) const {
    return resolved_->R_env_world.transpose() * bright_.sample(u).direction();
}

RayLight::Light RayLight::from_lights(const RayHit& hit, const Vec3& normal) const {
    const Vec3& at = hit.position;
    Light sum;
    const auto unit = float(scene_->unit());
    for (const ResolvedLight& light : resolved_->lights) {
        if (is_area(light.type)) continue;
        const bool parallel = light.type == LightType::directional;
        const Vec3 towards = parallel ? Vec3(-light.direction.normalized())
                                      : Vec3((light.position - scene_->centre()).cast<float>() / unit - at);
        const float distance = towards.norm();
        if (!(distance > 0)) continue;
        const Vec3 l = towards / distance;
        const float cosine = normal.dot(l), world = distance * unit;
        if (cosine <= 0) continue;
        const float falls = parallel ? 1.0f : float(falloff(light, -l.cast<double>(), double(world)));
        if (falls <= 0) continue;
        const Vec3 sent = light.color * (light.intensity * falls * cosine / float(pi));
        sum.all += sent;
        const float reach = parallel ? std::numeric_limits<float>::infinity() : distance;
        if (light.casts_shadows && resolved_->settings.shadows.enabled &&
            scene_->blocked(scene_->start_at(hit, normal), l, reach))
            continue;
        sum.arrives += sent;
    }
    return sum;
}

Vec3 RayLight::open_sky(const RayHit& hit, RayRandom& random) const {
    const Vec3 chosen = random.next();
    const Vec2 u = chosen.tail<2>();
    const float bright = bright_part();
    const Vec3 direction =
        chosen.x() < bright ? bright_direction(u) : cosine_direction(RayFrame(hit.normal), u);
    const float matt = hit.normal.dot(direction) / float(pi);
    if (!(matt > 0)) return Vec3::Zero();
    if (scene_->blocked(scene_->start_at(hit, hit.normal), direction, std::numeric_limits<float>::infinity()))
        return Vec3::Zero();
    return sky(direction) * (matt / (bright * bright_density(direction) + (1 - bright) * matt));
}

Vec3 RayLight::caught(const RayHit& hit, const Vec3& direction, bool scattered, RayRandom& random) const {
    Light light = from_lights(hit, hit.normal);
    if (has_areas(*resolved_))
        light.arrives +=
            from_areas(*resolved_, *scene_, hit, hit.normal, random.next().tail<2>(), &light.all);
    light.all += even_sky(hit.normal);
    // Never less than none, which a pixel could not keep.
    light.arrives += open_sky(hit, random);
    const float all = luminance(light.all), hidden = all > 0 ? 1 - luminance(light.arrives) / all : 0;
    const float shown = 1 - resolved_->settings.ground.shadow_strength * hidden;
    return (background_ && !scattered ? *background_ : sky(direction)) * shown;
}

Vec3 RayLight::radiance(const RayHit& first, const Vec3& along, bool scattered, RayRandom& random) const {
    Vec3 sum = Vec3::Zero(), weight = Vec3::Ones(), direction = along;
    RayHit hit = first;
    const bool with_areas = has_areas(*resolved_);
    for (int bounce = 0; bounce < bounces; ++bounce) {
        if (!hit.item && scene_->ground()->shadow_catcher)
            return sum + weight.cwiseProduct(caught(hit, direction, scattered, random));
        const float dielectric = resolved_->settings.shading.dielectric_f0;
        if (hit.item && hit.item->style.mode == DrawMode::splats)
            return sum + weight.cwiseProduct(emission_at(*scene_, hit));
        const RaySurface s = hit.item ? surface_at(hit, dielectric, resolved_->exposure)
                                      : ground_surface(*scene_->ground(), dielectric);
        const Vec3 reflects = fresnel(s, -direction.dot(s.normal));
        const Vec3 diffuse = s.diffuse.cwiseProduct(Vec3::Ones() - reflects);
        Vec3 lit = from_lights(hit, s.normal).arrives;
        if (with_areas) lit += from_areas(*resolved_, *scene_, hit, s.normal, random.next().tail<2>());
        sum += weight.cwiseProduct(s.emission + diffuse.cwiseProduct(lit));
        const float mirrors = reflects.mean(), scatters = diffuse.mean();
        if (!(mirrors + scatters > 0)) break;
        // One way goes on, as likely as it brings light.
        const float likely = mirrors / (mirrors + scatters);
        const RayFrame frame(s.normal);
        const Vec3 chosen = random.next();
        const Vec2 u = chosen.tail<2>();
        const bool mirrored = chosen.x() < likely;
        const Vec3 next =
            mirrored ? mirrored_direction(frame, -direction, s.roughness * s.roughness, u).normalized()
                     : cosine_direction(frame, u);
        if (next.dot(hit.normal) <= 0) break;
        weight = weight.cwiseProduct(mirrored ? Vec3(reflects / likely) : Vec3(diffuse / (1 - likely)));
        const auto found = scene_->trace(scene_->start_at(hit, hit.normal), next);
        // What is seen past a matt surface is blurred, so that few paths do: the sky's mean around a
        // direction.
        const bool blurred = scattered || !mirrored;
        if (!found)
            return sum + weight.cwiseProduct(blurred ? even_sky(mirrored ? next : s.normal) : sky(next));
        scattered = blurred;
        hit = *found;
        direction = next;
    }
    return sum;
}

}  // namespace easypbr::render
