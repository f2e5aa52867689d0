#include "easypbr/render/raytrace/received_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/core/hash.h"
#include "easypbr/render/raytrace/ray_random.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Rays into the sky, and to a lamp that has an extent.
constexpr int sky_rays = 8, lamp_rays = 4;
/// Less than this part of the sky's light is not looked for.
constexpr double least_hidden = 1.0 / 512;
constexpr double turn = 2.39996322972865332;  // the golden angle

double brightness_of(const Vec3d& c) {
    return c.dot(Vec3d(0.2126, 0.7152, 0.0722));
}

/// Point `i` of `count` of the unit square, evenly spread, of a sequence that belongs to a number.
Vec2 spread(int i, int count, uint32_t number) {
    const double phi = double(unit_number(pcg_hash(number))) + i * turn / (2 * pi);
    return {(float(i) + unit_number(pcg_hash(number ^ 0x9e3779b9u))) / float(count),
            float(phi - std::floor(phi))};
}

/// What softens a lamp's shadows: the radius of the disc that it is seen as, or the tangent of a directional
/// light's.
double softness_of(const ResolvedLight& light) {
    if (light.type == LightType::directional) return std::tan(radians(light.angular_radius_deg));
    if (light.type == LightType::rectangle) return std::sqrt(emitting_area(light) / pi);
    return double(light.radius);
}

Box3d bounds_of_surfaces(const DrawList& surfaces, const Primitives& primitives) {
    Box3d bounds;
    for (const auto& kind : primitives)
        for (const DrawItem& item : surfaces.of(kind->mode())) {
            const MeshData& mesh = item.mesh();
            if (mesh.V.empty()) continue;
            const Vec3d low = mesh.V.colwise().minCoeff().transpose().cast<double>(),
                        high = mesh.V.colwise().maxCoeff().transpose().cast<double>();
            const Box3d own = Box3d(low, high).transformed(item.object->T_world_mesh);
            const Vec3d reach = Vec3d::Constant(kind->reach(item));
            bounds.extend(Box3d(own.min() - reach, own.max() + reach));
        }
    return bounds;
}

}  // namespace

void ReceivedLight::update(const Frame& frame, const Surfaces& surfaces) {
    resolved_ = frame.resolved;
    std::vector<float> sky = {resolved_->settings.environment.intensity,
                              resolved_->settings.shadows.enabled ? 1.0f : 0.0f,
                              surfaces.hide_sky ? 1.0f : 0.0f};
    sky.insert(sky.end(), resolved_->R_env_world.data(), resolved_->R_env_world.data() + 9);
    const std::string environment = resolved_->environment.empty() ? "" : resolved_->environment.hash();
    const uint64_t casters = surfaces.list.empty() ? 0 : surfaces.generation;
    const bool same_casters = casters == casters_ && generation_ != 0;
    if (!same_casters) bounds_ = bounds_of_surfaces(surfaces.list, surfaces.primitives);
    scene_.update(surfaces.list, bounds_, casters, surfaces.primitives, std::nullopt);
    hides_sky_ = surfaces.hide_sky;
    if (same_casters && lights_ == resolved_->lights && sky == sky_ && environment == environment_) return;
    casters_ = casters;
    lights_ = resolved_->lights;
    sky_ = std::move(sky);
    environment_ = environment;
    generation_ = next_revision();
}

double ReceivedLight::left(const Place& place, const Vec3& direction, double distance) const {
    const Vec3 from = RayScene::off_surface(place.at, place.normal);
    return brightness_of(scene_.transmittance(from, direction, float(distance)).cast<double>());
}

