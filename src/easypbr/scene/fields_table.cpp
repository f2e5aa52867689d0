#include <fmt/format.h>

#include <utility>

#include "easypbr/core/image.h"
#include "easypbr/scene/effect_settings.h"
#include "easypbr/scene/enum_names.h"
#include "easypbr/scene/field_builder.h"
#include "easypbr/scene/fields.h"
#include "easypbr/scene/material_table.h"
#include "easypbr/scene/near_plane.h"
#include "easypbr/scene/settings.h"

namespace easypbr {
namespace {

using namespace detail;

constexpr size_t max_clip_planes = 16;

void add_image(Table& table) {
    table.push_back(make("image.size", EASYPBR_AT(image.size), "Width and height of the image.", "pixels",
                         {1, max_image_side}));
    table.push_back(
        make("image.samples", EASYPBR_AT(image.samples),
             "Number of jittered samples averaged per pixel; 1 draws a single frame without accumulation.",
             "", {1, 65536}));
    table.push_back(make(
        "image.noise", EASYPBR_AT(image.noise),
        "Path traced images take no further sample once their noise is below: the standard error of what "
        "is displayed, of white, before it is denoised, in 95 of 100 squares of 16 by 16 pixels. 0: they "
        "take all samples.",
        "", {0, 1}));
    table.push_back(make("image.time_budget", EASYPBR_AT(image.time_budget),
                         "Time after which an image takes no further sample; the first is always taken, and "
                         "does not count as the length of others. 0 is unlimited.",
                         "seconds", {0, 1e6}));
    table.push_back(
        make("image.antialias", EASYPBR_AT(image.antialias),
             "Anti-aliasing of a single frame; an accumulated image is anti-aliased by its samples."));
}

void add_camera(Table& table) {
    table.push_back(make("camera.projection", EASYPBR_AT(camera.projection),
                         "Camera projection, perspective or orthographic."));
    table.push_back(make("camera.position", EASYPBR_AT(camera.position),
                         "Camera position in world space; automatic: frames the content.", "world units"));
    table.push_back(make("camera.target", EASYPBR_AT(camera.target),
                         "Point in world space that the camera looks at; automatic: centres the content.",
                         "world units"));
    table.push_back(with_choices(
        make("camera.up", EASYPBR_AT(camera.up),
             "World axis that points up, for the camera, the environment and the ground; automatic: "
             "that of the file's format, else +z of a height field z = f(x, y), else that of the ground that "
             "the content clearly stands on, else +y."),
        {"+x", "-x", "+y", "-y", "+z", "-z", "x", "y", "z"}));
    table.push_back(make("camera.fov_y_deg", EASYPBR_AT(camera.fov_y_deg),
                         "Vertical field of view of a perspective camera.", "degrees", {1, 170}));
    table.push_back(
        make("camera.ortho_height", EASYPBR_AT(camera.ortho_height),
             "Height of the view volume of an orthographic camera; automatic: frames the content.",
             "world units", {positive, unlimited}));
    table.push_back(
        make("camera.near", EASYPBR_AT(camera.near),
             fmt::format("Distance to the near clipping plane; automatic: {} of the smallest depth of the "
                         "content, but at least {} of the distance to the target.",
                         near_part_of_depth, least_near_part),
             "world units", {positive, unlimited}));
    table.push_back(make("camera.azimuth_deg", EASYPBR_AT(camera.azimuth_deg),
                         "Azimuth of an automatic camera: 0 in front of the content, positive to its right; "
                         "automatic: 30, or where the camera of a depth image stood.",
                         "degrees", {-360, 360}));
    table.push_back(make("camera.elevation_deg", EASYPBR_AT(camera.elevation_deg),
                         "Elevation of an automatic camera: 0 level with the content, 90 directly above it; "
                         "automatic: 15, or where the camera of a depth image stood.",
                         "degrees", {-90, 90}));
    table.push_back(make("camera.margin", EASYPBR_AT(camera.margin),
                         "Fraction of the image left free around the content by an automatic camera, both "
                         "sides of an axis together.",
                         "", {0, 0.9}));
    table.push_back(with_sizes(make("camera.pose", EASYPBR_AT(camera.pose),
                                    "Camera-to-world matrix, 16 numbers in row-major order, OpenGL axes (x "
                                    "right, y up, z backwards); overrides position and target."),
                               {0, 16}));
    table.push_back(
        with_sizes(make("camera.intrinsics", EASYPBR_AT(camera.intrinsics),
                        "Pinhole intrinsics fx, fy, cx, cy, width, height and optionally skew, in the OpenCV "
                        "convention (pixel centres at integers); overrides fov_y_deg.",
                        "pixels"),
                   {0, 6, 7}));
    table.push_back(
        make("camera.distortion_model", EASYPBR_AT(camera.distortion_model),
             "Lens distortion model of the coefficients in camera.distortion, as defined by OpenCV."));
    table.push_back(
        with_sizes(make("camera.distortion", EASYPBR_AT(camera.distortion),
                        "Lens distortion coefficients in the order of OpenCV: k1, k2, p1, p2, optionally k3, "
                        "optionally k4, k5, k6; fisheye: k1, k2, k3, k4. Requires camera.intrinsics."),
                   {0, 4, 5, 8}));
}

void add_surroundings(Table& table) {
    table.push_back(make("environment.file", EASYPBR_AT(environment.file),
                         "Equirectangular environment map (HDR, EXR, PNG, JPEG) for image-based lighting; "
                         "empty: a built-in studio."));
    table.push_back(make("environment.enabled", EASYPBR_AT(environment.enabled),
                         "Enables image-based lighting; automatic: on."));
    table.push_back(
        make("environment.rotation_deg", EASYPBR_AT(environment.rotation_deg),
             "Rotation of the environment map about the up axis, counter-clockwise seen from above.",
             "degrees", {-360, 360}));
    table.push_back(not_kept(
        make("environment.intensity", EASYPBR_AT(environment.intensity),
             "Scale factor of the radiance of the environment map; automatic: 1, and 0.2 for the built-in "
             "studio, so that the key light gives most of the light.",
             "", {0, 1e6})));
    table.push_back(make("environment.sun", EASYPBR_AT(environment.sun),
                         "Extracts the sun of the environment map as a directional light that casts shadows; "
                         "automatic: on if a given environment map contains a sun."));

    table.push_back(make("background.mode", EASYPBR_AT(background.mode),
                         "Background: a constant colour, the environment map, the environment map blurred, "
                         "an image file, or transparent (alpha 0)."));
    table.push_back(
        color("background.color", EASYPBR_AT(background.color),
              "Background colour in mode color; exposure and tone mapping are not applied to it."));
    table.push_back(
        make("background.image", EASYPBR_AT(background.image),
             "Image file of the background in mode image; exposure and tone mapping are not applied "
             "to it, its alpha shows background.color, and EXIF's orientation of JPEG files counts."));
    table.push_back(make("background.blur", EASYPBR_AT(background.blur),
                         "Blur of the environment map in mode blur: 0 none, 1 the most.", "", {0, 1}));
}

template <class Access>
void add_studio_light(Table& table, const std::string& name, const std::string& automatic,
                      const std::string& also, Access light) {
    const auto field = [light](auto member) {
        return [=](auto& settings) -> auto& {
            return member(light(settings));
        };
    };
    const std::string prefix = "lights." + name + ".", the = "the " + name + " light";
    table.push_back(make(prefix + "enabled", field(EASYPBR_AT(enabled)),
                         "Enables " + the + "; automatic: " + automatic + "."));
    table.push_back(make(
        prefix + "position", field(EASYPBR_AT(position)),
        "Position of " + the + " in world space; automatic: placed relative to the first camera" + also + ".",
        "world units"));
    table.push_back(color(prefix + "color", field(EASYPBR_AT(color)), "Colour of " + the + "."));
    table.push_back(make(
        prefix + "intensity", field(EASYPBR_AT(intensity)),
        "Luminous intensity of " + the + "; automatic: gives the content the same irradiance at any scale.",
        "candela", {0, unlimited}));
    table.push_back(make(prefix + "casts_shadows", field(EASYPBR_AT(casts_shadows)),
                         "Enables the shadows of " + the + "."));
    table.push_back(make(prefix + "radius", field(EASYPBR_AT(radius)),
                         "Radius of " + the +
                             " as a spherical emitter, which sets the size of its penumbrae; automatic: 0.3 "
                             "of the radius of the content.",
                         "world units", {0, unlimited}));
}

void add_lights(Table& table) {
    table.push_back(make("lights.intensity", EASYPBR_AT(lights.intensity),
                         "Scale factor of the intensity of the key, fill and rim lights.", "", {0, 1e6}));
    add_studio_light(table, "key", "on if no environment map is given", ", beside it within closed content",
                     EASYPBR_AT(lights.key));
    add_studio_light(table, "fill", "off", "", EASYPBR_AT(lights.fill));
    add_studio_light(table, "rim", "off", "", EASYPBR_AT(lights.rim));
}

void add_shadows(Table& table) {
    table.push_back(make("shadows.enabled", EASYPBR_AT(shadows.enabled), "Enables shadows."));
    table.push_back(
        make("shadows.mode", EASYPBR_AT(shadows.mode),
             "Shadow filter: percentage-closer soft shadows with penumbrae from the size of the light "
             "(soft), percentage-closer filtering of 3x3 texels (pcf), or no filter (hard)."));
    table.push_back(make("shadows.resolution", EASYPBR_AT(shadows.resolution),
                         "Width and height of a shadow map.", "texels", {16, 8192}));
}

void add_shading(Table& table) {
    table.push_back(make("shading.brdf", EASYPBR_AT(shading.brdf),
                         "Masking-shadowing function of the GGX specular BRDF: height-correlated Smith, "
                         "separable Smith, or the Schlick approximation of Unreal Engine 4."));
    table.push_back(make("shading.multiple_scattering", EASYPBR_AT(shading.multiple_scattering),
                         "Enables multiple-scattering energy compensation of the specular BRDF and, in path "
                         "traced images, of transmission through rough surfaces."));
    table.push_back(make("shading.dielectric_f0", EASYPBR_AT(shading.dielectric_f0),
                         "Reflectance F0 of dielectrics at normal incidence, for materials with the default "
                         "index of refraction.",
                         "", {0, 1}));

    table.push_back(
        make("edl.enabled", EASYPBR_AT(edl.enabled),
             "Enables eye-dome lighting of points without normals that are lit, which darkens depth "
             "discontinuities."));
    table.push_back(
        make("edl.strength", EASYPBR_AT(edl.strength), "Strength of eye-dome lighting.", "", {0, 100}));
    table.push_back(make("edl.radius", EASYPBR_AT(edl.radius),
                         "Sampling radius of eye-dome lighting, in pixels of an image 1080 pixels high.",
                         "pixels", {0.1, 100}));

    table.push_back(make("transparency.mode", EASYPBR_AT(transparency.mode),
                         "Transparency algorithm: depth peeling (layers), exact at any number of samples, or "
                         "stochastic transparency, faster for very many layers but noisy."));
    table.push_back(make("transparency.max_layers", EASYPBR_AT(transparency.max_layers),
                         "Maximum number of transparent layers peeled per pixel, farthest first; of the "
                         "layers in front of them only the nearest is drawn.",
                         "", {1, 10000}));

    table.push_back(make("tonemap.operator", EASYPBR_AT(tonemap.tone_operator), "Tone mapping operator."));
    table.push_back(make("tonemap.exposure", EASYPBR_AT(tonemap.exposure),
                         "Exposure: linear scale factor applied before tone mapping; automatic: metered so "
                         "that a white diffuse surface facing the camera has a mean radiance of 1.",
                         "", {0, 1e30}));
    table.push_back(make("tonemap.exposure_compensation", EASYPBR_AT(tonemap.exposure_compensation),
                         "Exposure compensation in EV.", "EV", {-30, 30}));
}

/// Access to an override of materials.
template <class Member>
auto in_material(Member member) {
    return [member](auto& settings) -> auto& {
        return settings.material.*member;
    };
}

void add_extended_overrides(Table& table) {
    const std::string own = " of every material; automatic: the material's own.";
    const auto number = [&](const std::string& name, auto member, const std::string& doc, Range range,
                            const std::string& unit = {}) {
        table.push_back(make("material." + name, in_material(member), doc + own, unit, range));
    };
    const auto tint = [&](const std::string& name, auto member, const std::string& doc) {
        table.push_back(color("material." + name, in_material(member), doc + own));
    };
    using M = MaterialSettings;
    table.push_back(make("material.alpha_mode", EASYPBR_AT(material.alpha_mode),
                         "Alpha mode of every material as in glTF: opaque, mask (alpha cutoff) or blend; "
                         "automatic: the material's own."));
    number("opacity", &M::opacity, "Opacity, 0 transparent to 1 opaque,", {0, 1});
    number("clearcoat", &M::clearcoat, "Clearcoat strength", {0, 1});
    number("clearcoat_roughness", &M::clearcoat_roughness, "Clearcoat roughness", {0, 1});
    tint("sheen_color", &M::sheen_color, "Sheen colour");
    number("sheen_roughness", &M::sheen_roughness, "Sheen roughness", {0, 1});
    number("ior", &M::ior, "Index of refraction", {1, 100});
    number("specular", &M::specular, "Strength of the specular reflection of dielectrics", {0, 1});
    tint("specular_color", &M::specular_color, "Specular colour of dielectrics at normal incidence");
    number("transmission", &M::transmission,
           "Transmission, the fraction of light transmitted by dielectrics,", {0, 1});
    number("thickness", &M::thickness, "Thickness of the volume below the surface, 0 for thin-walled,",
           {0, unlimited}, "mesh units");
    tint("attenuation_color", &M::attenuation_color, "Colour of white light after the attenuation distance");
    number("attenuation_distance", &M::attenuation_distance,
           "Distance in the volume after which white light has the attenuation colour", {positive, unlimited},
           "world units");
    number("dispersion", &M::dispersion, "Dispersion of the volume below the surface, 20 / Abbe number,",
           {0, 40});
    number("iridescence", &M::iridescence, "Iridescence strength", {0, 1});
    number("iridescence_ior", &M::iridescence_ior, "Index of refraction of the thin film", {1, 100});
    number("iridescence_thickness", &M::iridescence_thickness, "Thickness of the thin film", {0, 1e6},
           "nanometres");
    number("anisotropy", &M::anisotropy, "Anisotropy strength", {0, 1});
    number("anisotropy_rotation_deg", &M::anisotropy_rotation_deg,
           "Rotation of the anisotropy, counter-clockwise from the tangent,", {-360, 360}, "degrees");
}

void add_overrides(Table& table) {
    const auto file = [&](const std::string& name, NamedFile MaterialSettings::*member,
                          const std::string& doc) {
        table.push_back(make("material." + name, in_material(member), doc + " Empty: the material's own."));
    };
    table.push_back(color("material.color", EASYPBR_AT(material.color),
                          "Base colour of every material, but where labels, scalars or other data colour; "
                          "automatic: the material's own."));
    table.push_back(
        make("material.metallic", EASYPBR_AT(material.metallic),
             "Metallic factor of every material, 0 dielectric to 1 metal; automatic: the material's own.", "",
             {0, 1}));
    table.push_back(
        make("material.roughness", EASYPBR_AT(material.roughness),
             "Perceptual roughness of every material, alpha = roughness^2; automatic: the material's own.",
             "", {0, 1}));
    table.push_back(color("material.emissive", EASYPBR_AT(material.emissive),
                          "Emitted radiance of every material; automatic: the material's own."));
    add_extended_overrides(table);
    for (const MaterialTexture& row : replaceable_textures())
        file(std::string(row.name) + "_texture", row.setting, row.setting_doc);
    file("shader", &MaterialSettings::shader,
         "GLSL surface shader file of every material, reloaded when it changes.");
}

/// Each is a row of every object's style and, as a setting, overrides them all.
void add_style(Table& table) {
    const auto add = [&](const std::string& name, auto member, const std::string& doc,
                         const std::string& inferred, const std::string& unit = {}, Range range = {}) {
        table.push_back(make(
            "style." + name, [member](auto& settings) -> auto& { return settings.style.*member; },
            doc + " Automatic: the object's own value, else " + inferred + ".", unit, range));
    };
    add("mode", &Style::mode, "Primitive that objects are drawn as.",
        "voxels for data with a voxel size, splats for 3D Gaussians, a mesh for faces, surfels for normals "
        "with tangents, lines for edges, and points for vertices alone");
    add("visible", &Style::visible, "Visibility of objects.", "yes");
    add("point_size", &Style::point_size, "Diameter of points, in point_size_unit.",
        "1.5 mean spacings of the points, at most 1.5 % of the cloud", "", {positive, unlimited});
    add("point_size_unit", &Style::point_size_unit,
        "Unit of point_size: pixels, or world units, which shrink with distance.", "pixels");
    add("point_shape", &Style::point_shape, "Shape of points.", "round");
    add("surfel_scale", &Style::surfel_scale, "Scale factor of the size of surfels.", "1", "",
        {positive, 1e6});
    add("splat_antialias", &Style::splat_antialias,
        "Keeps the light of splats that are smaller than a pixel, which are widened to about one: their "
        "opacity is lowered as they grow. For scenes that were trained this way.",
        "no");
    add("voxel_size", &Style::voxel_size, "Edge length of voxels.",
        "the voxel size of the data, or the mean spacing of the points", "mesh units", {positive, unlimited});
    add("line_width", &Style::line_width, "Width of lines, wireframes and normals.", "1.5", "pixels",
        {0.1, 1000});
    add("line_dash", &Style::line_dash, "Length of dashes and of the gaps between them; 0 draws solid lines.",
        "0", "pixels", {0, 10000});
    table.push_back(color("style.line_color", EASYPBR_AT(style.line_color),
                          "Colour of lines, wireframes and normals. Automatic: the object's own value, else "
                          "the colours of the data or of the material for lines that have any; dark for "
                          "others and for wireframes, blue for normals."));
    add("show_wireframe", &Style::show_wireframe, "Draws the edges of the faces as a wireframe.", "no");
    add("show_normals", &Style::show_normals, "Draws a line along each vertex normal.", "no");
    add("normal_length", &Style::normal_length, "Length of the lines drawn by show_normals.",
        "2 % of the diagonal of the object's bounding box", "world units", {positive, unlimited});
    add("show_points", &Style::show_points, "Draws the vertices as points too.", "no");
    add("two_sided", &Style::two_sided,
        "Draws back faces, with the normal towards the viewer; disables back-face culling.",
        "the material's double_sided");
    add("flat", &Style::flat, "Enables flat shading, with one normal per face.", "no");
    add("lit", &Style::lit, "Enables lighting; without it the colours are shown unchanged.",
        "yes, but for labelled points; points without normals are shaded by eye-dome lighting then");
    add("overlay", &Style::overlay, "Draws objects over all others, without a depth test against them.",
        "no");
    add("color_by", &Style::color_by, "Source of the colours of objects.",
        "labels, else textures and vertex colours, else scalars, else intensities of points, else the "
        "material");
    add("scalar", &Style::scalar, "Name of the scalar field that colours objects; implies color_by scalar.",
        "the first that was added");
    add("colormap", &Style::colormap,
        "Colour map of scalars, heights and intensities: a name, or colours from the least to the largest "
        "value.",
        "grey for intensities, else viridis");
    add("color_min", &Style::color_min,
        "Value mapped to the first colour of the colour map; lower values are clamped.",
        "the minimum, or the 1st percentile if outliers would take up most of the range", "", {-1e38, 1e38});
    add("color_max", &Style::color_max,
        "Value mapped to the last colour of the colour map; higher values are clamped.",
        "the maximum, or the 99th percentile if outliers would take up most of the range", "", {-1e38, 1e38});
    add("color_scale", &Style::color_scale,
        "Scale of the values over the colour map; on a logarithmic one values that are not above 0 "
        "are missing values.",
        "linear");
    add("color_steps", &Style::color_steps,
        "Number of bands of one colour each that the colour map is drawn in; 0 draws it continuously.", "0",
        "", {0, 256});
    table.push_back(color("style.nan_color", EASYPBR_AT(style.nan_color),
                          "Colour of missing values (NaN). Automatic: the object's own value, else grey, or "
                          "magenta with the colour map grey."));
}

void add_clipping(Table& table) {
    table.push_back(
        make("splats.cast", EASYPBR_AT(splats.cast),
             "3D Gaussian splats cast shadows with their opacity, and are seen in mirrors and through glass "
             "where rays or paths are traced."));
    table.push_back(make("splats.receive", EASYPBR_AT(splats.receive),
                         "Surfaces darken 3D Gaussian splats where they hide lights and sky from them."));
    table.push_back(make("splats.resort", EASYPBR_AT(splats.resort),
                         "Splats are blended in the order of their depths in each pixel, in place of one "
                         "order for the whole image: nothing pops when the camera moves. Slower."));
    table.push_back(
        make("splats.soft", EASYPBR_AT(splats.soft),
             "A surface that a splat passes through hides the part of it that is behind. Off: all "
             "of the splat is hidden in a pixel, or nothing, by where it is densest."));
    table.push_back(
        make("splats.relight", EASYPBR_AT(splats.relight),
             "Lamps and sky light splats, in place of their own colours: an approximation that takes "
             "their colour of degree 0 for the albedo, and their thinnest axis for the normal."));
    table.push_back(
        make("splats.depth", EASYPBR_AT(splats.depth),
             "What the layer depth holds of splats: the depth at which half of the light is stopped, or "
             "the expected depth, the mean weighed by what each splat adds to the pixel."));
    table.push_back(
        make("points.hole_filling", EASYPBR_AT(points.hole_filling),
             "Number of passes that fill one-pixel holes between points from the neighbouring pixels.", "",
             {0, 32}));
    std::vector<size_t> lengths;
    for (size_t planes = 0; planes <= max_clip_planes; ++planes) lengths.push_back(4 * planes);
    table.push_back(with_sizes(make("clip.planes", EASYPBR_AT(clip.planes),
                                    "Clipping planes in world space, four numbers nx, ny, nz, d each; points "
                                    "p with n . p + d >= 0 are kept."),
                               lengths));
    table.push_back(with_box(
        make("clip.box", EASYPBR_AT(clip.box),
             "Clipping box in world space, minimum x, y, z, then maximum x, y, z; its inside is kept.",
             "world units")));
}

void add_annotation(Table& table) {
    table.push_back(make("annotation.legend", EASYPBR_AT(annotation.legend),
                         "Draws a legend of the labels that colour objects; automatic: no."));
    table.push_back(make("annotation.colorbar", EASYPBR_AT(annotation.colorbar),
                         "Draws a colour bar of the values that colour objects; automatic: no."));
    table.push_back(make("annotation.title", EASYPBR_AT(annotation.title),
                         "Title of legends and colour bars; empty: the name of the values for colour bars, "
                         "none for legends."));
    table.push_back(make("annotation.corner", EASYPBR_AT(annotation.corner),
                         "Corner of the image that legends and colour bars are placed in."));
    table.push_back(make(
        "annotation.text_size", EASYPBR_AT(annotation.text_size),
        "Text size as a fraction of the shorter side of the image, but at least 11 pixels where that fits, "
        "and up to a third smaller where only that fits beside the content.",
        "", {0.005, 0.2}));
}

void add_loading(Table& table) {
    table.push_back(
        make("load.crease_deg", EASYPBR_AT(load.crease_deg),
             "Crease angle of meshes without normals that are not drawn flat: edges between faces at "
             "a larger angle are sharp; automatic: 60, and 30 for STL files; 180: none is.",
             "degrees", {0, 180}));
    table.push_back(make("load.variant", EASYPBR_AT(load.variant),
                         "Material variant of glTF files loaded by the command line and the window, by name; "
                         "empty: the file's own materials."));
    table.push_back(
        make("limits.memory", EASYPBR_AT(limits.memory),
             "Most that the arrays and images of a file may take when the command line or the window "
             "loads it; a file that asks for more is refused. 0: three quarters of what is available.",
             "GB", {0, 1e6}));
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
#define EASYPBR_ADD(name, Type) detail::add_##name(all);
        EASYPBR_EFFECTS(EASYPBR_ADD)
#undef EASYPBR_ADD
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
