#include "easypbr/render/raytrace/catcher_light.h"

#include <algorithm>
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

/// Rays that look whether light arrives.
struct CatcherLight::Looks {
    explicit Looks(size_t places) {
        rays.reserve(2 * places);
        lights.reserve(2 * places);
    }
    /// Light that arrives unless something is met.
    void add_open(const RaySegment& ray, uint32_t index, float light) { add(ray, {index, light, false}); }
    /// Light that is taken to arrive, and does not where something is met.
    void add_hidden(const RaySegment& ray, uint32_t index, float light) { add(ray, {index, light, true}); }

    void add_to(std::vector<CaughtLight>& to, const RayScene& scene) const {
        const std::vector<uint8_t> blocked = scene.blocked(rays, Neighbours::scattered);
        for (size_t i = 0; i < rays.size(); ++i) {
            const auto [index, light, is_counted] = lights[i];
            if (!is_counted) to[index].all += light;
            if (bool(blocked[i]) == is_counted) to[index].arrives += is_counted ? -light : light;
        }
    }

  private:
    struct Light {
        uint32_t index;
        float light;
        bool is_counted;  ///< already
    };
    void add(const RaySegment& ray, const Light& light) {
        if (!(light.light > 0)) return;
        rays.push_back(ray);
        lights.push_back(light);
    }

    std::vector<RaySegment> rays;
    std::vector<Light> lights;
};

void CatcherLight::prepare(const RayScene& scene, const PathLights& lights, const SkySampler& sky) {
    scene_ = &scene;
    lights_ = &lights;
    sky_ = &sky;
    const std::optional<RayGround>& ground = scene.ground();
    sky_light_ = ground && ground->shadow_catcher ? sky.light_on(ground->up.cast<float>()) : 0;
}

std::vector<float> CatcherLight::distances(const PathVectors<3>& places) const {
    const RayScene::Ball& ball = scene_->ball();
    std::vector<float> distances(places.room(), no_end);
    if (!(ball.radius > 0)) return distances;
    const float *x = places.component(0), *y = places.component(1), *z = places.component(2);
    for (size_t i = 0; i < distances.size(); ++i)
        distances[i] = (Vec3(x[i], y[i], z[i]) - ball.centre).norm() / ball.radius;
    return distances;
}

void CatcherLight::add_hidden(const PathBatch& batch, const SkyPoint& point, const SkySampler::Sample& sky,
                              float cone_density, Looks& looks) const {
    const float of_sky = sky_->is_sampled() ? sky_part : 0;
    const float cosine = batch.normal.at(point.path).dot(sky.direction);
    if (!(cosine > 0)) return;
    const float density = of_sky * sky.density + (1 - of_sky) * cone_density;
    looks.add_hidden({batch.start.at(point.path), sky.direction, no_end}, batch.state[point.path].index,
                     luminance(sky.radiance) * cosine / (float(pi) * density));
}

void CatcherLight::add_chosen(const PathBatch& batch, const SkyPoint& point, Looks& looks) const {
    const float matt = batch.normal.at(point.path).dot(point.sky.direction) / float(pi);
    if (!(matt > 0)) return;
    looks.add_open({batch.start.at(point.path), point.sky.direction, no_end}, batch.state[point.path].index,
                   luminance(point.sky.radiance) * matt / (point.sky.density + matt));
}

void CatcherLight::add_matt(const PathBatch& batch, size_t path, const SkySampler::Sample& sky, float density,
                            Looks& looks) const {
    const auto add = [&](float light, float distance) {
        looks.add_open({batch.start.at(path), sky.direction, distance}, batch.state[path].index, light);
    };
    add(luminance(sky.radiance) * density / (sky.density + density), no_end);
    lights_->for_each_met(batch.position.at(path), sky.direction, density,
                          [&](const Vec3& light, float distance, bool is_hidden) {
                              add(luminance(light), is_hidden ? distance : -1.0f);
                          });
}

void CatcherLight::add_lamps(const PathBatch& batch, uint32_t depth, std::vector<CaughtLight>& light) const {
    std::vector<ChosenLight> lamps;
    lights_->choose(batch, depth, true, lamps);
    std::vector<RaySegment> rays;
    std::vector<uint32_t> lights, paths;
    for (size_t i = 0; i < batch.count; ++i) {
        if (!(lamps[i].all > 0)) continue;
        CaughtLight& to = light[batch.state[i].index];
        to.all += lamps[i].all;
        const Vec3 place = batch.position.at(i);
        const RaySegment ray = lights_->towards(lamps[i], place);
        if (ray.distance > 0 && scene_->ball().is_met(place, ray.direction)) {
            rays.push_back({batch.start.at(i), ray.direction, ray.distance});
            lights.push_back(lamps[i].index);
            paths.push_back(uint32_t(i));
        } else {
            to.arrives += lamps[i].all;
        }
    }
    // No paths go on from here, which would find what rough surfaces spread.
    const std::vector<float> stopping(rays.size(), RayScene::passes_all);
    const std::vector<Vec3> left = lights_->transmittances(rays, lights, stopping, *scene_);
    for (size_t i = 0; i < rays.size(); ++i)
        light[batch.state[paths[i]].index].arrives += lamps[paths[i]].all * luminance(left[i]);
}

