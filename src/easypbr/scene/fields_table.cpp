#include <fmt/format.h>

#include <utility>

#include "easypbr/core/image.h"
#include "easypbr/scene/field_builder.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"

namespace easypbr {
namespace detail {

template <>
const std::vector<std::string>& enum_names<Antialias>() {
    static const std::vector<std::string> names = {"none", "fxaa"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Projection>() {
    static const std::vector<std::string> names = {"perspective", "orthographic"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<DistortionModel>() {
    static const std::vector<std::string> names = {"brown_conrady", "fisheye"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<BackgroundMode>() {
    static const std::vector<std::string> names = {"color", "environment", "blur", "image", "transparent"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Brdf>() {
    static const std::vector<std::string> names = {"height_correlated", "separable", "ue4"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ShadowMode>() {
    static const std::vector<std::string> names = {"hard", "pcf", "soft"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<TransparencyMode>() {
    static const std::vector<std::string> names = {"layers", "stochastic"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ToneOperator>() {
    static const std::vector<std::string> names = {"aces", "reinhard", "agx", "neutral", "none"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<AlphaMode>() {
    static const std::vector<std::string> names = {"opaque", "mask", "blend"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<DrawMode>() {
    static const std::vector<std::string> names = {"mesh", "points", "surfels", "lines", "voxels"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<PointShape>() {
    static const std::vector<std::string> names = {"round", "square"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<SizeUnit>() {
    static const std::vector<std::string> names = {"pixels", "world"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<ColorBy>() {
    static const std::vector<std::string> names = {"solid",  "vertex", "texture", "label",    "scalar",
                                                   "height", "normal", "uv",      "intensity"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Corner>() {
    static const std::vector<std::string> names = {"top_left", "top_right", "bottom_left", "bottom_right"};
    return names;
}
template <>
const std::vector<std::string>& enum_names<Colormap>() {
    return colormap_names();
}

}  // namespace detail

namespace {

using namespace detail;

constexpr size_t max_clip_planes = 16;

void add_image(Table& table) {
    const auto image = [](auto member) { return at(&Settings::image, member); };
    table.push_back(make("image.size", image(&ImageSettings::size), "Width and height of the picture.",
                         "pixels", {1, max_image_side}));
    table.push_back(make("image.samples", image(&ImageSettings::samples),
                         "Jittered frames averaged for a still picture; 1 gives a single frame.", "",
                         {1, 65536}));
    table.push_back(make("image.antialias", image(&ImageSettings::antialias),
                         "Smoothing of edges in a single frame; stills are smoothed by their samples."));
}

void add_camera(Table& table) {
    const auto camera = [](auto member) { return at(&Settings::camera, member); };
    table.push_back(make("camera.projection", camera(&CameraSettings::projection),
                         "Perspective, or orthographic: without foreshortening."));
    table.push_back(
        make("camera.position", camera(&CameraSettings::position),
             "Where the camera stands in the world; automatic: so that the content fills the picture.",
             "world units"));
    table.push_back(make("camera.target", camera(&CameraSettings::target),
                         "The point the camera looks at; automatic: so that the content is in the middle.",
                         "world units"));
    table.push_back(
        with_choices(make("camera.up", camera(&CameraSettings::up),
                          "World axis that points up in the picture and to the sky of the environment."),
                     {"+x", "-x", "+y", "-y", "+z", "-z", "x", "y", "z"}));
    table.push_back(make("camera.fov_y_deg", camera(&CameraSettings::fov_y_deg),
                         "Full vertical opening angle of a perspective camera.", "degrees", {1, 170}));
    table.push_back(
        make("camera.ortho_height", camera(&CameraSettings::ortho_height),
             "World height of an orthographic picture; automatic: so that the content fills the picture.",
             "world units", {positive, unlimited}));
    table.push_back(make("camera.near", camera(&CameraSettings::near),
                         "Distance of the near plane; automatic: well before the content.", "world units",
                         {positive, unlimited}));
    table.push_back(
        make("camera.azimuth_deg", camera(&CameraSettings::azimuth_deg),
             "Direction an automatic camera looks from: 0 in front of the content, positive further right.",
             "degrees", {-360, 360}));
    table.push_back(
        make("camera.elevation_deg", camera(&CameraSettings::elevation_deg),
             "Height an automatic camera looks from: 0 level with the content, 90 straight above it.",
             "degrees", {-90, 90}));
    table.push_back(
        make("camera.margin", camera(&CameraSettings::margin),
             "Part of the picture that an automatic camera leaves free, both sides of an axis together.", "",
             {0, 0.9}));
    table.push_back(
        with_sizes(make("camera.pose", camera(&CameraSettings::pose),
                        "Camera-to-world matrix, 16 numbers row by row, axes x right, y up, z backwards; "
                        "replaces position and target."),
                   {0, 16}));
    table.push_back(
        with_sizes(make("camera.intrinsics", camera(&CameraSettings::intrinsics),
                        "fx, fy, cx, cy, width, height as OpenCV has them (pixel centres at integers), and "
                        "skew if there is any; replaces fov_y_deg.",
                        "pixels"),
                   {0, 6, 7}));
    table.push_back(make("camera.distortion_model", camera(&CameraSettings::distortion_model),
                         "What the coefficients of the lens's distortion mean, as OpenCV has them."));
    table.push_back(with_sizes(
        make("camera.distortion", camera(&CameraSettings::distortion),
             "Distortion of the lens: k1, k2, p1, p2, then k3, then k4, k5, k6; of a fisheye k1, k2, "
             "k3, k4. Needs camera.intrinsics."),
        {0, 4, 5, 8}));
}

void add_surroundings(Table& table) {
    const auto environment = [](auto member) { return at(&Settings::environment, member); };
    table.push_back(
        make("environment.file", environment(&EnvironmentSettings::file),
             "Equirectangular picture (HDR, EXR, PNG, JPEG) that lights the scene; empty: a studio."));
    table.push_back(make("environment.enabled", environment(&EnvironmentSettings::enabled),
                         "Whether an environment lights the scene; automatic: yes."));
    table.push_back(make("environment.rotation_deg", environment(&EnvironmentSettings::rotation_deg),
                         "Turns the environment about the up axis, counter-clockwise seen from above.",
                         "degrees", {-360, 360}));
    table.push_back(make("environment.intensity", environment(&EnvironmentSettings::intensity),
                         "Factor on the environment's light.", "", {0, 1e6}));
    table.push_back(
        make("environment.sun", environment(&EnvironmentSettings::sun),
             "Whether the environment's sun is a light of its own, which casts shadows; automatic: where "
             "a given environment has a sun."));

    const auto background = [](auto member) { return at(&Settings::background, member); };
    table.push_back(
        make("background.mode", background(&BackgroundSettings::mode),
             "What is seen behind the content: a colour, the environment, the environment blurred, an "
             "image, or nothing (alpha 0)."));
    table.push_back(color("background.color", background(&BackgroundSettings::color),
                          "Background colour, shown exactly: exposure and tone curve do not touch it."));
    table.push_back(make("background.image", background(&BackgroundSettings::image),
                         "Image file shown behind the content in mode 'image'."));
    table.push_back(make("background.blur", background(&BackgroundSettings::blur),
                         "How blurred the environment is in mode 'blur': 0 sharp, 1 soft.", "", {0, 1}));
}

void add_studio_light(Table& table, const std::string& name, StudioLight LightsSettings::*light) {
    const auto field = [&](auto member) { return at(&Settings::lights, light, member); };
    const std::string prefix = "lights." + name + ".", the = "the " + name + " light";
    table.push_back(make(prefix + "enabled", field(&StudioLight::enabled),
                         "Whether " + the + " is on; automatic: on when no environment was given."));
    table.push_back(
        make(prefix + "position", field(&StudioLight::position),
             "Where " + the + " stands in the world; automatic: placed relative to the first camera.",
             "world units"));
    table.push_back(color(prefix + "color", field(&StudioLight::color), "Colour of " + the + "."));
    table.push_back(
        make(prefix + "intensity", field(&StudioLight::intensity),
             "Luminous intensity of " + the + "; automatic: the same light on the content at any scale.",
             "candela", {0, unlimited}));
    table.push_back(make(prefix + "casts_shadows", field(&StudioLight::casts_shadows),
                         "Whether " + the + " casts shadows."));
    table.push_back(make(prefix + "radius", field(&StudioLight::radius),
                         "Radius of " + the +
                             ", which softens its shadows; automatic: three tenths of the "
                             "content's radius.",
                         "world units", {0, unlimited}));
}

void add_lights(Table& table) {
    table.push_back(make("lights.intensity", at(&Settings::lights, &LightsSettings::intensity),
                         "Factor on the key, fill and rim light together.", "", {0, 1e6}));
    add_studio_light(table, "key", &LightsSettings::key);
    add_studio_light(table, "fill", &LightsSettings::fill);
    add_studio_light(table, "rim", &LightsSettings::rim);
}

void add_shadows(Table& table) {
    const auto shadows = [](auto member) { return at(&Settings::shadows, member); };
    table.push_back(make("shadows.enabled", shadows(&ShadowSettings::enabled),
                         "Whether lights that cast shadows do so."));
    table.push_back(
        make("shadows.mode", shadows(&ShadowSettings::mode),
             "Soft: blurred by the light's radius the more the further the shadow falls; pcf: the "
             "mean of 3x3 texels of the shadow map; hard: one texel."));
    table.push_back(make("shadows.resolution", shadows(&ShadowSettings::resolution),
                         "Side of a shadow map; more resolves finer shadows.", "texels", {16, 8192}));
}

void add_shading(Table& table) {
    const auto shading = [](auto member) { return at(&Settings::shading, member); };
    table.push_back(
        make("shading.brdf", shading(&ShadingSettings::brdf),
             "Geometry term of the GGX reflection: height-correlated Smith, separable Smith, or the "
             "approximation of Unreal Engine 4."));
    table.push_back(
        make("shading.multiple_scattering", shading(&ShadingSettings::multiple_scattering),
             "Adds the light that bounces several times within a rough surface, so that none is lost."));
    table.push_back(make("shading.dielectric_f0", shading(&ShadingSettings::dielectric_f0),
                         "Reflectance of non-metals at normal incidence.", "", {0, 1}));

    const auto eye_dome = [](auto member) { return at(&Settings::edl, member); };
    table.push_back(
        make("edl.enabled", eye_dome(&EdlSettings::enabled),
             "Eye-dome lighting of points without normals: what lies behind an edge is darkened."));
    table.push_back(make("edl.strength", eye_dome(&EdlSettings::strength),
                         "How much eye-dome lighting darkens.", "", {0, 100}));
    table.push_back(
        make("edl.radius", eye_dome(&EdlSettings::radius),
             "Distance at which eye-dome lighting looks for edges, in pixels of a picture 1080 high.",
             "pixels", {0.1, 100}));

    const auto transparency = [](auto member) { return at(&Settings::transparency, member); };
    table.push_back(
        make("transparency.mode", transparency(&TransparencySettings::mode),
             "How blended surfaces are drawn: in layers, exact at any number of samples, or stochastically, "
             "in a part of the samples, which is quicker where very many lie behind each other."));
    table.push_back(make(
        "transparency.max_layers", transparency(&TransparencySettings::max_layers),
        "How many surfaces behind each other are drawn apart, from the farthest on; of those beyond only "
        "the nearest is drawn.",
        "", {1, 10000}));

    const auto tone = [](auto member) { return at(&Settings::tonemap, member); };
    table.push_back(make("tonemap.operator", tone(&TonemapSettings::tone_operator),
                         "Curve from scene light to the picture's range."));
    table.push_back(
        make("tonemap.exposure", tone(&TonemapSettings::exposure),
             "Factor on scene light before the tone curve; automatic: a white surface facing the camera "
             "averages 1.",
             "", {0, 1e30}));
    table.push_back(make("tonemap.exposure_compensation", tone(&TonemapSettings::exposure_compensation),
                         "Makes the picture brighter or darker by this many doublings.", "stops", {-30, 30}));
}

void add_extended_overrides(Table& table) {
    const auto material = [](auto member) { return at(&Settings::material, member); };
    const std::string own = " of every material; automatic: the material's own.";
    const auto number = [&](const std::string& name, auto member, const std::string& doc, Range range,
                            const std::string& unit = {}) {
        table.push_back(make("material." + name, material(member), doc + own, unit, range));
    };
    const auto tint = [&](const std::string& name, auto member, const std::string& doc) {
        table.push_back(color("material." + name, material(member), doc + own));
    };
    using M = MaterialSettings;
    table.push_back(make("material.alpha_mode", material(&M::alpha_mode),
                         "Whether opacity is ignored, cuts holes, or blends, for every material; automatic: "
                         "the material's own."));
    number("opacity", &M::opacity, "Opacity, 0 clear to 1 opaque,", {0, 1});
    number("clearcoat", &M::clearcoat, "Layer of clear varnish, 0 to 1,", {0, 1});
    number("clearcoat_roughness", &M::clearcoat_roughness, "Roughness of the varnish", {0, 1});
    tint("sheen_color", &M::sheen_color, "Colour of the sheen of cloth");
    number("sheen_roughness", &M::sheen_roughness, "Roughness of the sheen", {0, 1});
    number("ior", &M::ior, "Index of refraction, at least 1,", {1, 100});
    number("specular", &M::specular, "Strength of a non-metal's reflection, 0 to 1,", {0, 1});
    tint("specular_color", &M::specular_color, "Tint of a non-metal's reflection");
    number("transmission", &M::transmission, "Part of the light that goes through, 0 to 1,", {0, 1});
    number("thickness", &M::thickness, "Thickness of the volume, 0 for thin-walled,", {0, unlimited},
           "mesh units");
    tint("attenuation_color", &M::attenuation_color, "Colour of white light after attenuation_distance");
    number("attenuation_distance", &M::attenuation_distance,
           "Distance within the volume that gives light the attenuation colour", {positive, unlimited},
           "world units");
    number("iridescence", &M::iridescence, "Strength of a thin film's colours, 0 to 1,", {0, 1});
    number("iridescence_ior", &M::iridescence_ior, "Index of refraction of the thin film", {1, 100});
    number("iridescence_thickness", &M::iridescence_thickness, "Thickness of the thin film", {0, 1e6},
           "nanometres");
    number("anisotropy", &M::anisotropy, "How far reflections are drawn out, 0 to 1,", {0, 1});
    number("anisotropy_rotation_deg", &M::anisotropy_rotation_deg,
           "Direction of the anisotropy, from the tangent,", {-360, 360}, "degrees");
}

void add_overrides(Table& table) {
    const auto material = [](auto member) { return at(&Settings::material, member); };
    const auto file = [&](const std::string& name, std::string MaterialSettings::*member,
                          const std::string& doc) {
        table.push_back(make("material." + name, material(member), doc + " Empty: the material's own."));
    };
    table.push_back(color("material.color", material(&MaterialSettings::color),
                          "Base colour of every material; automatic: the material's own."));
    table.push_back(make(
        "material.metallic", material(&MaterialSettings::metallic),
        "Metalness of every material, 0 dielectric to 1 metal; automatic: the material's own.", "", {0, 1}));
    table.push_back(make("material.roughness", material(&MaterialSettings::roughness),
                         "Perceptual roughness of every material; automatic: the material's own.", "",
                         {0, 1}));
    table.push_back(color("material.emissive", material(&MaterialSettings::emissive),
                          "Colour that every material glows in; automatic: the material's own."));
    add_extended_overrides(table);
    for (const MaterialTexture& row : replaceable_textures())
        file(std::string(row.name) + "_texture", row.setting,
             fmt::format("Image file for the {} of every material.", row.content));
    file("shader", &MaterialSettings::shader,
         "File with GLSL that changes the surface of every material, read again whenever it changes.");
}

/// Each is a row of every object's style and, as a setting, overrides them all.
void add_style(Table& table) {
    const auto add = [&](const std::string& name, auto member, const std::string& doc,
                         const std::string& inferred, const std::string& unit = {}, Range range = {}) {
        table.push_back(make("style." + name, at(&Settings::style, member),
                             doc + " Automatic: the object's own choice, else " + inferred + ".", unit,
                             range));
    };
    add("mode", &Style::mode, "What objects are drawn as.",
        "faces as a mesh, voxels as cubes, normals with tangents as surfels, edges as lines, and vertices "
        "alone "
        "as points");
    add("visible", &Style::visible, "Whether objects are drawn.", "yes");
    add("point_size", &Style::point_size, "Diameter of points, in point_size_unit.",
        "as large as the points' mean spacing", "", {positive, unlimited});
    add("point_size_unit", &Style::point_size_unit,
        "Whether point_size is in pixels, or in world units and so smaller far away.", "pixels");
    add("point_shape", &Style::point_shape, "Round or square points.", "round");
    add("surfel_scale", &Style::surfel_scale, "Factor on the size of surfels.", "1", "", {positive, 1e6});
    add("voxel_size", &Style::voxel_size, "Edge of the cubes of voxels.",
        "the data's, or the points' mean spacing", "world units", {positive, unlimited});
    add("line_width", &Style::line_width, "Width of lines, edges and normals.", "1.5", "pixels", {0.1, 1000});
    add("line_dash", &Style::line_dash, "Length of dashes and of the gaps between them; 0 for solid lines.",
        "0", "pixels", {0, 10000});
    table.push_back(
        color("style.line_color", at(&Settings::style, &Style::line_color),
              "Colour of edges, wireframes and normals. Automatic: the object's own choice, else the "
              "vertices' colours for edges, dark for wireframes and blue for normals."));
    add("show_wireframe", &Style::show_wireframe, "The edges of faces are drawn on top of them.", "no");
    add("show_normals", &Style::show_normals, "A line along each vertex normal is drawn.", "no");
    add("normal_length", &Style::normal_length, "Length of the lines of show_normals.",
        "2 % of the object's diagonal", "world units", {positive, unlimited});
    add("show_points", &Style::show_points, "The vertices are drawn as points on top.", "no");
    add("two_sided", &Style::two_sided, "Back faces are drawn, lit from their side.",
        "the material's choice");
    add("flat", &Style::flat, "One normal per face.", "no");
    add("lit", &Style::lit, "Whether light shades the colours; otherwise they are shown as they are.",
        "yes for faces, surfels, voxels and points with normals, no for labels of points and for points "
        "without "
        "normals");
    add("overlay", &Style::overlay, "Drawn over everything else, whatever is in front.", "no");
    add("color_by", &Style::color_by, "What colours objects.",
        "labels, else textures and vertex colours, else scalars, else intensities of points, else the "
        "material");
    add("scalar", &Style::scalar, "Name of the scalars that colour objects; chooses color_by scalar.",
        "the first that were added");
    add("colormap", &Style::colormap, "Colours of scalars, heights and intensities.",
        "grey for intensities, else viridis");
    add("color_min", &Style::color_min, "Value that has the colormap's first colour; lower ones have it too.",
        "the smallest, or the first percentile where outliers would take most of the colours", "",
        {-1e38, 1e38});
    add("color_max", &Style::color_max, "Value that has the colormap's last colour; higher ones have it too.",
        "the largest, or the 99th percentile where outliers would take most of the colours", "",
        {-1e38, 1e38});
    table.push_back(color("style.nan_color", at(&Settings::style, &Style::nan_color),
                          "Colour of what has no value (NaN). Automatic: the object's own choice, else grey, "
                          "with the colormap grey magenta."));
}

void add_clipping(Table& table) {
    table.push_back(make("points.hole_filling", at(&Settings::points, &PointsSettings::hole_filling),
                         "Times that gaps of a pixel between points are closed with what surrounds them.", "",
                         {0, 32}));
    std::vector<size_t> lengths;
    for (size_t planes = 0; planes <= max_clip_planes; ++planes) lengths.push_back(4 * planes);
    table.push_back(with_sizes(make("clip.planes", at(&Settings::clip, &ClipSettings::planes),
                                    "Planes that cut every object, four numbers nx, ny, nz, d each, in world "
                                    "space: what lies at n . p + d >= 0 is kept."),
                               lengths));
    table.push_back(with_sizes(
        make("clip.box", at(&Settings::clip, &ClipSettings::box),
             "Box that every object is cut to: least x, y, z, then largest x, y, z.", "world units"),
        {0, 6}));
}

void add_annotation(Table& table) {
    const auto annotation = [](auto member) { return at(&Settings::annotation, member); };
    table.push_back(
        make("annotation.legend", annotation(&AnnotationSettings::legend),
             "Whether the picture has a legend of the labels that colour objects; automatic: no."));
    table.push_back(
        make("annotation.colorbar", annotation(&AnnotationSettings::colorbar),
             "Whether the picture has a colour bar of the values that colour objects; automatic: no."));
    table.push_back(make("annotation.title", annotation(&AnnotationSettings::title),
                         "Title of legends and colour bars; empty: the values' name, none for legends."));
    table.push_back(make("annotation.corner", annotation(&AnnotationSettings::corner),
                         "Corner of the picture that they stand in."));
    table.push_back(make("annotation.text_size", annotation(&AnnotationSettings::text_size),
                         "Size of the text, as a part of the picture's height.", "", {0.005, 0.2}));
}

void add_loading(Table& table) {
    table.push_back(
        make("load.crease_deg", at(&Settings::load, &LoadSettings::crease_deg),
             "Angle between faces beyond which an STL file keeps an edge, when the command line reads "
             "it.",
             "degrees", {0, 180}));
}

}  // namespace

const std::vector<Field>& fields() {
    static const Table table = [] {
        Table all;
        add_image(all);
        add_camera(all);
        add_surroundings(all);
        add_lights(all);
        add_shadows(all);
        add_shading(all);
        detail::add_effects(all);
        add_overrides(all);
        add_style(all);
        add_clipping(all);
        add_annotation(all);
        add_loading(all);
        return all;
    }();
    return table;
}

}  // namespace easypbr
