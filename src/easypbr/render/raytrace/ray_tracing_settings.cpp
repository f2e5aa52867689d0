// The rows of the table for ray-traced visibility and reflections, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

namespace {

/// Pictures of fewer samples are previews, and refine in a window.
constexpr int least_samples_for_rays = 32;

}  // namespace

void add_rays(Table& table) {
    table.push_back(not_kept(
        make("rays.enabled", EASYPBR_AT(rays.enabled),
             "Enables ray-traced sky visibility and indirect diffuse and specular light on the CPU, which "
             "replace ambient occlusion; automatic: on from 32 samples if ssao.enabled and no paths are "
             "traced.")));
    table.push_back(
        make("rays.count", EASYPBR_AT(rays.count),
             "Diffuse rays per pixel of an image, divided among its samples; each sample traces at least 4.",
             "", {1, 65536}));
}

void infer(RaySettings& rays, const EffectContext& context) {
    ResolvedSettings& resolved = context.resolved;
    // The environment's light is what rays look for.
    const bool can_trace = !resolved.environment.empty();
    resolved.traces_single_frames = can_trace && rays.enabled.value_or(false);
    fill(rays.enabled, context.samples >= least_samples_for_rays && *context.settings.ssao.enabled &&
                           !resolved.traces_paths);
    resolved.traces_rays = can_trace && *rays.enabled;
}

}  // namespace easypbr::detail
