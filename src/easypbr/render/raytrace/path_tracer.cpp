#include "easypbr/render/raytrace/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "easypbr/core/luminance.h"
#include "easypbr/render/frame/inverse_tone.h"
#include "easypbr/render/frame/surface_kind.h"
#include "easypbr/render/raytrace/hit_surfaces.h"
#include "easypbr/render/raytrace/path_step.h"
#include "easypbr/render/raytrace/path_volumes.h"
#include "easypbr/render/raytrace/ray_surface.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// From this surface on paths end at random (Russian roulette).
constexpr uint32_t first_roulette = 3;
/// Rays to a place on an emissive surface end before it by this part of their length, and by its rounding.
constexpr float before_emitter = 1e-4f;
/// Neither the sky nor emissive surfaces get less of the directions of next-event estimation, where there are
/// both.
constexpr float least_part = 0.1f;
/// Surfaces that a path passes before it ends at random. They take little of its throughput.
constexpr uint16_t sure_passages = 16;
/// Per steradian: surfaces scatter light widely in directions of less, as lobes of 30 degrees are.
constexpr float widest_density = 4;
/// Mirrors show what they face as it is up to so many times the limit: the sun by way of two of them is rare.
constexpr float narrow_light = 40;
/// Cosine between a face and a lamp's direction from which on down rays to the lamp start above the face.
constexpr float terminator = 0.1f;
constexpr float unlimited = std::numeric_limits<float>::infinity();
/// Lamps shine straight through faces of less roughness (Passage::roughness): as narrowly as these spread
/// light, hardly a path from what it falls on would find the lamp.
constexpr float nearly_clear = 0.15f;
/// Of directions that are the only ones.
constexpr float only_direction = 1e30f;

using enum PathSampler::Dimension;

bool is_extended_kind(float code) {
    return std::abs(code - code_of(SurfaceKind::extended)) < 0.01f;
}

bool is_lit_kind(float code) {
    return code < code_of(SurfaceKind::display) - 0.05f;
}

bool is_unlit_kind(float code) {
    return code > code_of(SurfaceKind::unlit) - 0.1f;
}

}  // namespace

inline void PathTracer::add(uint32_t index, const Vec3& found, Scattering scattered, PathRadiance& to) const {
    if (scattered == Scattering::none) return to.add(index, found);
    const bool is_wide = scattered == Scattering::wide;
    const float most = is_wide ? most_light_ : narrow_light * most_light_, brightness = luminance(found);
    if (!(brightness > most)) return to.add(index, found);
    if (is_wide) return to.add(index, found, most / brightness);
    to.add(index, found * (most / brightness));
}

struct PathTracer::Batches {
    PathBatch plain, extended;
};

PathTracer::Hit PathTracer::camera_hit(const PathState& state, const RayHit& hit, const Vec3& direction,
                                       float footprint) {
    return {state, hit, direction, only_direction, footprint};
}

void PathTracer::prepare(const ResolvedSettings& resolved, const RayScene& scene, float most) {
    resolved_ = &resolved;
    scene_ = &scene;
    lights_.prepare(resolved, scene);
    sky_.prepare(resolved.environment, resolved.R_env_world, resolved.settings.environment.intensity);
    emitters_.prepare(scene);
    catcher_.prepare(scene, lights_, sky_);
    background_ = background_radiance(resolved);
    most_light_ = most;
    const float of_emitters = emitters_.brightness(), of_sky = sky_.brightness();
    emitter_part_ =
        emitters_.empty() ? 0 : std::clamp(of_emitters / (of_emitters + of_sky), least_part, 1 - least_part);
    if (!emitters_.empty() && !sky_.is_sampled()) emitter_part_ = 1;
    const auto with = [&](PathSurfaces surfaces, native::Stream shader) {
        Transfers none;
        return native::stream_uniforms(shader, path_inputs(resolved, scene, surfaces).native(none));
    };
    uniforms_ = with(PathSurfaces::plain, native::Stream::path_scatter);
    extended_.reset();
    absorption_.clear();
    if (!scene.extensions()) return;
    extended_ = with(PathSurfaces::extended, native::Stream::path_scatter_extended);
    for (int i = 0; i < scene.surface_count(); ++i)
        absorption_.push_back(absorption_of(scene.item_of(i).material) * float(scene.unit()));
}

