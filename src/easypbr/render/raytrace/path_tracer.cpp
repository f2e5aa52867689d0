#include "easypbr/render/raytrace/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/render/raytrace/hit_surfaces.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// From this surface on paths end at random (Russian roulette).
constexpr uint32_t first_roulette = 3;
/// The part of its length by which a ray widens, of directions that a matt surface sends: textures are read
/// that much blurred.
constexpr float widening = 0.05f;

/// Dimensions of PathSampler, in pairs; the first of `lobe_and_light` belongs to PathLights.
enum Dimension : uint32_t { sky_point, light_and_lobe, lobe_point, emitter_point, roulette };

float luminance(const Vec3& c) {
    return c.dot(Vec3(0.2126f, 0.7152f, 0.0722f));
}

bool is_lit_kind(float code) {
    return code < code_of(SurfaceKind::display) - 0.05f;
}

}  // namespace

/// What path_scatter reads and writes beyond the batch.
struct PathTracer::Scattered {
    explicit Scattered(size_t room)
        : random(room),
          sky_direction(room),
          sky(room),
          sky_density(room),
          sky_light(room),
          direction(room),
          weight(room),
          density(room) {}

    native::path_scatter_stream stream(const PathBatch& batch) {
        native::path_scatter_stream stream;
        batch.read_by(stream);
        random.read_by(stream.v_random);
        sky_direction.read_by(stream.v_sky_direction);
        sky.read_by(stream.v_sky);
        stream.v_sky_density = sky_density.data();
        sky_light.written_by(stream.o_sky);
        direction.written_by(stream.o_direction);
        weight.written_by(stream.o_weight);
        stream.o_density = density.data();
        return stream;
    }

    PathVectors<3> random, sky_direction, sky;
    std::vector<float> sky_density;
    PathVectors<3> sky_light, direction, weight;
    std::vector<float> density;
};

/// Paths that met a surface.
struct PathTracer::Found {
    struct Hit {
        uint32_t path;  ///< in the batch
        RayHit hit;
        Vec3 direction, throughput;
    };
    std::vector<Hit> hits;
};

void PathTracer::prepare(const ResolvedSettings& resolved, const RayScene& scene) {
    resolved_ = &resolved;
    scene_ = &scene;
    lights_.prepare(resolved, scene);
    sky_.prepare(resolved.environment, resolved.R_env_world, resolved.settings.environment.intensity);
    const auto with = [&](bool caught) {
        Transfers none;
        return native::stream_uniforms(native::Stream::path_scatter,
                                       path_inputs(resolved, caught).native(none));
    };
    uniforms_ = with(false);
    of_catcher_ = with(true);
}

Vec3 PathTracer::start_of(const PathBatch& batch, size_t path) const {
    const Vec3 view = batch.view.at(path);
    return RayScene::off_surface(RayScene::off_surface(batch.position.at(path), view), batch.face.at(path),
                                 scene_->reach());
}

Vec3 PathTracer::limited(const Vec3& light, uint32_t depth) const {
    const float most = resolved_->settings.path.clamp, brightness = luminance(light);
    return depth > 0 && most > 0 && brightness > most ? Vec3(light * (most / brightness)) : light;
}

Vec3 PathTracer::escaped(const Vec3& direction, float density) const {
    return sky_.radiance(direction) * (density / (density + sky_.density(direction)));
}

void PathTracer::scatter(const PathBatch& batch, uint32_t depth, bool caught, Scattered& to) const {
    for (size_t i = 0; i < batch.count; ++i) {
        const PathSampler& sampler = batch.samplers[i];
        const Vec2 lobe = sampler.pair(depth, lobe_point);
        to.random.set(i, {lobe.x(), lobe.y(), sampler.pair(depth, light_and_lobe).y()});
        if (!sky_.is_sampled()) continue;
        const SkySampler::Sample chosen = sky_.sample(sampler.pair(depth, sky_point));
        to.sky_direction.set(i, chosen.direction);
        to.sky.set(i, chosen.radiance);
        to.sky_density[i] = chosen.density;
    }
    native::run((caught ? of_catcher_ : uniforms_).get(), to.stream(batch), int(batch.count));
}

void PathTracer::add_direct(const PathBatch& batch, uint32_t depth, const std::vector<ChosenLight>& lamps,
                            const Scattered& scattered, std::vector<Vec3>& radiance) const {
    constexpr float no_end = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < batch.count; ++i) {
        const Vec3 place = batch.position.at(i), from = start_of(batch, i);
        Vec3 light = Vec3::Zero();
        if (lamps[i].all > 0 && lights_.reaches(lamps[i].index, from, place,
                                                batch.samplers[i].pair(depth, emitter_point), *scene_))
            light += lamps[i].light;
        const Vec3 sky = scattered.sky_light.at(i);
        if (sky.maxCoeff() > 0 && !scene_->blocked(from, scattered.sky_direction.at(i), no_end)) light += sky;
        radiance[batch.index[i]] += limited(batch.throughput[i].cwiseProduct(light), depth);
    }
}

