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

void add_rays(Table& table) {
    const auto rays = [](auto member) { return at(&Settings::rays, member); };
    table.push_back(
        make("rays.enabled", rays(&RaySettings::enabled),
             "Whether rays find what hides the sky from a surface and what surfaces mirror and light each "
             "other, in place of ambient occlusion; automatic: in pictures of 32 samples or more "
             "where ambient occlusion is on."));
    table.push_back(make("rays.count", rays(&RaySettings::count),
                         "Rays that all samples of a picture together send into the sky from a pixel.", "",
                         {1, 65536}));
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

void add_bloom(Table& table) {
    const auto bloom = [](auto member) { return at(&Settings::bloom, member); };
    table.push_back(make("bloom.enabled", bloom(&BloomSettings::enabled),
                         "Whether bright light glows beyond what shines it, before the tone curve."));
    table.push_back(make("bloom.intensity", bloom(&BloomSettings::intensity),
                         "Part of the light above the threshold that is spread. It is taken from where it "
                         "was: no light is added.",
                         "", {0, 1}));
    table.push_back(make("bloom.threshold", bloom(&BloomSettings::threshold),
                         "Brightness from which light is spread, after exposure (the largest of red, green "
                         "and blue; 1: white without a tone curve); 0: all light.",
                         "", {0, 1e6}));
    table.push_back(make("bloom.knee", bloom(&BloomSettings::knee),
                         "Softness of the threshold, as a part of it.", "", {0, 1}));
    table.push_back(make("bloom.levels", bloom(&BloomSettings::levels),
                         "Levels of the pyramid, the first of 4 pixels, each next one twice as wide; "
                         "automatic: up to 6, the widest texel an eighth of the picture's smaller side.",
                         "", {1, 8}));
    table.push_back(make("bloom.suppress_fireflies", bloom(&BloomSettings::suppress_fireflies),
                         "Whether single pixels that are far brighter than those around them glow less; "
                         "automatic: where there is a threshold. Without, the glow keeps all energy."));
}

void add_lens(Table& table) {
    const auto lens = [](auto member) { return at(&Settings::depth_of_field, member); };
    table.push_back(make("depth_of_field.enabled", lens(&DepthOfFieldSettings::enabled),
                         "Whether what is out of focus is blurred, as by a thin lens. Orthographic cameras "
                         "have no lens."));
    table.push_back(make("depth_of_field.f_number", lens(&DepthOfFieldSettings::f_number),
                         "Focal length over the diameter of the aperture: smaller blurs more.", "",
                         {0.1, 1000}));
    table.push_back(make("depth_of_field.focus_distance", lens(&DepthOfFieldSettings::focus_distance),
                         "Distance along the optical axis of what is sharp; automatic: the middle of the "
                         "content, for every picture anew.",
                         "world units", {positive, unlimited}));
    table.push_back(make("depth_of_field.sensor_height", lens(&DepthOfFieldSettings::sensor_height),
                         "Height of the sensor: 0.024 is a full-frame camera's where the world unit is the "
                         "metre; automatic: 5 % of the diagonal of the content's bounding box.",
                         "world units", {positive, unlimited}));
    const auto motion = [](auto member) { return at(&Settings::motion_blur, member); };
    table.push_back(make("motion_blur.enabled", motion(&MotionBlurSettings::enabled),
                         "Whether a picture of several samples shows how camera and objects moved since the "
                         "session's last one."));
    table.push_back(make("motion_blur.shutter", motion(&MotionBlurSettings::shutter),
                         "Part of the time since the last picture that the shutter is open, until the moment "
                         "of this one.",
                         "", {0, 1}));
}

}  // namespace

void add_effects(Table& table) {
    add_ground(table);
    add_ssao(table);
    add_rays(table);
    add_bloom(table);
    add_lens(table);
}

}  // namespace easypbr::detail
