// The rows of the table for the ground plane, and what is inferred.
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<GroundMode>() {
    static const std::vector<std::string> names = {"none", "shadow", "plane"};
    return names;
}

namespace {

/// Radii of the content after which a visible ground has faded.
constexpr double ground_radii = 12;

}  // namespace

void add_fields(Table& table, GroundSettings Settings::*effect) {
    const auto of = [&](auto member) { return at(effect, member); };
    table.push_back(make("ground.mode", of(&GroundSettings::mode),
                         "Ground plane under the content: none, a shadow catcher (shadow) over any "
                         "background, or a visible surface (plane)."));
    table.push_back(
        make("ground.height", of(&GroundSettings::height),
             "Height of the ground along the up axis; automatic: the lowest point of the content.",
             "world units"));
    table.push_back(make("ground.shadow_strength", of(&GroundSettings::shadow_strength),
                         "Opacity factor of the shadow catcher; 1 is physically based.", "", {0, 1}));
    table.push_back(
        color("ground.plane_color", of(&GroundSettings::plane_color), "Base colour of the ground in mode plane."));
    table.push_back(make("ground.plane_roughness", of(&GroundSettings::plane_roughness),
                         "Perceptual roughness of the ground in mode plane.", "", {0, 1}));
    table.push_back(make("ground.radius", of(&GroundSettings::radius),
                         "Distance from the content at which the ground in mode plane has faded into the "
                         "background; automatic: 12 radii of the content.",
                         "world units", {positive, unlimited}));
}

void infer(GroundSettings& ground, const EffectContext& context) {
    if (context.content.empty()) return;
    const Vec3d up = parse_up(context.resolved.settings.camera.up);
    if (!ground.height.value()) fill(ground.height, context.content.extent_along(up).first);
    if (!ground.radius.value()) fill(ground.radius, float(ground_radii * context.content.radius()));
}

}  // namespace easypbr::detail
