#include "easypbr/render/raytrace/path_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "easypbr/gpu/dfg.h"
#include "easypbr/render/frame/extensions.h"
#include "easypbr/render/frame/shading_inputs.h"
#include "easypbr/render/shadow/light_block.h"
#include "easypbr/scene/light_falloff.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::render {
namespace {

/// Rays to a place of an emitter end before it: the part of their length.
constexpr float part_to_emitter = 1 - 1e-4f;

using Uniforms = std::array<blocks::Light, lights_per_block>;

/// What path_lamps has found for each path.
struct Found {
    explicit Found(size_t room)
        : choice(room), emitter(room), light(room), way(room), sum(room), number(room) {}

    std::vector<float> choice;
    PathVectors<2> emitter;
    PathVectors<3> light, way;
    std::vector<float> sum, number;
};

/// Of blocks one is chosen as lights are within a block: by a number in [0, 1) of its own.
void add_block(uint32_t first, const Found& found, size_t i, float number, ChosenLight& so_far) {
    const float sum = found.sum[i], all = so_far.all + sum;
    if (so_far.all == 0)
        so_far = {found.light.at(i), sum, first + uint32_t(found.number[i]), found.way.at(i)};
    else if (number * all < sum)
        so_far = {found.light.at(i) * (all / sum), all, first + uint32_t(found.number[i]), found.way.at(i)};
    else
        so_far = {so_far.light * (all / so_far.all), all, so_far.index, so_far.way};
}

template <class Stream>
Stream stream_of(const PathBatch& batch, Found& found) {
    Stream stream;
    batch.read_by(stream);
    stream.v_choice = found.choice.data();
    found.emitter.read_by(stream.v_emitter);
    found.light.written_by(stream.o_light);
    found.way.written_by(stream.o_way);
    stream.o_sum = found.sum.data();
    stream.o_chosen = found.number.data();
    return stream;
}

}  // namespace

ShaderInputs path_inputs(const ResolvedSettings& resolved, const RayScene& scene, PathSurfaces surfaces) {
    const ShadingSettings& shading = resolved.settings.shading;
    ShaderInputs values;
    set_brdf(values, shading);
    values.set("u_dfg", gpu::host_dfg(shading.brdf));
    if (surfaces == PathSurfaces::catcher) values.define("SHADOW_CATCHER");
    if (surfaces != PathSurfaces::extended) return values;
    std::vector<std::string> defines;
    add_extension_defines(scene.extensions(), defines);
    values.define(defines);
    values.set("u_sheen_albedo", gpu::host_sheen_albedo());
    return values;
}

void PathLights::prepare(const ResolvedSettings& resolved, const RayScene& scene) {
    blocks_.clear();
    areas_.clear();
    emitters_.clear();
    transmits_ = false;
    for (int i = 0; i < scene.surface_count(); ++i) transmits_ |= scene.item_of(i).casts_tint();
    const auto& lights = resolved.lights;
    for (const ResolvedLight& light : lights) {
        emitters_.push_back({light.type == LightType::directional, is_area(light.type),
                             light.casts_shadows && resolved.settings.shadows.enabled});
        if (!is_area(light.type)) continue;
        areas_.push_back(area_of(light, scene));
        areas_.back().casts_shadows = emitters_.back().casts_shadows;
    }
    for (size_t first = 0; first < lights.size(); first += lights_per_block) {
        const size_t count = std::min(lights.size() - first, lights_per_block);
        Uniforms uniforms{};
        for (size_t i = 0; i < count; ++i)
            uniforms[i] = light_uniform(lights[first + i], scene.centre(), scene.unit());
        const auto with = [&](PathSurfaces surfaces, native::Stream shader) {
            ShaderInputs values = path_inputs(resolved, scene, surfaces);
            values.set_block(0, "u_lights", gl::bytes_of(uniforms));
            values.set("u_light_count", int(count));
            if (!areas_.empty()) values.define("AREA_LIGHTS");
            Transfers none;
            return native::stream_uniforms(shader, values.native(none));
        };
        Block& block = blocks_.emplace_back();
        block.first = uint32_t(first);
        block.uniforms = with(PathSurfaces::plain, native::Stream::path_lamps);
        block.of_catcher = with(PathSurfaces::catcher, native::Stream::path_lamps);
        if (scene.extensions())
            block.extended = with(PathSurfaces::extended, native::Stream::path_lamps_extended);
    }
}

