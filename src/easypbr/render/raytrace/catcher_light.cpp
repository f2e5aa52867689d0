#include "easypbr/render/raytrace/catcher_light.h"

#include <cmath>
#include <limits>

#include "easypbr/core/luminance.h"

namespace easypbr::render {
namespace {

/// From this distance on the casters are seen within a cone; of 113 degrees there.
constexpr float nearest_cone = 1.2f;
/// Of the directions in which hidden light is looked for: those of the sky's bright parts.
constexpr float sky_part = 0.5f;
constexpr float no_end = std::numeric_limits<float>::infinity();

using enum PathSampler::Dimension;

}  // namespace

/// All directions in which a ball is seen from a place outside of it, evenly.
struct CatcherLight::Cone {
    /// `way`: to its middle.
    Cone(const Vec3& way, float radius) : frame(way.normalized()) {
        const float sine2 = radius * radius / way.squaredNorm();
        open = sine2 / (1 + std::sqrt(1 - sine2));
    }

    Vec3 at(const Vec2& u) const {
        const float low = u.x() * open, r = std::sqrt(low * (2 - low)), phi = float(2 * pi) * u.y();
        return frame.to_world({r * std::cos(phi), r * std::sin(phi), 1 - low});
    }
    /// Per steradian.
    float density() const { return 1 / (float(2 * pi) * open); }

    RayFrame frame;
    float open;  ///< one minus the cosine of half the angle
};

/// Where a path looks for light of the sky.
struct CatcherLight::SkyPoint {
    size_t path = 0;
    Vec2 u{0, 0};
    bool sees_cone = false;
    bool is_chosen = false;  ///< a direction of the sky's bright parts
    SkySampler::Sample sky;  ///< in it
};

void CatcherLight::prepare(const RayScene& scene, const PathLights& lights, const SkySampler& sky) {
    scene_ = &scene;
    lights_ = &lights;
    sky_ = &sky;
    const std::optional<RayGround>& ground = scene.ground();
    sky_light_ = ground && ground->shadow_catcher ? sky.light_on(ground->up.cast<float>()) : 0;
}

float CatcherLight::distance_of(const Vec3& place) const {
    const RayScene::Ball& ball = scene_->ball();
    return ball.radius > 0 ? (place - ball.centre).norm() / ball.radius : no_end;
}

Vec3 CatcherLight::start_of(const PathBatch& batch, size_t path) const {
    const Vec3 off_view = RayScene::off_surface(batch.position.at(path), batch.view.at(path));
    return RayScene::off_surface(off_view, batch.face.at(path), scene_->reach());
}

bool CatcherLight::is_hidden(const PathBatch& batch, size_t path, const Vec3& direction,
                             float distance) const {
    return scene_->blocked(start_of(batch, path), direction, distance);
}

void CatcherLight::add_hidden_sky(const PathBatch& batch, const SkyPoint& point, CaughtLight& to) const {
    const RayScene::Ball& ball = scene_->ball();
    to.all += sky_light_;
    to.arrives += sky_light_;
    if (!(ball.radius > 0)) return;
    const Vec3 place = batch.position.at(point.path);
    const Cone cone(ball.centre - place, ball.radius);
    const float of_sky = sky_->is_sampled() ? sky_part : 0;
    if (point.is_chosen && !ball.is_met(place, point.sky.direction)) return;
    const SkySampler::Sample sky = point.is_chosen ? point.sky : sky_->seen(cone.at(point.u), cone.density());
    const float cosine = batch.normal.at(point.path).dot(sky.direction);
    if (!(cosine > 0)) return;
    const float density = of_sky * sky.density + (1 - of_sky) * cone.density();
    const float light = luminance(sky.radiance) * cosine / (float(pi) * density);
    if (light > 0 && is_hidden(batch, point.path, sky.direction, no_end)) to.arrives -= light;
}

void CatcherLight::add_sky(const PathBatch& batch, const SkyPoint& point, CaughtLight& to) const {
    const Vec3 normal = batch.normal.at(point.path);
    const auto add = [&](const Vec3& direction, float light, float distance) {
        if (!(light > 0)) return;
        to.all += light;
        if (distance < 0 || !is_hidden(batch, point.path, direction, distance)) to.arrives += light;
    };
    if (point.is_chosen) {
        const float matt = normal.dot(point.sky.direction) / float(pi);
        if (matt > 0)
            add(point.sky.direction, luminance(point.sky.radiance) * matt / (point.sky.density + matt),
                no_end);
    }
    const Vec3 direction =
        cosine_direction(RayFrame(normal), batch.state[point.path].sampler.pair(0, lobe_point));
    const float density = normal.dot(direction) / float(pi);
    if (!(density > 0)) return;
    const SkySampler::Sample sky = sky_->seen(direction, density);
    add(direction, luminance(sky.radiance) * density / (sky.density + density), no_end);
    lights_->for_each_met(
        batch.position.at(point.path), direction, density,
        [&](const Vec3& light, float distance) { add(direction, luminance(light), distance); });
}

void CatcherLight::add_lamp(const PathBatch& batch, size_t path, const ChosenLight& lamp,
                            CaughtLight& to) const {
    to.all += lamp.all;
    const Vec3 place = batch.position.at(path);
    const Vec2 u = batch.state[path].sampler.pair(0, emitter_point);
    const PathLights::Towards way = lights_->towards(lamp, place, u, *scene_);
    const bool can_be_hidden = way.distance > 0 && scene_->ball().is_met(place, way.direction);
    to.arrives += can_be_hidden
                      ? lamp.all * luminance(lights_->transmittance(way, start_of(batch, path), *scene_))
                      : lamp.all;
}

void CatcherLight::add_samples(const PathBatch& batch, std::vector<CaughtLight>& light) const {
    std::vector<ChosenLight> lamps;
    lights_->choose(batch, 0, true, lamps);
    for (size_t i = 0; i < batch.count; ++i)
        if (lamps[i].all > 0) add_lamp(batch, i, lamps[i], light[batch.state[i].index]);
    // Area lights count on directions that are distributed by the cosine.
    const bool has_areas = lights_->has_areas();
    if (sky_->empty() && !has_areas) return;
    for (const SkyPoint& point : sky_points(batch)) {
        CaughtLight& to = light[batch.state[point.path].index];
        if (point.sees_cone)
            add_hidden_sky(batch, point, to);
        else
            add_sky(batch, point, to);
    }
}

std::vector<CatcherLight::SkyPoint> CatcherLight::sky_points(const PathBatch& batch) const {
    std::vector<SkyPoint> points(batch.count);
    std::vector<Vec2> chosen;
    for (size_t i = 0; i < batch.count; ++i) {
        SkyPoint& point = points[i];
        point.path = i;
        point.u = batch.state[i].sampler.pair(0, sky_point);
        point.sees_cone = !lights_->has_areas() && distance_of(batch.position.at(i)) > nearest_cone;
        point.is_chosen = sky_->is_sampled();
        if (point.is_chosen && point.sees_cone) {
            point.is_chosen = point.u.x() < sky_part;
            point.u.x() = point.is_chosen ? point.u.x() / sky_part
                                          : std::min((point.u.x() - sky_part) / (1 - sky_part), below_one);
        }
        if (point.is_chosen) chosen.push_back(point.u);
    }
    const std::vector<SkySampler::Sample> skies = sky_->sample(chosen);
    auto sky = skies.begin();
    for (SkyPoint& point : points)
        if (point.is_chosen) point.sky = *sky++;
    return points;
}

}  // namespace easypbr::render
