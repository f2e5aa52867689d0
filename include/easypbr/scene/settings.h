// Settings: one plain struct per group, with defaults, meanings, units and ranges. The table of fields
// (scene/fields.h) gives each a name and a description, and checks its range.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "easypbr/core/math.h"
#include "easypbr/scene/auto.h"
#include "easypbr/scene/camera.h"
#include "easypbr/scene/effects/effects.h"
#include "easypbr/scene/light.h"
#include "easypbr/scene/material.h"
#include "easypbr/scene/style.h"

namespace easypbr {

enum class Antialias { none, fxaa };
enum class BackgroundMode { color, environment, blur, image, transparent };
enum class Brdf { height_correlated, separable, ue4 };
enum class ShadowMode { hard, pcf, soft };
enum class TransparencyMode { layers, stochastic };
enum class Corner { top_left, top_right, bottom_left, bottom_right };
enum class ToneOperator { aces, reinhard, agx, neutral, none };

/// Size and sampling of the image.
struct ImageSettings {
    Vec2i size{800, 600};                   ///< width and height in pixels, 1 to 65536
    int samples = 16;                       ///< jittered samples averaged per pixel, 1 to 65536
    Antialias antialias = Antialias::fxaa;  ///< of a single frame; accumulation anti-aliases by its samples
};

/// Pose, projection and lens of the camera. Automatic values frame the content.
struct CameraSettings {
    Projection projection = Projection::perspective;
    Auto<Vec3d> position;            ///< world units; automatic: frames the content
    Auto<Vec3d> target;              ///< point looked at, world units; automatic: centres the content
    std::string up = "+y";           ///< world axis that points up: +x, -x, +y, -y, +z or -z
    float fov_y_deg = 30;            ///< vertical field of view in degrees, 1 to 170; perspective
    Auto<double> ortho_height;       ///< height of the view volume, world units, above 0; orthographic
    Auto<double> near;               ///< distance to the near clipping plane, world units, above 0
    float azimuth_deg = 30;          ///< of an automatic camera, degrees: 0 in front, positive to the right
    float elevation_deg = 15;        ///< of an automatic camera, degrees: 0 level, 90 from above
    float margin = 0.05f;            ///< fraction of the image left free by an automatic camera, 0 to 0.9
    std::vector<double> pose;        ///< empty, or 16 numbers: T_world_cam row by row, OpenGL axes
    std::vector<double> intrinsics;  ///< empty, or fx, fy, cx, cy, width, height and skew (OpenCV), pixels
    DistortionModel distortion_model = DistortionModel::brown_conrady;  ///< meaning of `distortion` (OpenCV)
    std::vector<double> distortion;  ///< empty, or 4, 5 or 8 coefficients in OpenCV's order
};

/// Image-based lighting by an equirectangular environment map.
struct EnvironmentSettings {
    std::string file;        ///< HDR, EXR, PNG or JPEG; empty: a built-in studio
    Auto<bool> enabled;      ///< enables image-based lighting; automatic: on
    float rotation_deg = 0;  ///< about the up axis, degrees, counter-clockwise seen from above
    float intensity = 1;     ///< scale factor of the radiance, 0 to 1e6
    Auto<bool> sun;          ///< sun as a directional light with shadows; automatic: if a given map has one
};

/// What is visible where there is no content.
struct BackgroundSettings {
    BackgroundMode mode = BackgroundMode::color;  ///< transparent: alpha 0
    Vec3 color{0.25f, 0.25f, 0.25f};              ///< sRGB-encoded; neither exposed nor tone mapped
    std::string image;                            ///< file, for mode image
    float blur = 0.4f;                            ///< of the environment map in mode blur: 0 none, 1 the most

