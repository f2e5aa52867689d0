// The volumes that paths are in, and what their surfaces do to the light of lamps.
#pragma once

#include <algorithm>
#include <cstddef>

#include "easypbr/render/raytrace/path_batch.h"
#include "easypbr/render/raytrace/ray_scene.h"
#include "easypbr/render/raytrace/ray_surface.h"

namespace easypbr::render {

/// Which of a path's volumes a surface bounds, as all parts of an object do; none: their number.
inline size_t volume_of(const RayScene& scene, const PathState& state, int surface) {
    const auto* const object = scene.item_of(surface).object;
    const auto found = std::ranges::find_if(
        state.volumes, [&](int volume) { return volume >= 0 && scene.item_of(volume).object == object; });
    return size_t(found - state.volumes.begin());
}

/// Of a path that has passed a volume's surface.
inline void cross_volume(const RayScene& scene, int surface, PathState& state) {
    auto& volumes = state.volumes;
    if (const size_t left = volume_of(scene, state, surface); left < volumes.size()) {
        std::copy(volumes.begin() + std::ptrdiff_t(left) + 1, volumes.end(),
                  volumes.begin() + std::ptrdiff_t(left));
        volumes.back() = -1;
    } else {
        std::copy_backward(volumes.begin(), volumes.end() - 1, volumes.end());
        volumes.front() = surface;
    }
}

/// Of a path that has passed a surface which had chosen a channel, or none.
inline void disperse(int8_t channel, PathState& state) {
    if (channel == all_channels || state.channel != all_channels) return;
    state.channel = channel;
    // One of three equally likely channels stands for all.
    state.throughput = 3 * state.throughput[channel] * Vec3::Unit(channel);
}

/// What becomes of a path of a batch whose surfaces have extensions, and that passes its surface.
inline void pass(const RayScene& scene, const PathBatch& batch, size_t path, PathState& state) {
    const ExtendedPath& at = batch.extended_paths[path];
    disperse(at.channel, state);
    if (batch.extensions->volume.at(path).z() > 0) cross_volume(scene, at.surface, state);
}

/// Whether a path meets the surface of its volume from within.
inline bool is_inside(const PathBatch& batch, size_t path) {
    return batch.extensions && batch.inside[path] > 0.5f;
}

/// Of light of lamps that passes a path's surface straight, as Passage::roughness has it: against air.
inline float lamp_roughness(const RayScene& scene, const PathBatch& batch, size_t path) {
    const Material& material = scene.item_of(batch.extended_paths[path].surface).material;
    return transmitted_roughness(batch.parameters.at(path).y(), material.ior);
}

/// Whether lamps beyond are not looked for from a path's surface: it is clear, or the way into a volume.
/// `passes`: the path goes on through the surface.
inline bool overlooks_lamps(const RayScene& scene, const PathBatch& batch, size_t path, bool passes) {
    const bool inside = is_inside(batch, path);
    if (!passes && !inside) return false;
    return lamp_roughness(scene, batch, path) < least_roughness ||
           (!inside && batch.extensions->volume.at(path).z() > 0);
}

/// Light that a lamp in this direction sends a path: of one colour where it leaves a volume that disperses.
inline Vec3 dispersed_on_entry(const PathBatch& batch, size_t path, const Vec3& direction,
                               const Vec3& light) {
    if (!batch.passes(path, direction) || is_inside(batch, path)) return light;
    PathState passed = batch.state[path];
    passed.throughput = light;
    disperse(batch.extended_paths[path].channel, passed);
    return passed.throughput;
}

/// The index of refraction of a volume, by a surface of it; 1 of none.
inline float index_of(const RayScene& scene, int volume, int8_t channel) {
    if (volume < 0) return 1;
    constexpr int8_t green = 1;
    return scene.item_of(volume).material.ior_of_channel(channel == all_channels ? green : channel);
}

/// Of the index of refraction of the medium that a path is in. A path's throughput is that of radiance over
/// this number, which refraction leaves as it is.
inline float squared_index(const RayScene& scene, const PathState& state) {
    const float index = index_of(scene, state.volumes[0], state.channel);
    return index * index;
}

/// The index of a surface's volume over that of the medium around it, where a path meets the surface. Where
/// volumes overlap, the one that was entered last fills the place: the borders of others are none.
/// `index`: of the surface's volume.
inline float relative_index(const RayScene& scene, const PathState& state, int surface, float index) {
    const auto& volumes = state.volumes;
    const size_t own = volume_of(scene, state, surface);
    if (own == volumes.size()) return index / index_of(scene, volumes[0], state.channel);
    return own == 0 ? index / index_of(scene, volumes[1], state.channel) : 1.0f;
}

/// The same of the medium around a path's surface, on whose other side its volume is.
inline float squared_index_around(const RayScene& scene, const PathBatch& batch, size_t path) {
    const float index2 = squared_index(scene, batch.state[path]);
    if (!is_inside(batch, path)) return index2;
    const float relative = batch.extensions->volume.at(path).y();
    return index2 / (relative * relative);
}

/// The same of the medium that a direction from a path's surface leads into.
inline float squared_index_towards(const RayScene& scene, const PathBatch& batch, size_t path,
                                   const Vec3& direction) {
    if (!batch.extensions || direction.dot(batch.face.at(path)) > 0)
        return squared_index(scene, batch.state[path]);
    PathState passed = batch.state[path];
    pass(scene, batch, path, passed);
    return squared_index(scene, passed);
}

}  // namespace easypbr::render