void PathLights::choose(const PathBatch& batch, uint32_t depth, bool caught,
                        std::vector<ChosenLight>& chosen) const {
    chosen.assign(batch.count, {});
    if (blocks_.empty()) return;
    Found found(PathBatch::rounded_up(batch.count));
    found.emitter = batch.points(depth, PathSampler::emitter_point);
    const int count = int(batch.count);
    for (size_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        const PathVectors<2> numbers = batch.points(depth, PathSampler::choice_in_block(uint32_t(b)));
        std::copy_n(numbers.component(0), numbers.room(), found.choice.begin());
        if (batch.extensions)
            native::run(block.extended.get(), stream_of<native::path_lamps_extended_stream>(batch, found),
                        count);
        else
            native::run((caught ? block.of_catcher : block.uniforms).get(),
                        stream_of<native::path_lamps_stream>(batch, found), count);
        for (size_t i = 0; i < batch.count; ++i) {
            if (found.sum[i] > 0) add_block(block.first, found, i, numbers.at(i).y(), chosen[i]);
        }
    }
}

PathLights::Area PathLights::area_of(const ResolvedLight& light, const RayScene& scene) {
    const double unit = scene.unit();
    Area area;
    area.type = light.type;
    area.centre = ((light.position - scene.centre()) / unit).cast<float>();
    area.radiance = light.color * light.intensity;
    area.radius = float(double(light.radius) / unit);
    area.area = float(emitting_area(light) / (unit * unit));
    if (light.type == LightType::sphere) return area;
    const EmitterAxes axes = emitter_axes(light);
    area.x = (axes.x / unit).cast<float>();
    area.y = (axes.y / unit).cast<float>();
    area.normal = light.direction.normalized();
    return area;
}

PathLights::Met PathLights::met(const Area& area, const Vec3& place, const Vec3& direction) {
    const Vec3 centre = area.centre - place;
    if (area.type == LightType::sphere) {
        const float d2 = centre.squaredNorm(), r2 = area.radius * area.radius, along = centre.dot(direction);
        // Of the squared distance between the centre and the ray, without cancellation.
        const float root = r2 - (centre - along * direction).squaredNorm();
        if (!(d2 > r2) || along <= 0 || root <= 0) return {};
        const float sine2 = r2 / d2, open = sine2 / (1 + std::sqrt(1 - sine2));
        return {along - std::sqrt(root), 1 / (2 * float(pi) * open)};
    }
    const float cosine = -direction.dot(area.normal);
    if (cosine <= 0) return {};
    const float distance = -centre.dot(area.normal) / cosine;
    if (distance <= 0) return {};
    const Vec3 at = direction * distance - centre;
    const float x = at.dot(area.x) / area.x.squaredNorm(), y = at.dot(area.y) / area.y.squaredNorm();
    const bool inside =
        area.type == LightType::disc ? x * x + y * y <= 1 : std::abs(x) <= 1 && std::abs(y) <= 1;
    return {distance, inside ? distance * distance / (area.area * cosine) : 0.0f};
}

RaySegment PathLights::towards(const ChosenLight& chosen, const Vec3& from) const {
    const Emitter& emitter = emitters_[chosen.index];
    const float reach = chosen.way.norm();
    if (!emitter.casts_shadows || !(reach > 0)) return {};
    return {from, chosen.way / reach,
            emitter.is_parallel ? std::numeric_limits<float>::infinity() : reach * part_to_emitter};
}

std::vector<Vec3> PathLights::transmittances(std::span<const RaySegment> rays,
                                             std::span<const uint32_t> lights,
                                             std::span<const float> stopping, const RayScene& scene) const {
    std::vector<Vec3> left(rays.size(), Vec3::Ones());
    std::vector<RaySegment> whole;
    std::vector<size_t> places;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (rays[i].distance <= 0) continue;
        if (transmits_ && !emitters_[lights[i]].is_area) {
            left[i] = scene.transmittance(rays[i].from, rays[i].direction, rays[i].distance, stopping[i]);
        } else {
            whole.push_back(rays[i]);
            places.push_back(i);
        }
    }
    const std::vector<uint8_t> blocked = scene.blocked(whole, Neighbours::similar, Transmissive::met);
    for (size_t i = 0; i < whole.size(); ++i)
        if (blocked[i]) left[places[i]] = Vec3::Zero();
    return left;
}

}  // namespace easypbr::render