void PathTracer::follow(PathBatch& batch, uint32_t depth, const Scattered& scattered, Found& found,
                        std::vector<Vec3>& radiance) const {
    for (size_t i = 0; i < batch.count; ++i) {
        Vec3 throughput = batch.throughput[i].cwiseProduct(scattered.weight.at(i));
        const float most = throughput.maxCoeff();
        if (!(most > 0)) continue;
        if (depth >= first_roulette) {
            const float goes_on = std::min(most, 0.95f);
            if (batch.samplers[i].pair(depth, roulette).x() >= goes_on) continue;
            throughput /= goes_on;
        }
        const Vec3 direction = scattered.direction.at(i);
        const auto hit = scene_->trace(start_of(batch, i), direction);
        if (hit)
            found.hits.push_back({uint32_t(i), *hit, direction, throughput});
        else
            radiance[batch.index[i]] +=
                limited(throughput.cwiseProduct(escaped(direction, scattered.density[i])), depth);
    }
}

Vec3 PathTracer::caught_sky(const RayHit& hit, const Vec3& direction, const Vec2& u) const {
    const Vec3 up = cosine_direction(RayFrame(hit.normal), u);
    const bool open = !scene_->blocked(RayScene::off_surface(hit.position, hit.normal, scene_->reach()), up,
                                       std::numeric_limits<float>::infinity());
    return open ? sky_.radiance(direction) : Vec3(Vec3::Zero());
}

void PathTracer::arrive(PathBatch& batch, uint32_t depth, Found& found, std::vector<Vec3>& radiance) const {
    // Surfaces are evaluated item by item.
    std::ranges::stable_sort(found.hits, {}, [](const Found::Hit& hit) { return hit.hit.surface; });
    std::vector<native::ElementHit> elements(found.hits.size());
    std::vector<int> order(found.hits.size());
    const auto unit = float(scene_->unit());
    for (size_t i = 0; i < found.hits.size(); ++i) {
        const RayHit& hit = found.hits[i].hit;
        native::ElementHit& to = elements[i];
        order[i] = hit.surface;
        to.element = uint32_t(hit.element);
        to.u = hit.u;
        to.v = hit.v;
        std::copy_n(hit.normal.data(), 3, to.normal);
        to.footprint = hit.distance * unit * widening;
    }
    const HitSurfaces surfaces = evaluate(*scene_, elements, order);
    PathBatch next(found.hits.size());
    for (size_t i = 0; i < found.hits.size(); ++i) {
        const Found::Hit& hit = found.hits[i];
        const PathSampler& sampler = batch.samplers[hit.path];
        const uint32_t place = batch.index[hit.path];
        if (hit.hit.surface < 0 && scene_->ground()->shadow_catcher) {
            const Vec3 sky = caught_sky(hit.hit, hit.direction, sampler.pair(depth, emitter_point));
            radiance[place] += limited(hit.throughput.cwiseProduct(sky), depth);
            continue;
        }
        radiance[place] += limited(hit.throughput.cwiseProduct(surfaces.emission.at(i)), depth);
        if (surfaces.kind[i] > 0.9f || depth + 1 > uint32_t(resolved_->settings.path.bounces)) continue;
        const size_t to = next.count++;
        next.position.set(to, hit.hit.position);
        next.normal.set(to, surfaces.normal.at(i));
        next.face.set(to, surfaces.face.at(i));
        next.view.set(to, -hit.direction);
        next.albedo.set(to, surfaces.albedo.at(i));
        // What is shown past the light is as if it were matt.
        next.parameters.set(to, is_lit_kind(surfaces.kind[i]) ? surfaces.parameters.at(i) : Vec2(0, 1));
        next.throughput[to] = hit.throughput;
        next.samplers[to] = sampler;
        next.index[to] = place;
    }
    batch = std::move(next);
}

void PathTracer::trace(PathBatch& batch, std::vector<Vec3>& radiance) const {
    for (uint32_t depth = 0; batch.count > 0; ++depth) {
        std::vector<ChosenLight> lamps;
        lights_.choose(batch, depth, false, lamps);
        Scattered scattered(PathBatch::rounded_up(batch.count));
        scatter(batch, depth, false, scattered);
        add_direct(batch, depth, lamps, scattered, radiance);
        Found found;
        follow(batch, depth, scattered, found, radiance);
        arrive(batch, depth, found, radiance);
    }
}

void PathTracer::trace_caught(const PathBatch& batch, std::vector<CaughtLight>& light) const {
    constexpr float no_end = std::numeric_limits<float>::infinity();
    std::vector<ChosenLight> lamps;
    lights_.choose(batch, 0, true, lamps);
    Scattered scattered(PathBatch::rounded_up(batch.count));
    scatter(batch, 0, true, scattered);
    for (size_t i = 0; i < batch.count; ++i) {
        const Vec3 place = batch.position.at(i), from = start_of(batch, i);
        CaughtLight& to = light[batch.index[i]];
        const auto add = [&](float amount, bool arrives) {
            to.all += amount;
            if (arrives) to.arrives += amount;
        };
        if (lamps[i].all > 0)
            add(lamps[i].all, lights_.reaches(lamps[i].index, from, place,
                                              batch.samplers[i].pair(0, emitter_point), *scene_));
        const float sky = luminance(scattered.sky_light.at(i));
        if (sky > 0) add(sky, !scene_->blocked(from, scattered.sky_direction.at(i), no_end));
        const Vec3 direction = scattered.direction.at(i);
        const float found =
            luminance(Vec3(scattered.weight.at(i).cwiseProduct(escaped(direction, scattered.density[i]))));
        if (found > 0) add(found, !scene_->blocked(from, direction, no_end));
    }
}

}  // namespace easypbr::render