Vec3 PathTracer::start_towards(const PathBatch& batch, size_t path, const Vec3& direction) const {
    if (!batch.extensions) return batch.start.at(path);
    const Vec3 face = batch.face.at(path);
    if (direction.dot(face) > 0) return batch.start.at(path);
    return RayScene::off_surface(batch.position.at(path), -face, -face * batch.reach[path]);
}

Vec3 PathTracer::start_to_lamp(const PathBatch& batch, size_t path, const Vec3& direction) const {
    if (batch.extensions && batch.extensions->volume.at(path).x() > 0)
        return start_towards(batch, path, direction);
    const Vec3 face = batch.face.at(path);
    const float part = std::clamp(1 - direction.dot(face) / terminator, 0.0f, 1.0f);
    if (part == 0) return batch.start.at(path);
    return batch.start.at(path) + part * scene_->to_smooth(batch.on[path], face);
}

void PathTracer::add_escaped(const Escaped& paths, PathRadiance& radiance) const {
    const std::vector<SkySampler::Sample> skies = sky_.seen(paths.directions, paths.densities);
    for (size_t i = 0; i < skies.size(); ++i) {
        const Escaped::Path& path = paths.paths[i];
        const float density = paths.densities[i],
                    chosen = path.by_both ? (1 - emitter_part_) * skies[i].density : 0;
        const float weight = density / (density + chosen);
        add(path.index, path.throughput.cwiseProduct(skies[i].radiance * weight), path.scattered, radiance);
    }
}

std::vector<float> PathTracer::shown_by_ground(std::span<const GroundHit> hits, uint32_t depth) const {
    if (hits.empty()) return {};
    const float strength = resolved_->settings.ground.shadow_strength;
    std::vector<float> shown = catcher_.sampled_parts(hits, depth);
    for (float& part : shown) part = 1 - strength * (1 - part);
    return shown;
}

void PathTracer::add_caught(const Caught& caught, uint32_t depth, PathRadiance& radiance) const {
    // The paths end here: no path takes the random numbers of the next surface.
    const std::vector<float> shown = shown_by_ground(caught.hits, depth + 1);
    Escaped before_sky;
    for (size_t i = 0; i < shown.size(); ++i) {
        Escaped::Path path = caught.before_sky.paths[i];
        const Vec3& before_color = caught.before_color[i];
        if (before_color.maxCoeff() > 0)
            add(path.index, before_color.cwiseProduct(*background_ * shown[i]), path.scattered, radiance);
        path.throughput *= shown[i];
        if (path.throughput.maxCoeff() > 0)
            before_sky.add(caught.before_sky.directions[i], caught.before_sky.densities[i], path);
    }
    add_escaped(before_sky, radiance);
}

std::vector<float> PathTracer::emission_weights(std::span<const Hit> hits) const {
    std::vector<float> weights(hits.size(), 1.0f);
    if (emitters_.empty()) return weights;
    std::vector<Emitters::Met> met;
    met.reserve(hits.size());
    for (const Hit& hit : hits) met.push_back({hit.hit, hit.direction});
    const std::vector<float> densities = emitters_.densities(met);
    for (size_t i = 0; i < hits.size(); ++i)
        if (const float chosen = emitter_part_ * densities[i]; chosen > 0)
            weights[i] = hits[i].density / (hits[i].density + chosen);
    return weights;
}

