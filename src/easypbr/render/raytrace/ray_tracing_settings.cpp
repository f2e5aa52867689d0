// The rows of the table for ray-traced visibility and reflections, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

namespace {

/// Pictures of fewer samples are previews, and refine in a window.
constexpr int least_samples_for_rays = 32;

}  // namespace

void add_fields(Table& table, RaySettings Settings::*effect) {
    const auto of = [&](auto member) { return at(effect, member); };
    table.push_back(
        make("rays.enabled", of(&RaySettings::enabled),
             "Enables ray-traced sky visibility and indirect diffuse and specular light on the CPU, which "
             "replace ambient occlusion; automatic: on from 32 samples if ssao.enabled."));
    table.push_back(
        make("rays.count", of(&RaySettings::count),
             "Diffuse rays per pixel of an image, divided among its samples; each sample traces at least 4.",
             "", {1, 65536}));
}

void infer(RaySettings& rays, const EffectContext& context) {
    ResolvedSettings& resolved = context.resolved;
    const bool automatic = context.samples >= least_samples_for_rays && *resolved.settings.ssao.enabled;
    // The environment's light is what rays look for.
    resolved.traces_rays = !resolved.environment.empty() && rays.enabled.value_or(automatic);
}

}  // namespace easypbr::detail
