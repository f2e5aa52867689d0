// The rows of the table for the ground plane, and what is inferred.
#include <algorithm>
#include <limits>

#include "easypbr/scene/draw_style.h"
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

/// Whether light and shadow show on the object.
bool is_lit_surface(const SceneSnapshot::Object& object, const Style& overrides) {
    const DrawStyle style = resolve_style(*object.mesh, overrides);
    const DrawMode primitive = primitive_of(*object.mesh, style);
    return style.visible && !style.overlay && style.lit.value_or(true) && primitive != DrawMode::points &&
           primitive != DrawMode::lines && primitive != DrawMode::splats;
}

GroundMode inferred_mode(const EffectContext& context) {
    const Settings& settings = context.settings;
    const bool is_plain = settings.background.mode == BackgroundMode::color;
    const bool stands = std::ranges::any_of(context.content.scene().objects, [&](const auto& object) {
        return is_lit_surface(object, settings.style);
    });
    return is_plain && stands && settings.shadows.enabled ? GroundMode::shadow : GroundMode::none;
}

}  // namespace

void add_ground(Table& table) {
    table.push_back(not_kept(
        make("ground.mode", EASYPBR_AT(ground.mode),
             "Ground plane under the content: none, a shadow catcher (shadow) over any background, or a "
             "visible surface (plane); automatic: shadow under lit surfaces before a background "
             "of one colour, else none.")));
    table.push_back(
        make("ground.height", EASYPBR_AT(ground.height),
             "Height of the ground along the up axis; automatic: just below the lowest point of the content.",
             "world units"));
    table.push_back(make("ground.shadow_strength", EASYPBR_AT(ground.shadow_strength),
                         "Opacity factor of the shadow catcher; 1 is physically based.", "", {0, 1}));
    table.push_back(color("ground.plane_color", EASYPBR_AT(ground.plane_color),
                          "Base colour of the ground in mode plane."));
    table.push_back(make("ground.plane_roughness", EASYPBR_AT(ground.plane_roughness),
                         "Perceptual roughness of the ground in mode plane.", "", {0, 1}));
    table.push_back(make("ground.radius", EASYPBR_AT(ground.radius),
                         "Distance from the content at which the ground in mode plane has faded into the "
                         "background; automatic: 12 radii of the content.",
                         "world units", {positive, unlimited}));
}

void infer(GroundSettings& ground, const EffectContext& context) {
    const Content& content = context.content;
    if (!ground.mode.value()) fill(ground.mode, inferred_mode(context));
    if (ground.height.value() && ground.radius.value()) return;
    // Below no content there is no ground, at a finite distance.
    constexpr float nowhere = std::numeric_limits<float>::infinity();
    const Vec3d up = up_direction(context.settings.camera);
    if (!ground.height.value()) fill(ground.height, ground_below(content.bounds(), up));
    if (!ground.radius.value())
        fill(ground.radius, content.empty() ? nowhere : float(ground_radii * content.radius()));
}

}  // namespace easypbr::detail