void PathTracer::choose_directions(const PathBatch& batch, uint32_t depth, Scattered& to) const {
    std::vector<uint32_t> of_emitters, of_sky;
    std::vector<Vec2> sky_points;
    PathVectors<2> points = batch.points(depth, sky_point);
    PathVectors<3> places(points.room());
    for (size_t i = 0; i < batch.count; ++i) {
        Vec2 u = points.at(i);
        if (u.x() < emitter_part_) {
            u.x() = std::min(u.x() / emitter_part_, below_one);
            points.set(of_emitters.size(), u);
            places.set(of_emitters.size(), batch.start.at(i));
            of_emitters.push_back(uint32_t(i));
        } else if (sky_.is_sampled()) {
            u.x() = std::min((u.x() - emitter_part_) / (1 - emitter_part_), below_one);
            sky_points.push_back(u);
            of_sky.push_back(uint32_t(i));
        }
    }
    const std::vector<SkySampler::Sample> skies = sky_.sample(sky_points);
    for (size_t i = 0; i < of_sky.size(); ++i)
        to.set_direction(of_sky[i], skies[i].direction, skies[i].radiance,
                         (1 - emitter_part_) * skies[i].density);
    if (of_emitters.empty()) return;
    const Emitters::Samples chosen = emitters_.sample(*scene_, places, points, of_emitters.size());
    for (size_t i = 0; i < chosen.count; ++i) {
        const size_t path = of_emitters[i];
        const Vec3 direction = chosen.direction.at(i);
        const float index2 = squared_index_towards(*scene_, batch, path, direction);
        to.set_direction(path, direction, chosen.radiance.at(i) / index2, emitter_part_ * chosen.density[i]);
        const float rounding = RayScene::rounding(batch.position.at(path).norm() + chosen.distance[i]);
        to.distance[path] = chosen.distance[i] * (1 - before_emitter) - rounding;
    }
}

void PathTracer::scatter(const PathBatch& batch, uint32_t depth, Scattered& to) const {
    const PathVectors<2> of_lobe = batch.points(depth, lobe_point),
                         of_choice = batch.points(depth, light_and_lobe);
    for (int c = 0; c < 2; ++c) std::copy_n(of_lobe.component(c), of_lobe.room(), to.random.component(c));
    std::copy_n(of_choice.component(1), of_choice.room(), to.random.component(2));
    choose_directions(batch, depth, to);
    const int count = int(batch.count);
    if (batch.extensions)
        native::run(extended_.get(), to.stream<native::path_scatter_extended_stream>(batch), count);
    else
        native::run(uniforms_.get(), to.stream<native::path_scatter_stream>(batch), count);
}

void PathTracer::add_lamps(const PathBatch& batch, const std::vector<ChosenLight>& lamps,
                           std::vector<Vec3>& light) const {
    if (lights_.empty()) return;
    std::vector<RaySegment> rays;
    std::vector<uint32_t> lights, paths;
    std::vector<float> stopping;
    rays.reserve(batch.count);
    lights.reserve(batch.count);
    stopping.reserve(batch.count);
    paths.reserve(batch.count);
    for (size_t i = 0; i < batch.count; ++i) {
        if (!(lamps[i].all > 0)) continue;
        const bool inside = is_inside(batch, i), passes = batch.passes(i, lamps[i].way);
        const bool straight = lights_.shines_straight(lamps[i].index);
        // From what lies before such a face its light has been found straight through it.
        const float passed = batch.state[i].found_lamps ? nearly_clear : least_roughness;
        if ((inside || passes) && straight && lamp_roughness(*scene_, batch, i) < passed) continue;
        RaySegment ray = lights_.towards(lamps[i], batch.position.at(i));
        ray.from = start_to_lamp(batch, i, ray.direction);
        // From the way into a volume lamps are found that are within: others where paths leave it.
        const bool within = passes && !batch.state[i].found_lamps && overlooks_lamps(*scene_, batch, i, true);
        stopping.push_back(within ? least_roughness : nearly_clear);
        rays.push_back(ray);
        lights.push_back(lamps[i].index);
        paths.push_back(uint32_t(i));
    }
    // What is rougher spreads the light over directions in which paths go on to it.
    const std::vector<Vec3> left = lights_.transmittances(rays, lights, stopping, *scene_);
    for (size_t i = 0; i < rays.size(); ++i) {
        const size_t path = paths[i];
        Vec3 found = lamps[path].light.cwiseProduct(left[i]);
        // Straight light has been absorbed on its way.
        if (!lights_.shines_straight(lights[i]))
            found = found.cwiseProduct(left_on_the_way(batch, path, lamps[path].way, lamps[path].way.norm()));
        light[path] += dispersed_on_entry(batch, path, lamps[path].way, found) /
                       squared_index_around(*scene_, batch, path);
    }
}