ReceivedLight::Sum ReceivedLight::from_lamp(const ResolvedLight& light, const Place& place) const {
    const bool parallel = light.type == LightType::directional;
    const Vec3d towards =
        parallel ? Vec3d(-light.direction.cast<double>()) : Vec3d(light.position - place.world);
    const double distance = towards.norm();
    if (!(distance > 0)) return {};
    const Vec3d l = towards / distance;
    const double cosine = l.dot(place.normal.cast<double>());
    if (cosine <= 0) return {};
    const double falls = parallel ? 1 : falloff(light, -l, distance);
    const Vec3d all = light.color.cast<double>() * (double(light.intensity) * falls * cosine / pi);
    if (!(brightness_of(all) > 0)) return {};
    if (scene_.empty() || !light.casts_shadows || !resolved_->settings.shadows.enabled) return {all, all};
    const double extent = softness_of(light);
    const int rays = extent > 0 ? lamp_rays : 1;
    const RayFrame frame(l.cast<float>());
    double open = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec2 u = spread(i, rays, place.number);
        const double r = rays > 1 ? extent * std::sqrt(double(u.x())) : 0, phi = 2 * pi * double(u.y());
        const Vec3d aside = r * (std::cos(phi) * frame.t + std::sin(phi) * frame.b).cast<double>();
        const Vec3d way = parallel ? Vec3d(l + aside) : Vec3d(towards + aside);
        const double reach =
            parallel ? std::numeric_limits<double>::infinity() : way.norm() / scene_.unit() * (1 - 1e-4);
        open += left(place, way.normalized().cast<float>(), reach);
    }
    return {all, all * (open / rays)};
}

double ReceivedLight::hidden_sky(const Place& place) const {
    const Vec3 towards = -place.at;
    const float distance = towards.norm();
    const bool around = distance <= 1;
    // The directions of the ball around the casters, which is the unit of the rays' frame, or all of them.
    const double sine = around ? 1 : double(1 / distance),
                 open = around ? 1 : 1 - std::sqrt(std::max(0.0, 1 - sine * sine));
    const RayFrame frame(around ? place.normal : Vec3(towards / distance));
    if (!around) {
        // The most that the ball may hide: its cap, as if it stood straight above.
        const double above = double(frame.n.dot(place.normal)) + sine;
        if (above <= 0 || 2 * open < least_hidden) return 0;
    }
    double hidden = 0;
    for (int i = 0; i < sky_rays; ++i) {
        const Vec2 u = spread(i, sky_rays, place.number);
        Vec3 direction;
        double weight = 1;
        if (around) {
            direction = cosine_direction(frame, u);
        } else {
            const double c = 1 - double(u.x()) * open, s = std::sqrt(std::max(0.0, 1 - c * c)),
                         phi = 2 * pi * double(u.y());
            direction = frame.to_world(Vec3d(s * std::cos(phi), s * std::sin(phi), c).cast<float>());
            weight = 2 * open * std::max(0.0, double(direction.dot(place.normal)));
        }
        if (weight > 0)
            hidden += weight * (1 - left(place, direction, std::numeric_limits<double>::infinity()));
    }
    return std::min(1.0, hidden / sky_rays);
}

ReceivedLight::Sum ReceivedLight::from_sky(const Place& place) const {
    if (resolved_->environment.empty()) return {};
    const Vec3 sky = resolved_->settings.environment.intensity *
                     resolved_->environment.irradiance_over_pi(resolved_->R_env_world * place.normal);
    const Vec3d all = sky.cast<double>();
    const bool is_hidden = hides_sky_ && !scene_.empty() && brightness_of(all) > 0;
    return {all, is_hidden ? Vec3d(all * (1 - hidden_sky(place))) : all};
}

ReceivedLight::Sum ReceivedLight::from_all(const Vec3d& place, const Vec3d& normal, uint32_t number) const {
    const Place at{place, ((place - scene_.centre()) / scene_.unit()).cast<float>(), normal.cast<float>(),
                   pcg_hash(number)};
    Sum sum = from_sky(at);
    for (const ResolvedLight& light : lights_) {
        const Sum own = from_lamp(light, at);
        sum.all += own.all;
        sum.arrives += own.arrives;
    }
    return sum;
}

float ReceivedLight::part_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const {
    if (scene_.empty()) return 1;
    const Sum sum = from_all(place, normal, number);
    const double all = brightness_of(sum.all);
    return all > 0 ? float(brightness_of(sum.arrives) / all) : 1.0f;
}

Vec3 ReceivedLight::light_at(const Vec3d& place, const Vec3d& normal, uint32_t number) const {
    return from_all(place, normal, number).arrives.cast<float>();
}

}  // namespace easypbr::render