void CatcherLight::add_samples(PathBatch& batch, const std::vector<float>& distances, uint32_t depth,
                               std::vector<CaughtLight>& light) const {
    if (batch.count == 0) return;
    batch.find_starts();
    if (!lights_->empty()) add_lamps(batch, depth, light);
    // Area lights count on directions that are distributed by the cosine.
    if (!sky_->empty() || lights_->has_areas()) add_skies(batch, distances, depth, light);
}

std::vector<float> CatcherLight::sampled_parts(std::span<const GroundHit> hits, uint32_t depth) const {
    PathBatch batch(hits.size());
    const Vec3 up = scene_->ground()->up.cast<float>();
    for (size_t i = 0; i < hits.size(); ++i) {
        batch.position.set(i, hits[i].position);
        for (PathVectors<3>* direction : {&batch.normal, &batch.face, &batch.view}) direction->set(i, up);
        PathState state = hits[i].state;
        state.index = uint32_t(i);
        batch.set_state(i, state);
    }
    batch.count = hits.size();
    std::vector<CaughtLight> light(hits.size());
    add_samples(batch, distances(batch.position), depth, light);
    std::vector<float> parts;
    parts.reserve(light.size());
    for (const CaughtLight& caught : light)
        parts.push_back(caught.all > 0 ? std::max(caught.arrives / caught.all, 0.0f) : 1.0f);
    return parts;
}

void CatcherLight::add_skies(const PathBatch& batch, const std::vector<float>& distances, uint32_t depth,
                             std::vector<CaughtLight>& light) const {
    const std::vector<SkyPoint> points = sky_points(batch, distances, depth);
    const PathVectors<2> lobe = batch.points(depth, lobe_point);
    const RayScene::Ball& ball = scene_->ball();
    Looks looks(points.size());
    // Directions whose sky is read together: within cones, and distributed by the cosine.
    std::vector<size_t> of_points;
    std::vector<Vec3> directions;
    std::vector<float> densities;
    const auto look = [&](size_t i, const Vec3& direction, float density) {
        of_points.push_back(i);
        directions.push_back(direction);
        densities.push_back(density);
    };
    for (size_t i = 0; i < points.size(); ++i) {
        const SkyPoint& point = points[i];
        const Vec3 place = batch.position.at(i), normal = batch.normal.at(i);
        if (!point.sees_cone) {
            if (point.is_chosen) add_chosen(batch, point, looks);
            const Vec3 direction = cosine_direction(RayFrame(normal), lobe.at(i));
            const float density = normal.dot(direction) / float(pi);
            if (density > 0) look(i, direction, density);
            continue;
        }
        CaughtLight& to = light[batch.state[i].index];
        to.all += sky_light_;
        to.arrives += sky_light_;
        if (!(ball.radius > 0)) continue;
        const Cone cone(ball.centre - place, ball.radius);
        if (!point.is_chosen)
            look(i, cone.at(point.u), cone.density());
        else if (ball.is_met(place, point.sky.direction))
            add_hidden(batch, point, point.sky, cone.density(), looks);
    }
    const std::vector<SkySampler::Sample> skies = sky_->seen(directions, densities);
    for (size_t i = 0; i < skies.size(); ++i) {
        const SkyPoint& point = points[of_points[i]];
        if (point.sees_cone)
            add_hidden(batch, point, skies[i], densities[i], looks);
        else
            add_matt(batch, point.path, skies[i], densities[i], looks);
    }
    looks.add_to(light, *scene_);
}

std::vector<CatcherLight::SkyPoint> CatcherLight::sky_points(const PathBatch& batch,
                                                             const std::vector<float>& distances,
                                                             uint32_t depth) const {
    std::vector<SkyPoint> points(batch.count);
    std::vector<Vec2> chosen;
    const PathVectors<2> numbers = batch.points(depth, sky_point);
    for (size_t i = 0; i < batch.count; ++i) {
        SkyPoint& point = points[i];
        point.path = i;
        point.u = numbers.at(i);
        point.sees_cone = !lights_->has_areas() && distances[i] > nearest_cone;
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
