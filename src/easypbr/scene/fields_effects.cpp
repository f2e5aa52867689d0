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
    table.push_back(make("ssao.enabled", ssao(&SsaoSettings::enabled),
                         "Enables screen-space ambient occlusion of image-based lighting; automatic: on if "
                         "the scene has faces or normals."));
    table.push_back(make("ssao.method", ssao(&SsaoSettings::method),
                         "Ambient occlusion algorithm: horizon-based (ground-truth ambient occlusion), or "
                         "point samples in the normal-oriented hemisphere."));
    table.push_back(make("ssao.resolution", ssao(&SsaoSettings::resolution),
                         "Resolution of the ambient occlusion buffer: half, full, or adaptive (full from 8 "
                         "samples on, else half)."));
    table.push_back(make(
        "ssao.radius", ssao(&SsaoSettings::radius),
        "Maximum distance of occluders; automatic: 5 % of the diagonal of the bounding box of the content.",
        "world units", {positive, unlimited}));
    table.push_back(make("ssao.falloff", ssao(&SsaoSettings::falloff),
                         "Outer fraction of the radius over which occlusion fades to zero.", "", {0.01, 1}));
    table.push_back(make("ssao.power", ssao(&SsaoSettings::power),
                         "Exponent of the visibility; values above 1 darken.", "", {0, 16}));
    table.push_back(make("ssao.directions", ssao(&SsaoSettings::directions),
                         "Slices (method horizon) or sets of points (hemisphere) per pixel in each sample.",
                         "", {1, 64}));
    table.push_back(
        make("ssao.steps", ssao(&SsaoSettings::steps),
             "Depth-buffer samples per direction and side; method horizon takes more over long distances.",
             "", {1, 64}));
    table.push_back(make(
        "ssao.multi_bounce", ssao(&SsaoSettings::multi_bounce),
        "Approximates multiple bounces between occluded surfaces, which lightens occlusion by the albedo."));
}

void add_rays(Table& table) {
    const auto rays = [](auto member) { return at(&Settings::rays, member); };
    table.push_back(
        make("rays.enabled", rays(&RaySettings::enabled),
             "Enables ray-traced sky visibility and indirect diffuse and specular light on the CPU, which "
             "replace ambient occlusion; automatic: on from 32 samples if ssao.enabled."));
    table.push_back(
        make("rays.count", rays(&RaySettings::count),
             "Diffuse rays per pixel of an image, divided among its samples; each sample traces at least 4.",
             "", {1, 65536}));
}

void add_ground(Table& table) {
    const auto ground = [](auto member) { return at(&Settings::ground, member); };
    table.push_back(make("ground.mode", ground(&GroundSettings::mode),
                         "Ground plane under the content: none, a shadow catcher (shadow) over any "
                         "background, or a visible surface (plane)."));
    table.push_back(
        make("ground.height", ground(&GroundSettings::height),
             "Height of the ground along the up axis; automatic: the lowest point of the content.",
             "world units"));
    table.push_back(make("ground.shadow_strength", ground(&GroundSettings::strength),
                         "Opacity factor of the shadow catcher; 1 is physically based.", "", {0, 1}));
    table.push_back(color("ground.plane_color", ground(&GroundSettings::color),
                          "Base colour of the ground in mode plane."));
    table.push_back(make("ground.plane_roughness", ground(&GroundSettings::roughness),
                         "Perceptual roughness of the ground in mode plane.", "", {0, 1}));
    table.push_back(make("ground.radius", ground(&GroundSettings::radius),
                         "Distance from the content at which the ground in mode plane has faded into the "
                         "background; automatic: 12 radii of the content.",
                         "world units", {positive, unlimited}));
}

void add_bloom(Table& table) {
    const auto bloom = [](auto member) { return at(&Settings::bloom, member); };
    table.push_back(make("bloom.enabled", bloom(&BloomSettings::enabled),
                         "Enables bloom, applied in linear HDR before tone mapping."));
    table.push_back(make("bloom.intensity", bloom(&BloomSettings::intensity),
                         "Fraction of the light above the threshold that is scattered; energy is conserved.",
                         "", {0, 1}));
    table.push_back(
        make("bloom.threshold", bloom(&BloomSettings::threshold),
             "Bloom threshold on the largest of red, green and blue after exposure; 0 scatters all light.",
             "", {0, 1e6}));
    table.push_back(make("bloom.knee", bloom(&BloomSettings::knee),
                         "Width of the soft knee as a fraction of the threshold.", "", {0, 1}));
    table.push_back(
        make("bloom.levels", bloom(&BloomSettings::levels),
             "Number of mip levels of the bloom pyramid, which starts at a quarter of the resolution; "
             "automatic: up to 6, the widest texel an eighth of the smaller image side.",
             "", {1, 8}));
    table.push_back(make("bloom.suppress_fireflies", bloom(&BloomSettings::suppress_fireflies),
                         "Weights bright pixels down in the first bloom level to suppress fireflies, which "
                         "does not conserve energy; automatic: on if the threshold is above 0."));
}

void add_lens(Table& table) {
    const auto lens = [](auto member) { return at(&Settings::depth_of_field, member); };
    table.push_back(make("depth_of_field.enabled", lens(&DepthOfFieldSettings::enabled),
                         "Enables depth of field of a thin lens; perspective cameras only."));
    table.push_back(make("depth_of_field.f_number", lens(&DepthOfFieldSettings::f_number),
                         "Aperture in f-stops, focal length / aperture diameter; smaller values blur more.",
                         "", {0.1, 1000}));
    table.push_back(make("depth_of_field.focus_distance", lens(&DepthOfFieldSettings::focus_distance),
                         "Distance to the focal plane along the optical axis; automatic: the centre of the "
                         "content, evaluated for every image.",
                         "world units", {positive, unlimited}));
    table.push_back(make("depth_of_field.sensor_height", lens(&DepthOfFieldSettings::sensor_height),
                         "Sensor height, 0.024 for a full-frame camera if the world unit is the metre; "
                         "automatic: 5 % of the diagonal of the bounding box of the content.",
                         "world units", {positive, unlimited}));
    const auto motion = [](auto member) { return at(&Settings::motion_blur, member); };
    table.push_back(make("motion_blur.enabled", motion(&MotionBlurSettings::enabled),
                         "Enables motion blur of accumulated images, from the poses of camera and objects in "
                         "the previous image."));
    table.push_back(make("motion_blur.shutter", motion(&MotionBlurSettings::shutter),
                         "Fraction of the time since the previous image that the shutter is open; it closes "
                         "at the time of this image.",
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
