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
/// Rays to a place on an emissive surface end before it by this part of their length, and of the scene's
/// radius.
constexpr float before_emitter = 1e-4f;
constexpr float below_one = 1 - 0x1p-24f;
/// Neither the sky nor emissive surfaces get less of the directions of next-event estimation, where there are
/// both.
constexpr float least_part = 0.1f;

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
          chosen_direction(room),
          chosen_radiance(room),
          chosen_density(room),
          distance(room, std::numeric_limits<float>::infinity()),
          chosen_light(room),
          direction(room),
          weight(room),
          density(room) {}

    native::path_scatter_stream stream(const PathBatch& batch) {
        native::path_scatter_stream stream;
        batch.read_by(stream);
        random.read_by(stream.v_random);
        chosen_direction.read_by(stream.v_light_direction);
        chosen_radiance.read_by(stream.v_light);
        stream.v_light_density = chosen_density.data();
        chosen_light.written_by(stream.o_light);
        direction.written_by(stream.o_direction);
        weight.written_by(stream.o_weight);
        stream.o_density = density.data();
        return stream;
    }

    /// The direction of next-event estimation.
    void set_direction(size_t i, const Vec3& towards, const Vec3& arrives, float density_of_it) {
        chosen_direction.set(i, towards);
        chosen_radiance.set(i, arrives);
        chosen_density[i] = density_of_it;
    }

    PathVectors<3> random, chosen_direction, chosen_radiance;
    std::vector<float> chosen_density, distance;  ///< how far the light of the direction is
    PathVectors<3> chosen_light, direction, weight;
    std::vector<float> density;
};

/// Paths that met a surface.
struct PathTracer::Found {
    struct Hit {
        uint32_t path;  ///< in the batch
        RayHit hit;
        Vec3 direction, throughput;
        float density;  ///< of the direction, per steradian
    };
    std::vector<Hit> hits;
};

void PathTracer::prepare(const ResolvedSettings& resolved, const RayScene& scene) {
    resolved_ = &resolved;
    scene_ = &scene;
    lights_.prepare(resolved, scene);
    sky_.prepare(resolved.environment, resolved.R_env_world, resolved.settings.environment.intensity);
    emitters_.prepare(scene);
    const float of_emitters = emitters_.brightness(), of_sky = sky_.brightness();
    emitter_part_ =
        emitters_.empty() ? 0 : std::clamp(of_emitters / (of_emitters + of_sky), least_part, 1 - least_part);
    if (!emitters_.empty() && !sky_.is_sampled()) emitter_part_ = 1;
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

Vec3 PathTracer::escaped(const Vec3& direction, float density, float sky_part) const {
    return sky_.radiance(direction) * (density / (density + sky_part * sky_.density(direction)));
}

float PathTracer::emission_weight(const RayHit& hit, const Vec3& direction, float density) const {
    const float chosen = emitter_part_ * emitters_.density(hit, direction);
    return chosen > 0 ? density / (density + chosen) : 1.0f;
}

void PathTracer::choose_directions(const PathBatch& batch, uint32_t depth, bool caught, Scattered& to) const {
    const float emitter_part = caught ? 0 : emitter_part_;
    std::vector<std::pair<Emitters::Sample, size_t>> chosen;
    for (size_t i = 0; i < batch.count; ++i) {
        Vec2 u = batch.samplers[i].pair(depth, sky_point);
        if (u.x() < emitter_part) {
            u.x() = std::min(u.x() / emitter_part, below_one);
            chosen.emplace_back(emitters_.sample(start_of(batch, i), u), i);
        } else if (sky_.is_sampled()) {
            u.x() = std::min((u.x() - emitter_part) / (1 - emitter_part), below_one);
            const SkySampler::Sample sky = sky_.sample(u);
            to.set_direction(i, sky.direction, sky.radiance, (1 - emitter_part) * sky.density);
        }
    }
    std::ranges::stable_sort(chosen, {}, [](const auto& one) { return one.first.surface; });
    std::vector<native::ElementHit> hits;
    std::vector<int> surfaces;
    for (auto& [sample, path] : chosen) {
        sample.hit.footprint = sample.distance * float(scene_->unit()) * widening;
        hits.push_back(sample.hit);
        surfaces.push_back(sample.surface);
    }
    const HitSurfaces found = evaluate(*scene_, hits, surfaces);
    for (size_t i = 0; i < chosen.size(); ++i) {
        const auto& [sample, path] = chosen[i];
        to.set_direction(path, sample.direction, found.emission.at(i), emitter_part * sample.density);
        to.distance[path] = sample.distance * (1 - before_emitter) - before_emitter;
    }
}

void PathTracer::scatter(const PathBatch& batch, uint32_t depth, bool caught, Scattered& to) const {
    for (size_t i = 0; i < batch.count; ++i) {
        const PathSampler& sampler = batch.samplers[i];
        const Vec2 lobe = sampler.pair(depth, lobe_point);
        to.random.set(i, {lobe.x(), lobe.y(), sampler.pair(depth, light_and_lobe).y()});
    }
    choose_directions(batch, depth, caught, to);
    native::run((caught ? of_catcher_ : uniforms_).get(), to.stream(batch), int(batch.count));
}

void PathTracer::add_direct(const PathBatch& batch, uint32_t depth, const std::vector<ChosenLight>& lamps,
                            const Scattered& scattered, std::vector<Vec3>& radiance) const {
    for (size_t i = 0; i < batch.count; ++i) {
        const Vec3 place = batch.position.at(i), from = start_of(batch, i);
        Vec3 light = Vec3::Zero();
        if (lamps[i].all > 0 && lights_.reaches(lamps[i].index, from, place,
                                                batch.samplers[i].pair(depth, emitter_point), *scene_))
            light += lamps[i].light;
        const Vec3 chosen = scattered.chosen_light.at(i);
        if (chosen.maxCoeff() > 0 &&
            !scene_->blocked(from, scattered.chosen_direction.at(i), scattered.distance[i]))
            light += chosen;
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
            found.hits.push_back({uint32_t(i), *hit, direction, throughput, scattered.density[i]});
        else
            radiance[batch.index[i]] += limited(
                throughput.cwiseProduct(escaped(direction, scattered.density[i], 1 - emitter_part_)), depth);
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
        const Vec3 emission = surfaces.emission.at(i) * emission_weight(hit.hit, hit.direction, hit.density);
        radiance[place] += limited(hit.throughput.cwiseProduct(emission), depth);
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
        const float sky = luminance(scattered.chosen_light.at(i));
        if (sky > 0) add(sky, !scene_->blocked(from, scattered.chosen_direction.at(i), no_end));
        const Vec3 direction = scattered.direction.at(i);
        const float found =
            luminance(Vec3(scattered.weight.at(i).cwiseProduct(escaped(direction, scattered.density[i], 1))));
        if (found > 0) add(found, !scene_->blocked(from, direction, no_end));
    }
}

}  // namespace easypbr::render