bool PathTracer::sees_sky_in_ground(Scattering scattered) const {
    return !background_ || scattered == Scattering::wide;
}

void PathTracer::add_chosen(const PathBatch& batch, uint32_t depth, const Scattered& scattered,
                            std::vector<Vec3>& light) const {
    const bool catches = scene_->ground() && scene_->ground()->shadow_catcher;
    std::vector<GroundHit> below;  // light that a ground shows, and its paths
    std::vector<std::pair<size_t, Vec3>> shown_there;
    for (size_t i = 0; i < batch.count; ++i) {
        const Vec3 chosen = scattered.chosen_light.at(i);
        if (!(chosen.maxCoeff() > 0)) continue;
        const PathState& state = batch.state[i];
        const Vec3 direction = scattered.chosen_direction.at(i);
        const float distance = scattered.distance[i];
        const bool is_sky = std::isinf(distance);
        // Where a background of one colour is seen through surfaces there is no sky.
        const bool seen_through = !state.reflected && batch.passes(i, direction);
        if (background_ && seen_through && is_sky) continue;
        const Vec3 from = start_towards(batch, i, direction);
        const float to_ground = scene_->ground_distance(from, direction);
        // The ground hides what is below; one that catches shadows shows the sky.
        const bool meets_ground = distance > 0 && to_ground < distance;
        if (meets_ground && !(is_sky && catches && sees_sky_in_ground(state.scattered))) continue;
        const float end = std::min(distance, to_ground);
        if (distance > 0 && scene_->blocked(from, direction, end, Transmissive::met)) continue;
        if (meets_ground) {
            below.push_back({state, from + direction * to_ground});
            shown_there.emplace_back(i, chosen);
        } else {
            light[i] += is_sky ? chosen : chosen.cwiseProduct(left_on_the_way(batch, i, direction, distance));
        }
    }
    // The numbers of this surface have chosen the directions.
    const std::vector<float> shown = shown_by_ground(below, depth + 1);
    for (size_t i = 0; i < shown.size(); ++i) light[shown_there[i].first] += shown_there[i].second * shown[i];
}

void PathTracer::add_direct(const PathBatch& batch, uint32_t depth, const std::vector<ChosenLight>& lamps,
                            const Scattered& scattered, PathRadiance& radiance) const {
    std::vector<Vec3> light(batch.count, Vec3::Zero());
    add_lamps(batch, lamps, light);
    add_chosen(batch, depth, scattered, light);
    const auto add_to = [&](const PathState& state, const Vec3& of_it) {
        add(state.index, state.throughput.cwiseProduct(of_it), state.scattered, radiance);
    };
    for (size_t i = 0; i < batch.count; ++i) {
        if (is_inside(batch, i)) {
            // From within a volume all of it has passed the surface.
            PathState passed = batch.state[i];
            disperse(batch.extended_paths[i].channel, passed);
            add_to(passed, light[i]);
        } else {
            add_to(batch.state[i], light[i]);
        }
    }
}

void PathTracer::add_emission(const PathBatch& batch, const Scattered& scattered,
                              PathRadiance& radiance) const {
    for (size_t i = 0; i < batch.count; ++i) {
        const PathState& state = batch.state[i];
        const Vec3 kept = batch.extended_paths[i].emission.cwiseProduct(scattered.keep.at(i));
        add(state.index, kept, state.scattered, radiance);
    }
}

bool PathTracer::goes_on(const PathBatch& batch, size_t path, uint32_t depth, const Vec3& direction,
                         PathState& state) const {
    const float most = state.throughput.maxCoeff();
    if (!(most > 0)) return false;
    const bool inside = is_inside(batch, path), passes = batch.passes(path, direction),
               transmits = batch.transmits(path, direction);
    state.reflected |= !transmits;
    state.found_lamps |= !overlooks_lamps(*scene_, batch, path, passes);
    if (passes) pass(*scene_, batch, path, state);
    const bool is_sure =
        inside || transmits ? ++state.passages <= sure_passages : ++state.bounces <= first_roulette;
    if (is_sure) return true;
    const float chance = std::min(most, 0.95f);
    state.throughput /= chance;
    return state.sampler.pair(depth, roulette).x() < chance;
}

