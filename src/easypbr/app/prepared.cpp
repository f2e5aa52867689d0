#include "easypbr/app/prepared.h"

#include <algorithm>

#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/resolve.h"

namespace easypbr::app {
namespace {

/// The same data at the same places.
bool same_scene(const SceneSnapshot& a, const SceneSnapshot& b) {
    const auto same_object = [](const SceneSnapshot::Object& x, const SceneSnapshot::Object& y) {
        return x.mesh == y.mesh && x.name == y.name && x.T_world_mesh.matrix() == y.T_world_mesh.matrix();
    };
    const auto hash = [](const Environment& environment) {
        return environment.empty() ? std::string() : environment.hash();
    };
    return std::ranges::equal(a.objects, b.objects, same_object) && a.origin == b.origin &&
           hash(a.environment) == hash(b.environment);
}

bool same_settings(const InferredSettings& a, const InferredSettings& b) {
    return std::ranges::all_of(
        fields(), [&](const Field& field) { return field.get_inferred(a) == field.get_inferred(b); });
}

bool same_images(const render::SettingsImages& a, const render::SettingsImages& b) {
    const auto same_texture = [&](const MaterialTexture& row) {
        return (a.textures.*row.texture).image == (b.textures.*row.texture).image;
    };
    return a.background == b.background && a.textures.shader == b.textures.shader &&
           a.shader_files == b.shader_files && std::ranges::all_of(replaceable_textures(), same_texture);
}

bool same_but_lights(const Prepared& a, const Prepared& b) {
    const render::DrawOptions &x = a.options, &y = b.options;
    return x.size == y.size && x.samples == y.samples && x.encoding == y.encoding && x.motion == y.motion &&
           a.passes == b.passes && same_images(a.images, b.images) && same_scene(a.scene, b.scene);
}

}  // namespace

bool same_content(const Prepared& a, const Prepared& b) {
    return same_but_lights(a, b) && a.scene.lights == b.scene.lights;
}

bool same_picture(const Prepared& a, const Prepared& b) {
    return same_but_lights(a, b) && a.resolved.lights == b.resolved.lights &&
           same_settings(a.resolved.settings, b.resolved.settings);
}

}  // namespace easypbr::app
