// Rows of the table of settings for effects in screen space.
#include "easypbr/scene/field_builder.h"

namespace easypbr::detail {

template <>
const std::vector<std::string>& enum_names<OcclusionMethod>() {
    static const std::vector<std::string> names = {"horizon", "hemisphere"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<OcclusionResolution>() {
    static const std::vector<std::string> names = {"adaptive", "half", "full"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<GroundMode>() {
    static const std::vector<std::string> names = {"none", "shadow", "plane"};
    return names;
}
namespace {

void add_ssao(Table& table) {
    const auto ssao = [](auto member) { return at(&Settings::ssao, member); };
    table.push_back(
        make("ssao.enabled", ssao(&SsaoSettings::enabled),
             "Whether surfaces shade each other from the environment's light where they are close "
             "together; automatic: where there are surfaces."));
    table.push_back(make("ssao.method", ssao(&SsaoSettings::method),
                         "Horizons (ground-truth ambient occlusion), or points in the hemisphere above a "
                         "surface."));
    table.push_back(make("ssao.resolution", ssao(&SsaoSettings::resolution),
                         "Half or full resolution; adaptive: half, but full where 8 or more frames are "
                         "averaged."));
    table.push_back(
        make("ssao.radius", ssao(&SsaoSettings::radius),
             "Distance within which surfaces occlude each other; automatic: 5 % of the diagonal of "
             "the content's bounding box.",
             "world units", {positive, unlimited}));
    table.push_back(make("ssao.falloff", ssao(&SsaoSettings::falloff),
                         "Outer part of the radius in which occlusion fades.", "", {0.01, 1}));
    table.push_back(make("ssao.power", ssao(&SsaoSettings::power),
                         "Exponent of the visibility: above 1 darker, below 1 lighter.", "", {0, 16}));
    table.push_back(make("ssao.directions", ssao(&SsaoSettings::directions),
                         "Directions that each frame looks in from a pixel.", "", {1, 64}));
    table.push_back(make("ssao.steps", ssao(&SsaoSettings::steps),
                         "Places looked at in each direction, and opposite to it.", "", {1, 64}));
    table.push_back(
        make("ssao.multi_bounce", ssao(&SsaoSettings::multi_bounce),
             "Lightens and tints the occlusion of bright surfaces, which reflect light into their "
             "own recesses."));
}

void add_ground(Table& table) {
    const auto ground = [](auto member) { return at(&Settings::ground, member); };
    table.push_back(make("ground.mode", ground(&GroundSettings::mode),
                         "A plane under the content: none; shadow: it shows the shadows that fall on it and "
                         "nothing else, over any background; plane: a surface of its own."));
    table.push_back(
        make("ground.height", ground(&GroundSettings::height),
             "Where the ground is, along the up axis; automatic: at the lowest point of the content.",
             "world units"));
    table.push_back(make("ground.shadow_strength", ground(&GroundSettings::strength),
                         "How dark the shadows are that the ground shows in mode shadow: 1 as dark as in "
                         "nature.",
                         "", {0, 1}));
    table.push_back(
        color("ground.plane_color", ground(&GroundSettings::color), "Colour of the ground in mode plane."));
    table.push_back(make("ground.plane_roughness", ground(&GroundSettings::roughness),
                         "Roughness of the ground in mode plane.", "", {0, 1}));
    table.push_back(make("ground.radius", ground(&GroundSettings::radius),
                         "Distance from the content at which the ground of mode plane has faded into the "
                         "background; automatic: 12 radii of the content.",
                         "world units", {positive, unlimited}));
}

}  // namespace

void add_effects(Table& table) {
    add_ground(table);
    add_ssao(table);
}

}  // namespace easypbr::detail