Vec3 PathTracer::part_before_color(const PathBatch& batch, size_t path, const Scattered& scattered,
                                   const PathState& state) const {
    if (!background_) return Vec3::Zero();
    if (!state.reflected) return Vec3::Ones();
    if (sees_sky_in_ground(batch.state[path].scattered)) return Vec3::Zero();
    // The diffuse lobe has no more than this of the weight: what specular lobes take of it is not known here.
    const float metallic = batch.parameters.at(path).x(),
                transmission = batch.extensions ? batch.extensions->volume.at(path).x() : 0.0f,
                cosine = std::max(batch.normal.at(path).dot(scattered.direction.at(path)), 0.0f);
    const Vec3 diffuse = batch.albedo.at(path) * ((1 - metallic) * (1 - transmission) * cosine /
                                                  (float(pi) * scattered.density[path]));
    const Vec3 weight = scattered.weight.at(path);
    return (1 - diffuse.array() / weight.array().max(1e-20f)).max(0.0f);
}

void PathTracer::note_caught(const PathBatch& batch, size_t path, const Scattered& scattered, const Hit& hit,
                             Caught& to) const {
    const Scattering before = batch.state[path].scattered;
    const Vec3 part = part_before_color(batch, path, scattered, hit.state);
    const Vec3& throughput = hit.state.throughput;
    to.hits.push_back({hit.state, hit.hit.position});
    to.before_color.push_back(throughput.cwiseProduct(part));
    to.before_sky.add(
        hit.direction, hit.density,
        {throughput.cwiseProduct(Vec3::Ones() - part), hit.state.index, before, sees_sky_in_ground(before)});
}

void PathTracer::follow(const PathBatch& batch, uint32_t depth, const Scattered& scattered,
                        std::vector<Hit>& hits, PathRadiance& radiance) const {
    Escaped escaped;
    escaped.directions.reserve(batch.count);
    escaped.densities.reserve(batch.count);
    escaped.paths.reserve(batch.count);
    Caught caught;
    const bool catches = scene_->ground() && scene_->ground()->shadow_catcher;
    for (size_t i = 0; i < batch.count; ++i) {
        PathState state = batch.state[i];
        const Scattering before = state.scattered;
        state.throughput = state.throughput.cwiseProduct(scattered.weight.at(i));
        const Vec3 direction = scattered.direction.at(i);
        if (!goes_on(batch, i, depth, direction, state)) continue;
        const auto hit = scene_->trace(start_towards(batch, i, direction), direction, Transmissive::met);
        lights_.for_each_met(batch.position.at(i), direction, scattered.density[i],
                             [&](const Vec3& light, float distance, bool is_hidden) {
                                 if (is_hidden && hit && hit->distance < distance) return;
                                 PathState at_lamp = state;
                                 absorb(distance, at_lamp);
                                 const Vec3 found = light / squared_index(*scene_, state);
                                 add(state.index, at_lamp.throughput.cwiseProduct(found), before, radiance);
                             });
        if (!hit && background_ && !state.reflected) {
            add(state.index, state.throughput.cwiseProduct(*background_), before, radiance);
            continue;
        }
        if (!hit) {
            escaped.add(direction, scattered.density[i], {state.throughput, state.index, before});
            continue;
        }
        absorb(hit->distance, state);
        const Hit met{state, *hit, direction, scattered.density[i],
                      hit->distance * float(scene_->unit()) * ray_widening};
        if (hit->surface < 0 && catches)
            note_caught(batch, i, scattered, met, caught);
        else
            hits.push_back(met);
    }
    add_escaped(escaped, radiance);
    add_caught(caught, depth, radiance);
}

