#include "easypbr/render/raytrace/path_volumes.h"

#include <algorithm>
#include <cmath>

#include "easypbr/render/raytrace/path_tracer.h"

namespace easypbr::render {
namespace {

/// What the surface between two media reflects at normal incidence and at grazing angles, for Schlick's
/// reflectance.
struct InterfaceReflectance {
    float normal, grazing;
};

/// `relative`: the ratio of their indices of refraction. Schlick's reflectance is F0 + (F90 - F0) / 21 over
/// all directions. Fresnel's is that of Egan and Hilgeman (1973), which F90 agrees with: 1 from a ratio
/// of 1.4 on, and 0 where there is no surface at all.
InterfaceReflectance reflectance_between(float relative) {
    const float n = std::max(relative, 1 / relative), root = (n - 1) / (n + 1), normal = root * root;
    const float mean = (n - 1) / (4.08567f + 1.00071f * n);
    return {normal, std::clamp(normal + 21 * (mean - normal), 0.0f, 1.0f)};
}

}  // namespace

void PathTracer::choose_color(PathBatch& batch, size_t path, uint32_t depth) const {
    ExtendedPath& at = batch.extended_paths[path];
    Vec3 volume = batch.extensions->volume.at(path);
    const Material& material = scene_->item_of(at.surface).material;
    if (!(material.dispersion > 0) || !(volume.z() > 0)) return;
    const PathState& state = batch.state[path];
    at.channel = state.channel != all_channels
                     ? state.channel
                     : int8_t(3 * state.sampler.pair(depth, PathSampler::color_channel).x());
    volume.y() = material.ior_of_channel(at.channel);
    batch.extensions->volume.set(path, volume);
}

void PathTracer::surround(PathBatch& batch, size_t path) const {
    const int surface = batch.extended_paths[path].surface;
    const Material& material = scene_->item_of(surface).material;
    Vec3 volume = batch.extensions->volume.at(path);
    const float own = volume.y(), relative = relative_index(*scene_, batch.state[path], surface, own);
    if (relative == own || !(material.ior > 0) || !material.transmits()) return;
    volume.y() = relative;
    batch.extensions->volume.set(path, volume);
    Vec4 dielectric = batch.extensions->dielectric.at(path);
    InterfaceReflectance between = reflectance_between(relative);
    const float alone = reflectance_between(material.ior).normal;
    Vec3 f0 = alone > 0 ? Vec3(dielectric.head<3>() * (between.normal / alone))
                        : Vec3(material.specular_color * (between.normal * dielectric.w()));
    float f90 = between.grazing * dielectric.w();
    f0 = f0.cwiseMin(dielectric.w());
    if (relative < 1 && batch.inside[path] < 0.5f) {
        // From what is denser: the reflectance at this angle, for all facets.
        const float cosine = batch.normal.at(path).dot(batch.view.at(path)),
                    sine2 = (1 - cosine * cosine) / (relative * relative);
        const float grazing = sine2 < 1 ? std::pow(1 - std::sqrt(1 - sine2), 5.0f) : 1.0f;
        f0 = sine2 < 1 ? Vec3(f0.array() + (f90 - f0.array()) * grazing) : Vec3(Vec3::Ones());
        f90 = f0.maxCoeff();
    }
    dielectric << f0, f90;
    batch.extensions->dielectric.set(path, dielectric);
}

void PathTracer::meet_volume(PathBatch& batch, size_t path, const Hit& hit, uint32_t depth) const {
    PathExtensions& extensions = *batch.extensions;
    Vec3 volume = extensions.volume.at(path);
    const int surface = hit.hit.surface;
    const bool is_within = volume_of(*scene_, hit.state, surface) < hit.state.volumes.size();
    if (volume.z() > 0 && !is_within && scene_->is_sheet(hit.hit, hit.direction)) {
        extensions.absorption.set(path, extensions.absorption.at(path) * volume.z());
        volume.z() = 0;
        extensions.volume.set(path, volume);
    } else if (!(volume.z() > 0)) {
        extensions.absorption.set(path, Vec3::Zero());
    }
    batch.inside[path] = volume.z() > 0 && is_within ? 1.0f : 0.0f;
    choose_color(batch, path, depth);
    if (volume.z() > 0) surround(batch, path);
}

Vec3 PathTracer::left_on_the_way(const PathBatch& batch, size_t path, const Vec3& direction,
                                 float distance) const {
    const bool passes = batch.passes(path, direction);
    if (batch.state[path].volumes[0] < 0 && !passes) return Vec3::Ones();
    PathState state = batch.state[path];
    if (passes) pass(*scene_, batch, path, state);
    state.throughput.setOnes();
    absorb(std::max(distance, 0.0f), state);
    return state.throughput;
}

void PathTracer::absorb(float distance, PathState& state) const {
    if (state.volumes[0] < 0) return;
    const Vec3 absorption = absorption_[size_t(state.volumes[0])];
    state.throughput.array() *= (-absorption * distance).array().exp();
}

}  // namespace easypbr::render