    /// Whether the environment is visible behind the content.
    bool shows_environment() const {
        return mode == BackgroundMode::environment || mode == BackgroundMode::blur;
    }
};

/// A three-point light of a colour given in 8 bits per channel, sRGB-encoded.
StudioLight studio_light(int red, int green, int blue);

/// Three-point lighting, placed relative to the camera.
struct LightsSettings {
    StudioLight key = studio_light(255, 241, 224);   ///< main light, slightly warm
    StudioLight fill = studio_light(230, 239, 255);  ///< opposite to the key, weaker, slightly cool
    StudioLight rim = studio_light(255, 255, 255);   ///< from behind
    float intensity = 1;                             ///< scale factor of all three, 0 to 1e6
};

/// Shadow maps of all lights that cast shadows.
struct ShadowSettings {
    bool enabled = true;
    ShadowMode mode = ShadowMode::soft;  ///< soft: PCSS; pcf: 3x3 texels; hard: unfiltered
    int resolution = 1024;               ///< width and height of a shadow map in texels, 16 to 8192
};

/// The specular BRDF of all materials.
struct ShadingSettings {
    Brdf brdf = Brdf::height_correlated;  ///< masking-shadowing function of GGX
    bool multiple_scattering = true;      ///< energy compensation
    float dielectric_f0 = 0.04f;          ///< reflectance at normal incidence where ior is 1.5, 0 to 1
};

/// Eye-dome lighting of points without normals (Boucheny 2009).
struct EdlSettings {
    bool enabled = true;
    float strength = 0.4f;  ///< 0 to 100
    float radius = 1.4f;    ///< sampling radius in pixels of an image 1080 pixels high, 0.1 to 100
};

/// Drawing order of transparent surfaces.
struct TransparencySettings {
    TransparencyMode mode = TransparencyMode::layers;  ///< layers: depth peeling
    int max_layers = 64;                               ///< peeled per pixel, 1 to 10000
};

/// Exposure and tone mapping.
struct TonemapSettings {
    /// Setting tonemap.operator. ACES (Hill's fit), Reinhard on luminance, AgX, Khronos PBR Neutral, or none:
    /// clamped.
    ToneOperator tone_operator = ToneOperator::aces;
    Auto<float> exposure;             ///< linear scale factor; automatic: metered by incident light
    float exposure_compensation = 0;  ///< EV, -30 to 30
};

/// Overrides of every material from outside; automatic: the material's own value. Colours are sRGB-encoded;
/// units and ranges are those of Material.
struct MaterialSettings {
    Auto<Vec3> color;                 ///< base colour
    Auto<float> metallic;             ///< 0 dielectric to 1 metal
    Auto<float> roughness;            ///< perceptual, 0 to 1
    Auto<Vec3> emissive;              ///< emitted radiance
    Auto<AlphaMode> alpha_mode;       ///< opaque, mask or blend
    Auto<float> opacity;              ///< 0 transparent to 1 opaque
    Auto<float> clearcoat;            ///< strength, 0 to 1
    Auto<float> clearcoat_roughness;  ///< 0 to 1
    Auto<Vec3> sheen_color;
    Auto<float> sheen_roughness;          ///< 0 to 1
    Auto<float> ior;                      ///< index of refraction, 1 to 100
    Auto<float> specular;                 ///< strength of the specular reflection of dielectrics, 0 to 1
    Auto<Vec3> specular_color;            ///< of dielectrics, at normal incidence
    Auto<float> transmission;             ///< fraction of light transmitted by dielectrics, 0 to 1
    Auto<float> thickness;                ///< of the volume, mesh units; 0: thin-walled
    Auto<Vec3> attenuation_color;         ///< of white light after attenuation_distance
    Auto<float> attenuation_distance;     ///< world units, above 0
    Auto<float> iridescence;              ///< strength, 0 to 1
    Auto<float> iridescence_ior;          ///< index of refraction of the thin film, 1 to 100
    Auto<float> iridescence_thickness;    ///< of the thin film, nanometres
    Auto<float> anisotropy;               ///< strength, 0 to 1
    Auto<float> anisotropy_rotation_deg;  ///< degrees, counter-clockwise from the tangent
    /// Files; empty: the material's own.
    std::string base_color_texture, metallic_texture, roughness_texture, normal_texture, occlusion_texture,
        emissive_texture, opacity_texture;
    std::string shader;  ///< file of a GLSL surface shader; empty: the material's own
};

/// Clipping of every object, in world space.
struct ClipSettings {
    std::vector<double> planes;  ///< four numbers n, d each, up to 16 planes; n . p + d >= 0 is kept
    std::vector<double> box;     ///< empty, or minimum and maximum x, y, z; the inside is kept
};

/// Point clouds.
struct PointsSettings {
    int hole_filling = 0;  ///< passes that fill one-pixel holes between points, 0 to 32
};

/// Legends and colour bars drawn into the image, never into layers.
struct AnnotationSettings {
    Auto<bool> legend;    ///< of the labels that colour objects; automatic: no
    Auto<bool> colorbar;  ///< of the values that colour objects; automatic: no
    std::string title;    ///< empty: the name of the values
    Corner corner = Corner::top_right;
    float text_size = 0.03f;  ///< fraction of the image height, 0.005 to 0.2
};

/// Loading of files by the command line and the window.
struct LoadSettings {
    float crease_deg = 30;  ///< STL: edges between faces at a larger angle stay sharp, degrees, 0 to 180
};

/// All settings. Paths of members are the names of settings, as in bloom.intensity.
struct Settings {
    ImageSettings image;
    CameraSettings camera;
    EnvironmentSettings environment;
    BackgroundSettings background;
    LightsSettings lights;
    ShadowSettings shadows;
    ShadingSettings shading;
    EdlSettings edl;
    TransparencySettings transparency;
#define EASYPBR_MEMBER(name, Type) Type name;
    EASYPBR_EFFECTS(EASYPBR_MEMBER)
#undef EASYPBR_MEMBER
    TonemapSettings tonemap;
    MaterialSettings material;
    Style style;  ///< overrides of the style of every object; automatic: the object's own value
    PointsSettings points;
    ClipSettings clip;
    AnnotationSettings annotation;
    LoadSettings load;
};

}  // namespace easypbr