namespace {

/// Adds a path at a surface to a batch.
size_t add_path(const RayScene& scene, const PathTracer::Hit& hit, const HitSurfaces& surfaces, size_t i,
                PathBatch& to) {
    const size_t at = to.count++;
    to.position.set(at, hit.hit.position);
    to.normal.set(at, surfaces.normal.at(i));
    to.face.set(at, surfaces.face.at(i));
    to.view.set(at, -hit.direction);
    to.reach[at] = scene.reach(hit.hit);
    to.on[at] = hit.hit.on();
    to.albedo.set(at, surfaces.albedo.at(i));
    to.parameters.set(at, surfaces.parameters.at(i));
    PathState state = hit.state;
    if (hit.density < widest_density)
        state.scattered = Scattering::wide;
    else if (state.scattered == Scattering::none && state.bounces > 0)
        state.scattered = Scattering::narrow;
    to.set_state(at, state);
    return at;
}

}  // namespace

Vec3 PathTracer::shown(const HitSurfaces& surfaces, size_t i, const PathState& state) const {
    if (is_lit_kind(surfaces.kind[i])) return surfaces.emission.at(i) / squared_index(*scene_, state);
    if (is_unlit_kind(surfaces.kind[i])) return surfaces.emission.at(i);
    return surfaces.albedo.at(i) * shown_as_one(resolved_->exposure);
}

PathTracer::Batches PathTracer::arrive(std::vector<Hit>& hits, uint32_t depth, PathRadiance& radiance) const {
    // Surfaces are evaluated item by item.
    const std::vector<uint32_t> sorted =
        sorted_by_surface(hits.size(), [&](size_t i) { return hits[i].hit.surface; });
    std::vector<native::ElementHit> elements(hits.size());
    std::vector<int> order(hits.size());
    for (size_t i = 0; i < hits.size(); ++i) {
        elements[i] = native_hit(hits[sorted[i]].hit, hits[sorted[i]].footprint);
        order[i] = hits[sorted[i]].hit.surface;
    }
    const HitSurfaces surfaces = evaluate(*scene_, elements, order);
    const std::vector<float> weights = emission_weights(hits);
    const bool with_extensions = extended_ != nullptr;
    Batches next{PathBatch(hits.size()), PathBatch(with_extensions ? hits.size() : 0, with_extensions)};
    for (size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits[sorted[i]];
        const Vec3 emission =
            hit.state.throughput.cwiseProduct(shown(surfaces, i, hit.state)) * weights[sorted[i]];
        const bool extended = is_extended_kind(surfaces.kind[i]),
                   ends = hit.state.bounces > resolved_->settings.path.bounces;
        if (!extended || ends) add(hit.state.index, emission, hit.state.scattered, radiance);
        if (!is_lit_kind(surfaces.kind[i]) || ends) continue;
        const size_t at = add_path(*scene_, hit, surfaces, i, extended ? next.extended : next.plain);
        if (!extended) continue;
        next.extended.extensions->copy(at, *surfaces.extensions, i);
        next.extended.extended_paths[at] = {hit.hit.surface, all_channels, emission};
        meet_volume(next.extended, at, hit, depth);
    }
    hits.clear();
    return next;
}

void PathTracer::step(PathBatch& batch, uint32_t depth, std::vector<Hit>& hits,
                      PathRadiance& radiance) const {
    if (batch.count == 0) return;
    batch.find_starts();
    std::vector<ChosenLight> lamps;
    lights_.choose(batch, depth, false, lamps);
    Scattered scattered(PathBatch::rounded_up(batch.count));
    scatter(batch, depth, scattered);
    add_direct(batch, depth, lamps, scattered, radiance);
    if (batch.extensions) add_emission(batch, scattered, radiance);
    follow(batch, depth, scattered, hits, radiance);
}

void PathTracer::trace(PathBatch& batch, std::vector<Hit>& hits, PathRadiance& radiance) const {
    Batches at = arrive(hits, 0, radiance);
    step(batch, 0, hits, radiance);
    step(at.plain, 0, hits, radiance);
    step(at.extended, 0, hits, radiance);
    for (uint32_t depth = 1; !hits.empty(); ++depth) {
        at = arrive(hits, depth - 1, radiance);
        step(at.plain, depth, hits, radiance);
        step(at.extended, depth, hits, radiance);
    }
}

}  // namespace easypbr::render
